// Tables for the terminal: what goes first where it is narrow, and what never goes.
#include "bench/command/text_table.hpp"
#include "tests/says.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace jvari::bench::command {
namespace {

const TextTable table{
    {{"scheme", true}, {"rate"}, {"modes", false, 1}, {"cost"}, {"ns/step", false, 2}},
    {{'*', {"modal_two_point", "44100", "133", "0.0069", "156.6"}},
     {' ', {"modal_two_point", "88200", "133", "\u2264 0.01", ""}},
     {'!', {"sitar_fdm", "44100", "", "1", "-"}}}};

std::size_t longest_line(const std::string& text) {
    std::istringstream lines(text);
    std::size_t longest = 0;
    for (std::string line; std::getline(lines, line) && !line.starts_with("Not shown");)
        longest = std::max(longest, line.size());
    return longest;
}

TEST(TextTable, IsAsWideAsWhatStandsInIt) {
    EXPECT_EQ(table.text(1000),
              "  scheme            rate  modes    cost  ns/step\n"
              "* modal_two_point  44100    133  0.0069    156.6\n"
              "  modal_two_point  88200    133  \u2264 0.01\n"
              "! sitar_fdm        44100              1        -\n");
}

TEST(TextTable, LosesTheHighestRankFirstAndSaysWhich) {
    EXPECT_EQ(longest_line(table.text(48)), 48u);  // it fits to the last character
    EXPECT_FALSE(says(table.text(48), "Not shown"));
    EXPECT_TRUE(says(table.text(47), "narrow: ns/step. "));
    EXPECT_TRUE(says(table.text(35), "narrow: modes, ns/step. "));
    for (std::size_t width = 32; width < 60; ++width)
        EXPECT_LE(longest_line(table.text(width)), width + 2) << width;
    for (std::size_t width = 1; width < 60; ++width)
        EXPECT_TRUE(says(table.text(width), "0.0069")) << width;
}

TEST(TextTable, PutsItsFirstColumnOnALineAboveWhereNothingMoreCanGo) {
    EXPECT_EQ(table.text(25).substr(0, table.text(25).find("Not shown")),
              "  scheme\n"
              "      rate    cost\n"
              "  modal_two_point\n"
              "*    44100  0.0069\n"
              "     88200  \u2264 0.01\n"
              "  sitar_fdm\n"
              "!    44100       1\n");
}

TEST(Wrapped, GoesOnBelowItsLastColumn) {
    EXPECT_EQ(wrapped("  name   what it is and does, and for whom\n  other  short", 33),
              "  name   what it is and does, and\n         for whom\n  other  short");
    // too far right to go on below
    EXPECT_EQ(wrapped("  a_name_that_is_long  what it is", 30),
              "  a_name_that_is_long  what it\n  is");
    EXPECT_EQ(wrapped("a \u2264 b c", 5), "a \u2264 b\nc");
}

TEST(Wrapped, LosesNoWordAtAnyWidth) {
    const std::string text =
        "title\n  modal_two_point  energy balance exact; represents damping\n\n  x  -> y";
    const auto words = [](const std::string& all) {
        std::istringstream in(all);
        return std::vector<std::string>(std::istream_iterator<std::string>(in), {});
    };
    EXPECT_EQ(wrapped(text, 1000), text);
    for (std::size_t width = 1; width < 70; ++width) {
        EXPECT_EQ(words(wrapped(text, width)), words(text)) << width;
        if (width > 40) { EXPECT_LE(longest_line(wrapped(text, width)), width); }
    }
}

}  // namespace
}  // namespace jvari::bench::command

// Tables for the terminal: what goes first where it is narrow, and what never goes.
#include "bench/command/console.hpp"
#include "tests/says.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace jvari::bench::command

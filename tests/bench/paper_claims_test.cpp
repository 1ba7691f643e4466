// The verdicts on what papers say: those that are committed follow from the committed tables, and the program of today makes rows like
// them.
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/store/fresh_file.hpp"
#include "bench/suite/claims.hpp"
#include "bench/suite/reduce.hpp"
#include "tests/suite_text.hpp"

namespace jvari::test {
namespace {

using bench::store::Table;
using bench::suite::Series;

Table committed(const std::string& file) {
    return bench::store::read_csv(bench::store::read_whole(JVARI_RESULTS "/" + file));
}

class Papers : public testing::TestWithParam<const char*> {};

TEST_P(Papers, TheCommittedVerdictsFollowFromTheCommittedTables) {
    const std::string folder = GetParam();
    const Table again = bench::suite::verdicts_on(bench::suite::claims_on(JVARI_RESULTS "/" + folder), JVARI_RESULTS "/" + folder),
                kept = committed(folder + "/claims.csv");
    EXPECT_EQ(again.columns, kept.columns);
    ASSERT_EQ(again.rows.size(), kept.rows.size());
    for (std::size_t i = 0; i < kept.rows.size(); ++i) EXPECT_EQ(again.rows[i], kept.rows[i]) << kept.at(i, "claim");
}
INSTANTIATE_TEST_SUITE_P(Results, Papers,
                         testing::Values("paper-deshmukh", "paper-issanchou", "paper-van-walstijn", "paper-verdicts", "work-precision"));

Table made(const char* facet, const char* cells) {
    return test::Planned(cells).rows_of(facet);
}

// Of the rows that carry these fields.
Series series(const Table& t, const bench::suite::Where& where, const std::string& x, const std::string& y) {
    Series s;
    for (std::size_t i = 0; i < t.rows.size(); ++i)
        if (std::ranges::all_of(where, [&](const auto& w) { return t.at(i, w.first) == w.second; })) s[t.number(i, x)] = t.number(i, y);
    EXPECT_FALSE(s.empty());
    return s;
}

TEST(RowsOfToday, ThePrecursorOfTheFirstStringFallsAndWithoutStiffnessNothingDoes) {
    const Table t = made("centroid", R"(
        [[cells]]
        scenes = ["tanpura_drone"]
        schemes = ["modal_two_point"]
        rates = [44100]
        options = { "compliance" = ["own", "matched"] }
        sweep = { "string.0.bending_stiffness" = [6.03e-5, 0.0] }
        duration = 1.2
        taps = [{ name = "string_0", quantity = "driving_force", string = 0 }]
        measure = ["centroid"]
        centroid = { taps = ["string_0"], window = 0.0928, hop = 0.0928, from_hz = 980, to_hz = 3920 }
    )");
    const auto falls = [&t](const char* options, const char* stiffness) {
        Series s = series(t, {{"options", options}, {"string.0.bending_stiffness", stiffness}}, "time_s", "centroid_hz");
        std::erase_if(s, [](const auto& p) { return p.first <= 0.3 || p.first >= 1.15; });
        const bench::suite::Reduced slope =
            std::ranges::find(bench::suite::takes(), std::string("slope"), &bench::suite::Take::name)->of(s);
        return slope.value < -slope.half_width;
    };
    for (const char* options : {"compliance=own", "compliance=matched"}) {
        EXPECT_TRUE(falls(options, "6.03e-05")) << options;
        EXPECT_FALSE(falls(options, "0")) << options;
    }
}

TEST(RowsOfToday, ProfilesAreThoseThatAreCommitted) {
    const Table kept = committed("paper-van-walstijn/profile.csv"), now = made("profile", R"(
        [[cells]]
        scenes = ["tanpura_c3"]
        schemes = ["modal_two_point"]
        rates = [44100]
        modes = 133
        duration = 0.22
        measure = ["profile"]
        profile = { instants = [49.0e-3, 208.4e-3, 212.0e-3], from = 0, to = 1, positions = 11 }
    )");
    ASSERT_EQ(now.rows.size(), 33u);
    for (std::size_t i = 0; i < now.rows.size(); ++i) {
        const Series s = series(kept, {{"scheme", "modal_two_point"}, {"time_s", now.at(i, "time_s")}}, "position_m", "displacement_m");
        const auto same = std::ranges::find_if(s, [&](const auto& p) { return std::abs(p.first - now.number(i, "position_m")) < 1e-9; });
        ASSERT_NE(same, s.end());
        EXPECT_NEAR(now.number(i, "displacement_m"), same->second, 1e-9);  // of 1 mm
    }
}

TEST(RowsOfToday, TracesAreThoseThatAreCommitted) {
    const Table now = made("trace", R"(
        [[cells]]
        scenes = ["two_point_bridge"]
        schemes = ["modal_spatial_newton"]
        rates = [2e6]
        modes = 1001
        tap_rate = 40000
        duration = 0.0052
        taps = [{ name = "v10mm", quantity = "velocity", string = 0, position = 10e-3 }]
        sweep = { "string.0.initial.amplitude" = [1e-3], "string.0.initial.position" = [0.2004] }
        measure = ["trace"]
        trace = { taps = ["v10mm"], windows = [[0.0, 0.0052]] }
    )");
    const Series s = series(
        committed("paper-issanchou/trace.csv"),
        {{"scene", "two_point_bridge"}, {"string.0.initial.position", "0.2004"}, {"string.0.barrier.0.height", "0"}, {"window_s", "0"}},
        "time_s", "value");
    ASSERT_EQ(now.rows.size(), 209u);
    ASSERT_EQ(s.size(), 209u);
    for (std::size_t i = 0; i < now.rows.size(); ++i)
        EXPECT_NEAR(now.number(i, "value"), s.at(now.number(i, "time_s")), 1e-6);  // of 1.2 m/s
}

}  // namespace
}  // namespace jvari::test

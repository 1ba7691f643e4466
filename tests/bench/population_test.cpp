// Populations: the seed decides the strings, each string has an outcome, and a rerun is the same.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "analysis/sobol.hpp"
#include "bench/store/fresh_file.hpp"
#include "scenes/pitch.hpp"
#include "tests/command_line.hpp"
#include "tests/suite_text.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;
using bench::store::Table;
using bench::suite::Suite;

// a string that is easily solved, one with loss that is refused by some, and one of the library
std::string population(const std::string& more = "seed = 3", const char* modes = "0.5, 1") {
    return R"([population]
schemes = ["modal_two_point", "finite_difference_theta"]
rates = [44100, 88200]
modes = [)" +
           std::string(modes) + R"(]
options = { "modal_two_point:compliance" = ["own", "matched"] }
scenes = ["tanpura_c3_release"]
measure = ["errors", "share"]
)" + more + R"(
[[ground]]
name = "plain"
scene = "guitar_over_fret"
number = 1
[ground.draw]
"string.0.linear_density" = { from = 1e-3, to = 2e-3, log = true }
"string.0.start.smoothing" = 0.05
[[ground]]
name = "lossy"
scene = "guitar_over_fret"
number = 1
draw = { "string.0.barrier.0.contact_loss" = [0.1, 0.2], "string.0.linear_density" = 1e-3 }
)";
}

Suite read(const std::string& text) { return bench::suite::parse_suite(text, "a.toml"); }

std::string scenes_of(const Suite& suite) {
    std::string all;
    for (const auto& set : suite.sets) all += write_scene(*set.drawn);
    return all;
}

TEST(Population, TheSameSeedGivesTheSameScenesToTheByteAndAnotherDoesNot) {
    EXPECT_EQ(scenes_of(read(population())), scenes_of(read(population())));
    EXPECT_NE(scenes_of(read(population())), scenes_of(read(population("seed = 4"))));
    // any other machine too: the record's strings are those that its suite draws
    const fs::path root = JVARI_SOURCE;
    const Suite suite = bench::suite::read_suite((root / "bench/suites/population.toml").string());
    ASSERT_GE(suite.sets.size(), 300u);
    for (const auto& set : suite.sets)
        EXPECT_EQ(write_scene(*set.drawn),
                  content(root / "results/population/scenes" / (set.drawn->name + ".toml")));
}

TEST(Population, DrawsFillTheirRangesEvenly) {
    const auto points = sobol_points(3, 64, 5);
    for (std::size_t d = 0; d < 3; ++d) {
        std::vector<int> in(8);
        for (const auto& p : points) {
            ASSERT_TRUE(p[d] >= 0 && p[d] < 1);
            ++in[static_cast<std::size_t>(8 * p[d])];
        }
        // chance would leave a part of eight with 3 or fewer, or 13 or more
        EXPECT_GE(*std::ranges::min_element(in), 6) << d;
        EXPECT_LE(*std::ranges::max_element(in), 10) << d;
    }
}

TEST(Population, AStringRunsForPeriodsOfItsPitchWithModesThatItHears) {
    const Suite suite = read(population("periods = 5"));
    const auto& plain = suite.sets[0];
    EXPECT_NEAR(plain.drawn->duration * pitch_of(plain.drawn->strings[0]), 5, 1e-9);
    const int heard = plain.modes[1];
    EXPECT_NEAR(plain.modes[0], 0.5 * heard, 1);
    ASSERT_EQ(plain.drawn->taps.size(), 1u);
    EXPECT_EQ(plain.drawn->taps[0].quantity, Quantity::nut_force);
    // modes that the rate cannot hold are left out, a grid is there once for each rate
    const Planned plan(population("periods = 1", "1, 2, 4"));
    int grids = 0, most = 0;
    for (const auto& job : plan.jobs) {
        const bool grid = job.cell.scheme->name == std::string("finite_difference_theta");
        if (job.point->scene.name != "plain-001") continue;
        grids += grid;
        if (!grid && job.cell.settings.sample_rate == 44100)
            most = std::max(most, job.cell.settings.modes);
    }
    EXPECT_EQ(grids, 2);
    EXPECT_EQ(most, heard);
}

TEST(Population, SaysWhatIsWrongOfIt) {
    EXPECT_TRUE(says(refusal_of("[[cells]]\nscenes = \"free_string\"\nmeasure = \"share\""),
                     "found share in [[cells]]"));
    EXPECT_TRUE(says(refusal_of(population() + "[[cells]]\nscenes = \"free_string\""),
                     "found [[cells]] too"));
    EXPECT_TRUE(says(refusal_of("[population]"), "found no strings"));
    EXPECT_TRUE(says(refusal_of("[[ground]]\nname = \"a\"\nscene = \"free_string\"\nnumber = 1"),
                     "expected [population] beside it"));
    EXPECT_TRUE(says(refusal_of("[population]\n[[ground]]\nname = \"a\"\nscene = "
                                "\"free_string\"\nnumber = 1\ndraw = { x = { from = 2, to = 1 } }"),
                     "expected { from = A, to = B }"));
}

bench::suite::StringTables tables_of(const Suite& suite) {
    const bench::study::Plan plan =
        bench::suite::plan_of(suite.sets, bench::compare::Catalogue(), {});
    const auto records = bench::study::run(plan, "", false, 2, bench::store::Listener()).records;
    return string_tables(suite, bench::study::cells_of(plan, records), records);
}
std::string text_of(const bench::suite::StringTables& t) {
    return csv(t.strings) + csv(t.outcomes) + csv(t.advice);
}

TEST(Population, EachStringIsCountedOnceForEachVariantAndRunsAgainToTheLastDigit) {
    const Suite suite = read(population("periods = 3\neffort = 0.01"));
    const auto t = tables_of(suite);
    ASSERT_EQ(t.strings.rows.size(), 3u);
    EXPECT_EQ(t.outcomes.rows.size(), 3u * 3);  // strings x variants
    EXPECT_EQ(t.advice.rows.size(), 3u * 3);    // strings x tolerances
    const std::set<std::string> known{"solved", "missed", "undecided", "refused", "failed"};
    for (std::size_t i = 0; i < t.outcomes.rows.size(); ++i)
        for (const char* within : {"within_0.1", "within_0.01", "within_0.001"})
            EXPECT_TRUE(known.contains(t.outcomes.text(i, within))) << t.outcomes.text(i, within);
    for (std::size_t i = 0; i < t.strings.rows.size(); ++i)
        EXPECT_GT(t.strings.number(i, "amplification"), 0.01) << t.strings.text(i, "string");
    EXPECT_EQ(t.strings.text(2, "string"), "tanpura_c3_release");
    EXPECT_NEAR(t.strings.number(2, "f0_hz"), 130.9, 0.1);
    EXPECT_NEAR(t.strings.number(2, "contact"), 0.01, 1e-12);
    EXPECT_EQ(text_of(tables_of(suite)), text_of(t));
}

// Strings that amplify little, so that another set of vector instructions gives nearly the same.
TEST(Population, ThreeStringsOfTheRecordAreWhatTheyWereWhenItWasMade) {
    const fs::path root = JVARI_SOURCE;
    Suite suite = bench::suite::read_suite((root / "bench/suites/population.toml").string());
    const std::set<std::string> three{"soft-004", "soft-002", "tanpura_c3"};
    std::erase_if(suite.sets, [&](const auto& set) { return !three.contains(set.drawn->name); });
    for (auto& set : suite.sets) std::erase(set.measure, "cost");
    const auto now = tables_of(suite);
    EXPECT_EQ(now.fronts.columns,
              bench::store::Folder{root / "results/population"}.table("fronts").columns);
    for (const auto& [name, table] : {std::pair{"strings", &now.strings},
                                      {"outcomes", &now.outcomes},
                                      {"advice", &now.advice}}) {
        Table then = bench::store::Folder{root / "results/population"}.table(name);
        std::erase_if(then.rows, [&](const auto& row) { return !three.contains(row[0].text()); });
        ASSERT_EQ(then.columns, table->columns);
        ASSERT_EQ(then.rows.size(), table->rows.size()) << name;
        for (std::size_t i = 0; i < then.rows.size(); ++i)
            for (const std::string& column : then.columns) {
                const double a = then.number(i, column), b = table->number(i, column);
                if (column == "text" || column == "reason") continue;  // round the same numbers
                if (std::isfinite(a) && std::isfinite(b))
                    EXPECT_NEAR(a, b, 1e-6 * std::fabs(a)) << name << " " << column;
                else EXPECT_EQ(then.at(i, column), table->at(i, column)) << name << " " << column;
            }
    }
}

}  // namespace
}  // namespace jvari::test

// The smoke suite against results/smoke: has a number of any scheme moved by more than rounding can
// move it?
//
// Every column of its cells and every mode of its dispersion, by the rules of `jvari diff`
// (bench/diff/rules.hpp), without the clock. `below_floor` follows from the rest: each error that
// it names is no larger than its floor, and no other.
#include <cmath>
#include <fstream>

#include "bench/diff/difference.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

void expect_below_floor(const bench::store::Table& t, std::size_t i) {
    const std::string named = " " + t.at(i, "below_floor") + " ";
    for (const std::string& column : t.columns)
        if (column.starts_with("floor_") && t.column(column.substr(6)) < t.column("below_floor")) {
            EXPECT_EQ(named.find(" " + column.substr(6) + " ") != std::string::npos,
                      t.number(i, column.substr(6)) <= t.number(i, column))
                << t.at(i, "cell") << " " << column;
        }
}

TEST(Regression, TheSmokeSuiteIsWhatItWasWhenItWasRecorded) {
    const std::filesystem::path kept = std::filesystem::path(JVARI_SOURCE) / "results" / "smoke";
    const Scratch scratch;
    std::string suite =
        content(std::filesystem::path(JVARI_SOURCE) / "bench" / "suites" / "smoke.toml");
    // no clock here
    for (std::size_t at; (at = suite.find("\"cost\"")) != std::string::npos;)
        suite.replace(at, 6, "\"errors\"");
    std::ofstream(scratch / "smoke.toml") << suite;
    const Outcome o = jvari(scratch, "suite " + (scratch / "smoke.toml") +
                                         " --jobs 2 --quiet --out " + (scratch / "now"));
    ASSERT_EQ(o.code, 0) << o.err;

    const bench::diff::Folder then = bench::diff::read_folder(kept),
                              now = bench::diff::read_folder(scratch / "now");
    bench::diff::Difference d = bench::diff::difference(then, now);
    d.columns.after.clear();  // a later program may measure more
    EXPECT_TRUE(d.nothing()) << text_of(d, then, now);
    EXPECT_GT(d.compared, 10000);
    for (std::size_t i = 0; i < now.cells.rows.size(); ++i) expect_below_floor(now.cells, i);
}

}  // namespace
}  // namespace jvari::test

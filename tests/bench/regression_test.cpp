// The smoke suite against results/smoke: has a number of any scheme moved by more than rounding can
// move it?
//
// Every column of its cells, by the rules of `jvari diff` (bench/suite/difference_rules.cpp),
// without the clock. `below_floor` follows from the rest: each error that it names is no larger
// than its floor, and no other.
#include <cmath>
#include <fstream>

#include "bench/suite/difference.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

void expect_below_floor(const bench::study::TabledCell& c) {
    for (std::size_t m = 0; m < bench::study::measures().size(); ++m) {
        const std::string& column = bench::study::measures()[m].column;
        EXPECT_EQ((" " + c.below_floor + " ").find(" " + column + " ") != std::string::npos,
                  c.figure(m).value <= c.figure(m).floor)
            << c.cell << " " << column;
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
    const Ended o = jvari(scratch, "suite " + (scratch / "smoke.toml") +
                                       " --jobs 2 --quiet --out " + (scratch / "now"));
    ASSERT_EQ(o.code, 0) << o.err;

    const bench::suite::Results then = bench::suite::read_results(kept),
                                now = bench::suite::read_results(scratch / "now");
    bench::suite::Difference d = bench::suite::difference(then, now);
    d.columns.after.clear();  // a later program may measure more
    EXPECT_TRUE(d.nothing()) << text_of(d, then, now);
    EXPECT_GT(d.compared, 10000);
    for (const bench::study::TabledCell& c : now.cells) expect_below_floor(c);
}

}  // namespace
}  // namespace jvari::test

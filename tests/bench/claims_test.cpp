// Claims: how a number is taken from tables, and what follows from it and its uncertainty.
#include <gtest/gtest.h>
#include <algorithm>

#include "bench/store/fresh_file.hpp"
#include "bench/store/usage.hpp"
#include "bench/suite/claims.hpp"
#include "bench/suite/reduce.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

using bench::store::Table;
using bench::suite::Series;

constexpr const char* cells = "[[cells]]\nscenes = [\"free_string\"]\n";

// The verdicts on a claim of these lines, in a folder with these tables.
class Claims : public testing::Test {
protected:
    Claims() {
        write("errors",
              "scheme,rate,error_l2_50ms,certificate_l2_50ms,deepest_penetration\n"
              "a,44100,0.10,0.01,2e-8\na,88200,0.02,0.01,1e-8\nb,44100,0.30,,3e-8\n");
        write("cost", "scheme,cost_s_per_s,cost_lower,cost_upper,ns_per_step\na,0.002,0.0018,0.0021,40\nb,0.002,0.0019,0.0021,20\n");
        write("trace", "tap,time_s,value\nx,0,1\nx,1,3\nx,2,5\ny,0,1\ny,1,-1\ny,2,3\nz,0,1\n");
    }
    void write(const std::string& table, const std::string& csv) { bench::store::write_fresh(folder.path / (table + ".csv"), csv); }
    Table verdicts(const std::string& claim) const {
        const std::string text = std::string(cells) + "[[claim]]\nsays = \"it is so\"\n" + claim;
        return verdicts_on(bench::suite::parse_suite(text, "a.toml").claims, folder.path);
    }
    std::string verdict(const std::string& claim) const { return verdicts(claim).at(0, "verdict"); }

    Scratch folder;
};

std::string of_a(const std::string& limits) {
    return "table = \"errors\"\ncolumn = \"error_l2_50ms\"\nwhere = { scheme = \"a\", rate = 44100 }\n" + limits;
}
std::string of_trace(const std::string& more) {
    return "table = \"trace\"\ncolumn = \"value\"\nalong = \"time_s\"\n" + more;
}

TEST_F(Claims, HoldFailOrCannotBeToldByTheUncertaintyOfTheReference) {  // 0.10 give or take 0.01
    EXPECT_EQ(verdict(of_a("at_most = 0.111")), "holds");
    EXPECT_EQ(verdict(of_a("at_most = 0.109")), "cannot be told");
    EXPECT_EQ(verdict(of_a("at_most = 0.091")), "cannot be told");
    EXPECT_EQ(verdict(of_a("at_most = 0.089")), "does not hold");
    EXPECT_EQ(verdict(of_a("at_least = 0.111")), "does not hold");
    EXPECT_EQ(verdict(of_a("expected = [0.1, 0.02]")), "holds");
    EXPECT_EQ(verdict(of_a("at_most = 0.111\nuncertainty = 0.005")), "cannot be told");
    const Table t = verdicts(of_a("at_most = 0.111"));
    EXPECT_EQ(t.at(0, "measured"), "0.1");
    EXPECT_EQ(t.at(0, "uncertainty"), "0.01");
    EXPECT_EQ(t.at(0, "rests_on"), "the reference's certificate");
}

TEST_F(Claims, CannotBeToldWhereTheUncertaintyIsNotKnown) {
    const Table t = verdicts("table = \"errors\"\ncolumn = \"error_l2_50ms\"\nwhere = { scheme = \"b\" }\nat_most = 1");
    EXPECT_EQ(t.at(0, "verdict"), "cannot be told");
    EXPECT_EQ(t.at(0, "measured"), "0.3");
    EXPECT_EQ(t.at(0, "uncertainty"), "");
    EXPECT_TRUE(says(t.at(0, "note"), "not known"));
}

TEST_F(Claims, CannotBeToldWhereANumberIsMissingAndSayWhy) {
    const auto why = [this](const std::string& claim) {
        const Table t = verdicts(claim);
        EXPECT_EQ(t.at(0, "verdict"), "cannot be told");
        return t.at(0, "note");
    };
    EXPECT_EQ(why("table = \"extent\"\ncolumn = \"high\"\nat_least = 0"), "extent.csv is not in the folder");
    EXPECT_TRUE(says(why("table = \"trace\"\ncolumn = \"valeu\"\nat_least = 0"), "did you mean \"value\"?"));
    EXPECT_TRUE(says(why(of_trace("where = { tap = \"w\" }\nat_least = 0")), "no row with tap = w"));
    EXPECT_TRUE(says(why(of_trace("where = { tap = \"x\" }\nat_least = 0")), "3 rows"));
    EXPECT_TRUE(says(why(of_trace("take = \"mean\"\nat_least = 0")), "two rows at time_s 0"));
    EXPECT_TRUE(says(why(of_trace("take = \"mean\"\nwhere = { tap = \"x\" }\nagainst = { where = { tap = \"z\" } }\nat_least = 0")),
                     "no other row at time_s 1"));
    EXPECT_EQ(why("open = \"it prints no rule\""), "it prints no rule");
    EXPECT_EQ(why(of_a("open = \"it does not say of what\"\nat_most = 1")), "it does not say of what");
}

TEST_F(Claims, TakeOtherRowsRowByRowThenTheDifferenceThenTheRatio) {
    const auto measured = [this](const std::string& more) {
        return verdicts(of_trace("where = { tap = \"x\" }\nat_least = 0\n" + more)).at(0, "measured");
    };
    EXPECT_EQ(measured("take = \"mean\""), "3");
    EXPECT_EQ(measured("take = \"mean\"\nfrom = 0.5"), "4");
    EXPECT_EQ(measured("take = \"size\"\nagainst = { where = { tap = \"y\" } }"), "4");
    EXPECT_EQ(measured("take = \"largest\"\nminus = { where = { tap = \"y\" } }"), "2");
    EXPECT_EQ(measured("take = \"largest\"\nover = { to = 1 }"), "1.6667");
}

TEST_F(Claims, UncertaintiesAddInADifferenceAndRelativelyInARatio) {
    const auto off = [this](const std::string& more) { return verdicts(of_a("at_least = 0\n" + more)).at(0, "uncertainty"); };
    EXPECT_EQ(off("minus = { where = { rate = 88200 } }"), "0.02");
    EXPECT_EQ(off("over = { where = { rate = 88200 } }"), "3");  // 0.01/0.02 + 5 * 0.01/0.02
    const Table t = verdicts("table = \"cost\"\ncolumn = \"ns_per_step\"\nwhere = { scheme = \"a\" }\nat_least = 0");
    EXPECT_EQ(t.at(0, "uncertainty"), "4");  // the quartiles are a tenth off
    EXPECT_EQ(t.at(0, "rests_on"), "quartiles");
}

TEST_F(Claims, HoldOnlyIfTheyHoldOfEachSetOfRowsAndShowTheOneNearestToFailing) {
    const std::string both = of_trace("take = \"least\"\neach = [{ tap = \"x\" }, { tap = \"y\" }]\n");
    EXPECT_EQ(verdict(both + "at_least = -1"), "holds");
    EXPECT_EQ(verdict(both + "at_least = 0"), "does not hold");
    EXPECT_EQ(verdicts(both + "at_least = 0").at(0, "measured"), "-1");
    EXPECT_EQ(verdict(both + "minus = { where = { tap = \"y\" } }\nat_least = 0"), "holds");  // what it says itself prevails over each
}

TEST_F(Claims, AreRefusedWithLineAndKey) {
    const auto refusal = [this](const std::string& claim) -> std::string {
        try {
            verdicts(claim);
        } catch (const std::exception& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_TRUE(says(refusal(""), "expected a table and a column, or `open`"));
    EXPECT_TRUE(says(refusal("table = \"trace\"\nat_most = 1"), "the key column is missing"));
    EXPECT_TRUE(says(refusal(of_trace("")), "no limit"));
    EXPECT_TRUE(says(refusal(of_trace("at_least = 2\nat_most = 1")), "at_least is above at_most"));
    EXPECT_TRUE(says(refusal(of_trace("expected = [1]")), "tolerance > 0"));
    EXPECT_TRUE(says(refusal(of_trace("take = \"men\"\nat_most = 1")), "unknown take \"men\""));
    EXPECT_TRUE(says(refusal(of_trace("over = { tow = 1 }\nat_most = 1")), "a.toml:8"));
}

// The template that the documentation gives, as it stands: the suite writes the verdicts, and the verb makes them again of the tables
// alone.
TEST(ClaimsOfAPaper, AreMadeByTheSuiteAndMadeAgainWithoutARun) {
    const Scratch scratch;
    const std::string out = scratch / "raman";
    ASSERT_TRUE(ends(jvari(scratch, "suite " JVARI_SOURCE "/docs/claims/raman.toml --out " + out, "JVARI_NODE_MODULES=/nowhere"), 0,
                     "3 claims: 3 hold, 0 do not hold, 0 cannot be told"));
    EXPECT_EQ(content(out + "/suite.toml"), content(JVARI_SOURCE "/docs/claims/raman.toml"));
    const std::string first = content(out + "/claims.csv"), page = content(out + "/report.html");
    EXPECT_TRUE(says(page, "they sound powerfully"));
    std::filesystem::remove(out + "/claims.csv");
    EXPECT_TRUE(ends(jvari(scratch, "claims " + out), 0, "over the bridge of a tanpura they sound powerfully"));
    EXPECT_EQ(content(out + "/claims.csv"), first);
    EXPECT_TRUE(ends(jvari(scratch, "claims " + out + " --suite smoke"), 2, "smoke has no [[claim]]"));
}

bench::suite::Reduced reduced(const Series& s, const std::string& take) {
    return std::ranges::find(bench::suite::takes(), take, &bench::suite::Take::name)->of(s);
}

TEST(Reduce, TakesOneNumberOfASeries) {
    const Series s{{0, -1}, {1, 0}, {2, 3}, {3, -4}};
    EXPECT_EQ(reduced(s, "mean").value, -0.5);
    EXPECT_EQ(reduced(s, "largest").value, 3);
    EXPECT_EQ(reduced(s, "least").value, -4);
    EXPECT_EQ(reduced(s, "size").value, 4);
    EXPECT_EQ(reduced(s, "rms").value, std::sqrt(26.0 / 4));
    EXPECT_EQ(reduced(s, "share_above_0").value, 0.25);
}

TEST(Reduce, ASlopeHasAnIntervalAndNeedsThreeRows) {
    const bench::suite::Reduced slope = reduced({{0, 0}, {1, 1.1}, {2, 1.9}, {3, 3}}, "slope");
    EXPECT_NEAR(slope.value, 0.98, 1e-12);
    EXPECT_NEAR(slope.half_width, 0.18255, 1e-5);  // t = 4.3027 with two degrees of freedom, times sqrt(0.009/5)
    EXPECT_FALSE(reduced({{0, 0}, {1, 1}}, "slope").why.empty());
}

TEST(Reduce, CountsTurnsThatFallByAFifth) {
    EXPECT_EQ(reduced({{0, 0}, {1, 5}, {2, 4.5}, {3, 5}, {4, 0}, {5, 4}, {6, 1}}, "turns").value, 2);
    EXPECT_EQ(reduced({{0, 0}, {1, 1}, {2, 2}}, "turns").value, 0);
}

TEST(Reduce, TwoStraightLinesAreHelmholtzMotion) {
    EXPECT_NEAR(reduced({{0, 0}, {1, 1}, {2, 2}, {3, 1}, {4, 0}}, "off_two_lines").value, 0, 1e-7);
    EXPECT_GT(reduced({{0, 0}, {1, 1}, {2, -2}, {3, 1}, {4, 0}}, "off_two_lines").value, 0.5);
}

}  // namespace
}  // namespace jvari::test

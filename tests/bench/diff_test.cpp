// jvari diff: what was planted is found, and nothing is found where nothing was.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "bench/diff/difference.hpp"
#include "bench/store/usage.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

using bench::diff::Difference;
using bench::diff::Folder;
using bench::diff::Turn;

constexpr int schemes = 8, rates = 4;

// Costs as a clock gives them: a true one of each cell, times the machine's drift, times a
// disturbance of the cell and a smaller one of each of its five samples.
Folder timed(unsigned seed, double disturbance, double drift = 1, int slow = -1,
             const std::string& cpu = "one") {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Folder f;
    f.name = "made up";
    f.made.cpu = cpu;
    f.cells.columns = {"scene",  "scheme",        "options",      "rate",       "modes",
                       "status", "error_l2_50ms", "cost_s_per_s", "cost_lower", "cost_upper"};
    for (int s = 0; s < schemes; ++s)
        for (int r = 0; r < rates; ++r) {
            std::vector<double> samples;
            const double cell = std::exp(disturbance * normal(random));
            for (int k = 0; k < 5; ++k)
                samples.push_back((s + 1) * 1e-3 * (1 << r) * drift * (s == slow ? 1.3 : 1) * cell *
                                  std::exp(0.3 * disturbance * normal(random)));
            std::sort(samples.begin(), samples.end());
            const auto text = [](double x) { return bench::store::text_of(x); };
            f.cells.rows.push_back({"string", "scheme_" + std::to_string(s), "",
                                    std::to_string(44100 << r), "40", "ok", "0.01",
                                    text(samples[2]), text(samples[1]), text(samples[3])});
        }
    return f;
}

TEST(Costs, ASchemeThatIsThirtyPerCentSlowerIsFoundWhateverTheMachinesDrift) {
    for (const double drift : {1.0, 1.4, 0.7}) {
        const Difference d = difference(timed(1, 0.02), timed(2, 0.02, drift, 3));
        EXPECT_EQ(d.count(Turn::worse), rates) << drift;
        EXPECT_EQ(d.count(Turn::better), 0) << drift;
        for (const auto& f : d.findings) EXPECT_TRUE(says(f.row, "scheme_3"));
    }
    EXPECT_EQ(difference(timed(2, 0.02, 1, 3), timed(1, 0.02)).count(Turn::better), rates);
}

TEST(Costs, TwoRunsOfOneProgramAreSilentOnAQuietAndOnABusyMachine) {
    for (const double disturbance : {0.01, 0.1, 0.6})
        for (unsigned repeat = 0; repeat < 10; ++repeat) {
            const Difference d =
                difference(timed(2 * repeat, disturbance), timed(2 * repeat + 1, disturbance, 1.1));
            EXPECT_TRUE(d.findings.empty())
                << disturbance << " " << repeat << " " << d.findings.front().row;
        }
}

TEST(Costs, OfTwoMachinesAreNotComparedAndItIsSaid) {
    const Difference d = difference(timed(1, 0.02), timed(2, 0.02, 1, 3, "another"));
    EXPECT_TRUE(d.findings.empty());
    ASSERT_EQ(d.notes.size(), 1u);
    EXPECT_TRUE(says(d.notes[0], "two machines"));
}

TEST(Costs, ThatAreGoneAreWorse) {
    for (const char* cost : {"", "nan", "0", "-1"}) {
        Folder after = timed(1, 0.02);
        after.cells.rows[5][7] = cost;
        EXPECT_EQ(difference(timed(1, 0.02), after).count(Turn::worse), 1) << cost;
    }
}

TEST(Costs, OfASingleSchemeAreNotToldFromTheMachines) {
    Folder a = timed(1, 0.02), b = timed(2, 0.02, 1.3);
    a.cells.rows.resize(rates), b.cells.rows.resize(rates);
    const Difference d = difference(a, b);
    EXPECT_EQ(d.count(Turn::worse), 0);
    EXPECT_EQ(d.count(Turn::moved), rates);
}

// ---- Errors and outcomes.

Folder cell(const std::string& status, const std::string& flags, double error, double floor,
            double certificate) {
    const auto text = [](double x) { return bench::store::text_of(x); };
    Folder f;
    f.name = "made up";
    f.cells.columns = {"scheme",
                       "rate",
                       "status",
                       "flags",
                       "error_l2_50ms",
                       "floor_error_l2_50ms",
                       "certificate_l2_50ms"};
    f.cells.rows = {{"a", "44100", status, flags, text(error), text(floor), text(certificate)}};
    return f;
}
Turn turn_between(const Folder& a, const Folder& b) {
    const Difference d = difference(a, b);
    EXPECT_LE(d.findings.size(), 1u);
    return d.findings.empty() ? Turn::same : d.findings[0].turn;
}

TEST(Errors, GetWorseBeyondNoiseAndCertificatesAlone) {
    const Folder was = cell("ok", "", 0.05, 1e-12, 1e-3);
    // a thousand floors
    EXPECT_EQ(turn_between(was, cell("ok", "", 0.05 + 9e-10, 1e-12, 1e-3)), Turn::same);
    // beyond them, not beyond the certificates
    EXPECT_EQ(turn_between(was, cell("ok", "", 0.05 + 1.2e-9, 1e-12, 1e-3)), Turn::moved);
    EXPECT_EQ(turn_between(was, cell("ok", "", 0.0519, 1e-12, 1e-3)), Turn::moved);
    EXPECT_EQ(turn_between(was, cell("ok", "", 0.0521, 1e-12, 1e-3)), Turn::worse);
    EXPECT_EQ(turn_between(was, cell("ok", "", 0.0479, 1e-12, 1e-3)), Turn::better);
    EXPECT_EQ(turn_between(was, cell("ok", "", INFINITY, 1e-12, 1e-3)), Turn::worse);
}

Turn turn_in(const Difference& d, const std::string& column) {
    for (const auto& f : d.findings)
        if (f.column == column) return f.turn;
    return Turn::same;
}

TEST(Errors, OfAnotherReferenceAreSaidToBeBeforeAnyFigure) {
    Folder was = cell("ok", "", 0.05, 1e-12, 1e-3), is = cell("ok", "", 0.08, 1e-12, 1e-3);
    EXPECT_EQ(bench::diff::difference(was, is).references, "");
    for (Folder* f : {&was, &is}) {
        f->cells.columns.emplace_back("reference");
        f->cells.rows[0].emplace_back(f == &was ? "exact_contact" : "sundials");
    }
    const std::string text = text_of(bench::diff::difference(was, is), was, is);
    EXPECT_TRUE(text.starts_with(
        "the references differ in 1 of 1 cells (reference exact_contact -> sundials)"))
        << text;
}

TEST(Errors, ThatAreNoLongerKnownAreWorse) {
    const Folder was = cell("ok", "", 0.05, 1e-12, 1e-3);
    for (const char* unknown : {"", "nan"}) {
        Folder is = was;
        is.cells.rows[0][4] = unknown;
        EXPECT_EQ(turn_between(was, is), Turn::worse) << unknown;
        EXPECT_EQ(turn_between(is, was), Turn::better) << unknown;
        EXPECT_EQ(turn_between(is, is), Turn::same) << unknown;
    }
    Folder without = was;  // the whole column
    without.cells.columns.erase(without.cells.columns.begin() + 4);
    without.cells.rows[0].erase(without.cells.rows[0].begin() + 4);
    EXPECT_EQ(turn_between(was, without), Turn::worse);
}

TEST(Cells, ThatCameBackToTheLastDigitAreCounted) {
    Folder was = cell("ok", "", 0.05, 1e-12, 1e-3);
    was.cells.columns.emplace_back("processor_s_per_s");
    was.cells.rows[0].emplace_back("1");
    was.cells.rows.push_back({"b", "44100", "ok", "", "0.05", "1e-12", "1e-3", "1"});
    Folder is = was;
    is.cells.rows[0][7] = "2";  // a clock's
    const std::string text = text_of(bench::diff::difference(was, is), was, is);
    EXPECT_TRUE(says(text, "\n2 of 2 cells came back to the last digit")) << text;
    is = was;
    is.cells.rows[1][4] = "0.05000000000000001";  // below noise
    const Difference d = difference(was, is);
    EXPECT_TRUE(d.nothing());
    EXPECT_TRUE(says(text_of(d, was, is), "\n1 of 2 cells came back to the last digit"));
}

TEST(Errors, AreNotExcusedByACertificateThatGrew) {
    const Folder was = cell("ok", "", 0.05, 1e-12, 1e-3);
    const Difference nine = difference(was, cell("ok", "", 0.45, 1e-12, 1e9));
    EXPECT_EQ(turn_in(nine, "error_l2_50ms"), Turn::worse);
    EXPECT_EQ(turn_in(nine, "certificate_l2_50ms"), Turn::worse);
    EXPECT_EQ(turn_in(difference(was, cell("ok", "", 0.0519, 1e-12, 5e-3)), "error_l2_50ms"),
              Turn::moved);
    EXPECT_EQ(turn_in(difference(was, cell("ok", "", 0.0521, 1e-12, 5e-3)), "error_l2_50ms"),
              Turn::worse);
    EXPECT_EQ(turn_in(difference(was, cell("ok", "", 0.0512, 1e-12, 1e-4)), "error_l2_50ms"),
              Turn::worse);
    // the certificate itself
    EXPECT_EQ(turn_between(was, cell("ok", "", 0.05, 1e-12, 2e-3)), Turn::worse);
    EXPECT_EQ(turn_between(was, cell("ok", "", 0.05, 1e-12, 5e-4)), Turn::better);
    EXPECT_EQ(turn_between(was, cell("ok", "", 0.05, 1e-12, NAN)), Turn::worse);
}

TEST(Cells, ThatAreMissingAfterAreWorse) {
    Folder two = cell("ok", "", 0.05, 1e-12, 1e-3), one = two;
    two.cells.rows.push_back({"b", "44100", "ok", "", "0.05", "1e-12", "1e-3"});
    EXPECT_TRUE(difference(two, one).worse());
    EXPECT_EQ(difference(two, one).missing(), 1);
    EXPECT_FALSE(difference(one, two).worse());
}

Folder modes(const std::vector<std::string>& own_cents) {
    Folder f;
    f.dispersion.columns = {"scene", "scheme",    "options",        "rate",
                            "mode",  "own_cents", "own_decay_per_s"};
    for (std::size_t k = 0; k < own_cents.size(); ++k)
        f.dispersion.rows.push_back(
            {"s", "a", "", "44100", std::to_string(k + 1), own_cents[k], "1"});
    return f;
}

TEST(Dispersion, IsWorseWhereAModeIsFurtherFromItsPitchOnEitherSide) {
    for (const auto& [before, after] :
         {std::pair{"1", "-3"}, {"-1", "-3"}, {"1", "3"}, {"-1", "3"}, {"1", ""}}) {
        EXPECT_EQ(turn_in(difference(modes({before}), modes({after})), "own_cents"), Turn::worse)
            << before << " " << after;
        EXPECT_EQ(turn_in(difference(modes({after}), modes({before})), "own_cents"), Turn::better)
            << before << " " << after;
    }
    EXPECT_EQ(turn_in(difference(modes({"1"}), modes({"1.000000001"})), "own_cents"), Turn::same);
    EXPECT_TRUE(difference(modes({"1", "2"}), modes({"1"})).worse());
}

Folder boundary(const std::string& low, const std::string& high) {
    Folder f;
    f.boundaries.columns = {"map", "scheme", "x_key", "y_key", "y", "between", "x_low", "x_high"};
    f.boundaries.rows = {{"m", "a", "rate", "", "", "sound and diverged", low, high}};
    return f;
}

TEST(Boundaries, MovedWhereTheirBracketsAreApartOnEitherSide) {
    const Folder was = boundary("10", "20");
    for (const auto& [low, high] : {std::pair{"21", "30"}, {"1", "9"}})
        EXPECT_EQ(turn_between(was, boundary(low, high)), Turn::moved) << low;
    for (const auto& [low, high] : {std::pair{"20", "30"}, {"1", "10"}, {"12", "13"}, {"5", "50"}})
        EXPECT_EQ(turn_between(was, boundary(low, high)), Turn::same) << low;
}

TEST(Boundaries, ThatAreGoneAreToldAndAreNotWorse) {
    Folder one = boundary("10", "20"), two = one;
    two.boundaries.rows.push_back({"m", "b", "rate", "", "", "sound and diverged", "1", "2"});
    const Difference d = difference(two, one);
    EXPECT_FALSE(d.worse());
    EXPECT_FALSE(d.nothing());
}

TEST(Outcomes, ThatFailAreWorseAndFlagsToo) {
    const Folder was = cell("ok", "", 0.05, 1e-12, 1e-3);
    EXPECT_EQ(turn_between(was, cell("diverged", "", 0.05, 1e-12, 1e-3)), Turn::worse);
    EXPECT_EQ(turn_between(cell("diverged", "", 0.05, 1e-12, 1e-3), was), Turn::better);
    EXPECT_EQ(turn_between(was, cell("ok", "adhesion", 0.05, 1e-12, 1e-3)), Turn::worse);
}

TEST(Outcomes, AFurtherFlagAndAColumnThatIsGoneAreWorse) {
    Folder before = timed(1, 0.02);
    before.cells.columns.emplace_back("flags");
    for (auto& row : before.cells.rows) row.emplace_back("energy");
    Folder after = before;
    after.cells.rows[0].back() = "adhesion energy";
    EXPECT_EQ(difference(before, after).count(Turn::worse), 1);
    EXPECT_EQ(difference(after, before).count(Turn::better), 1);
    Folder without = before;  // no status: no cell is known to have run
    for (auto& row : without.cells.rows) row.erase(row.begin() + 5);
    without.cells.columns.erase(without.cells.columns.begin() + 5);
    EXPECT_EQ(difference(before, without).count(Turn::worse), 1);
    Folder negative = before;
    negative.cells.rows[0][6] = "-1";
    EXPECT_EQ(difference(before, negative).count(Turn::worse), 1);
}

TEST(Errors, AreNotExcusedByAFloorThatWasRaised) {
    Folder before = timed(1, 0.02);
    before.cells.columns.emplace_back("floor_error_l2_50ms");
    for (auto& row : before.cells.rows) row.emplace_back("1e-12");
    Folder after = before;
    before.cells.rows[0].back() = "1e9";
    after.cells.rows[0][6] = "0.5";
    EXPECT_EQ(difference(before, after).count(Turn::worse), 1);
}

TEST(Outcomes, OfMapsAreComparedPointByPoint) {
    Folder a, b;
    a.maps.columns =
        b.maps.columns = {"map", "scene", "scheme", "x_key", "x", "y_key", "y", "outcome"};
    a.maps.rows = {{"m", "s", "a", "rate", "1", "", "", "sound"},
                   {"m", "s", "a", "rate", "2", "", "", "sound"}};
    b.maps.rows = {{"m", "s", "a", "rate", "1", "", "", "diverged"},
                   {"m", "s", "a", "rate", "3", "", "", "sound"}};
    const Difference d = difference(a, b);
    ASSERT_EQ(d.findings.size(), 1u);
    EXPECT_EQ(d.findings[0].turn, Turn::worse);
    EXPECT_EQ(d.points.before.size(), 1u);
    EXPECT_EQ(d.points.after.size(), 1u);
    b.maps.rows[0].back() = "sound";
    EXPECT_TRUE(difference(a, b).worse());  // a point is missing
    b.maps.rows[1] = a.maps.rows[1];
    EXPECT_FALSE(difference(a, b).worse());
}

TEST(Folders, WithNothingInCommonAreRefused) {
    Folder a = cell("ok", "", 0.05, 0, 0), b = a;
    b.cells.rows[0][0] = "b";
    EXPECT_THROW(difference(a, b), bench::store::UsageError);
}

// ---- The program.

TEST(Diff, FindsAPluginThatIsTwoPerCentOffAndNothingElse) {
    const Scratch scratch;
    const std::string compare =
        "$J compare free_string --schemes honest,modal_two_point --rates 44100,88200 --duration "
        "0.05 --repeats 1 --quiet ";
    const Outcome o = shell(
        scratch, compare + "--plugin " JVARI_HONEST " --out a >/dev/null || exit 9\n" + compare +
                     "--plugin " JVARI_LOUD " --out b >/dev/null || exit 9\n" + compare +
                     "--plugin " JVARI_HONEST
                     " --out c >/dev/null || exit 9\n"
                     "$J diff a c --json >same.json; test $? = 0 || exit 8\n"
                     "$J diff b a >/dev/null; test $? = 0 || exit 7\n"
                     "$J diff a b --json");
    EXPECT_EQ(o.code, 4) << o.err;
    const auto j = nlohmann::json::parse(o.out),
               same = nlohmann::json::parse(content(scratch / "same.json"));
    EXPECT_EQ(same["worse"], 0);
    for (const auto& f : same["findings"])
        // two schemes: not told from the machine's doing
        EXPECT_EQ(f["column"], "processor_s_per_s") << f;
    EXPECT_GT(j["worse"], 2);
    bool seen = false;
    for (const auto& f : j["findings"]) {
        if (f["column"] == "processor_s_per_s") continue;
        EXPECT_EQ(f["row"].get<std::string>().rfind("free_string honest", 0), 0u) << f;
        seen = seen || (f["column"] == "error_l2_50ms" && f["turn"] == "worse");
    }
    EXPECT_TRUE(seen);
}

TEST(Diff, RefusesBadFolders) {
    const Scratch scratch;
    EXPECT_TRUE(ends(jvari(scratch, "diff " JVARI_SOURCE "/results/smoke " + (scratch / "none")), 2,
                     "no such folder"));
    EXPECT_EQ(shell(scratch, "mkdir empty; $J diff empty empty").code, 2);
    EXPECT_EQ(
        shell(scratch,
              "mkdir x; echo '{}' >x/manifest.json; printf 'a,b\\n1\\n' >x/cells.csv; $J diff x x")
            .code,
        2);
    EXPECT_EQ(shell(scratch, "$J diff x").code, 2);
    EXPECT_EQ(
        jvari(scratch, "diff " JVARI_SOURCE "/results/smoke " JVARI_SOURCE "/results/stability")
            .code,
        2);
    EXPECT_EQ(
        jvari(scratch, "diff " JVARI_SOURCE "/results/smoke " JVARI_SOURCE "/results/smoke").code,
        0);
}

TEST(Diff, EndsWith4WhereErrorsOrCellsOfTheFirstFolderAreGone) {
    const Scratch scratch;
    const std::string head = "scheme,rate,status,error_l2_50ms\\n", a = "a,1,ok,0.1\\n",
                      b = "b,1,ok,0.1\\n";
    const Outcome o =
        shell(scratch,
              "make() { mkdir $1; echo '{}' >$1/manifest.json; printf \"$2\" >$1/errors.csv; }\n"
              "make both '" +
                  head + a + b + "'; make one '" + head + a + "'; make empty '" + head +
                  "a,1,ok,\\nb,1,ok,nan\\n'\n"
                  "$J diff both empty --quiet; echo $?; $J diff both one --quiet; echo $?; $J diff "
                  "one both --quiet; echo $?\n"
                  "$J diff both one; $J diff both one --json");
    EXPECT_EQ(o.out.substr(0, 6), "4\n4\n0\n") << o.err;
    EXPECT_TRUE(says(o.out, "1 missing after, which counts as worse"));
    const auto j = nlohmann::json::parse(o.out.substr(o.out.find('{')));
    EXPECT_EQ(j["status"], "worse");
    EXPECT_EQ(j["missing"], 1);
}

}  // namespace
}  // namespace jvari::test

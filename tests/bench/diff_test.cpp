// jvari diff: what was planted is found, and nothing is found where nothing was.
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "bench/store/usage.hpp"
#include "bench/suite/difference.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

using bench::suite::Difference;
using bench::suite::Results;
using bench::suite::Turn;

constexpr int schemes = 8, rates = 4;

bench::study::TabledCell judged(const std::string& scheme, double rate, const std::string& status,
                                const bench::study::Figure& headline) {
    bench::study::TabledCell c;
    c.scene = "string", c.scheme = scheme, c.status = status;
    c.rate = rate, c.modes = 40;
    c.taps = {c.headline_nut = c.headline_bridge = "nut"};
    c.figures.emplace_back(bench::study::measures().size());
    c.figures[0][bench::study::measure("error_l2_50ms")] = headline;
    return c;
}
bench::study::Figure& headline(bench::study::TabledCell& c) {
    return c.figures[0][bench::study::measure("error_l2_50ms")];
}

// Costs as a clock gives them: a true one of each cell, times the machine's drift, times a
// disturbance of the cell and a smaller one of each of its five samples.
Results timed(unsigned seed, double disturbance, double drift = 1, int slow = -1,
              const std::string& cpu = "one") {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Results f;
    f.name = "made up";
    f.provenance.cpu = cpu;
    for (int s = 0; s < schemes; ++s)
        for (int r = 0; r < rates; ++r) {
            std::vector<double> samples;
            const double cell = std::exp(disturbance * normal(random));
            for (int k = 0; k < 5; ++k)
                samples.push_back((s + 1) * 1e-3 * (1 << r) * drift * (s == slow ? 1.3 : 1) * cell *
                                  std::exp(0.3 * disturbance * normal(random)));
            std::sort(samples.begin(), samples.end());
            bench::study::TabledCell& c = f.cells.emplace_back(
                judged("scheme_" + std::to_string(s), 44100 << r, "ok", {0.01}));
            c.cost_s_per_s = samples[2], c.cost_lower = samples[1], c.cost_upper = samples[3];
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
    for (const double cost : {double{NAN}, 0.0, -1.0}) {
        Results after = timed(1, 0.02);
        after.cells[5].cost_s_per_s = cost;
        EXPECT_EQ(difference(timed(1, 0.02), after).count(Turn::worse), 1) << cost;
    }
}

TEST(Costs, OfASingleSchemeAreNotToldFromTheMachines) {
    Results a = timed(1, 0.02), b = timed(2, 0.02, 1.3);
    a.cells.resize(rates), b.cells.resize(rates);
    const Difference d = difference(a, b);
    EXPECT_EQ(d.count(Turn::worse), 0);
    EXPECT_EQ(d.count(Turn::moved), rates);
}

// ---- Errors and outcomes.

Results cell(const std::string& status, const std::string& flags, double error, double floor,
             double certificate) {
    Results f;
    f.name = "made up";
    f.cells = {judged("a", 44100, status, {error, floor, certificate})};
    f.cells[0].flags = flags;
    return f;
}
Turn turn_between(const Results& a, const Results& b) {
    const Difference d = difference(a, b);
    EXPECT_LE(d.findings.size(), 1u);
    return d.findings.empty() ? Turn::same : d.findings[0].turn;
}

TEST(Errors, GetWorseBeyondNoiseAndCertificatesAlone) {
    const Results was = cell("ok", "", 0.05, 1e-12, 1e-3);
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
    Results was = cell("ok", "", 0.05, 1e-12, 1e-3), is = cell("ok", "", 0.08, 1e-12, 1e-3);
    EXPECT_EQ(bench::suite::difference(was, is).references, "");
    was.cells[0].reference = "exact_contact";
    is.cells[0].reference = "sundials";
    const std::string text = text_of(bench::suite::difference(was, is), was, is);
    EXPECT_TRUE(text.starts_with(
        "the references differ in 1 of 1 cells (reference exact_contact -> sundials)"))
        << text;
}

TEST(Errors, ThatAreNoLongerKnownAreWorse) {
    const Results was = cell("ok", "", 0.05, 1e-12, 1e-3);
    Results is = was;
    headline(is.cells[0]).value = NAN;
    EXPECT_EQ(turn_between(was, is), Turn::worse);
    EXPECT_EQ(turn_between(is, was), Turn::better);
    EXPECT_EQ(turn_between(is, is), Turn::same);
    is.cells[0].taps.clear(), is.cells[0].figures.clear();  // all errors of the tap
    EXPECT_EQ(turn_in(difference(was, is), "error_l2_50ms"), Turn::worse);
}

TEST(Cells, ThatCameBackToTheLastDigitAreCounted) {
    Results was = cell("ok", "", 0.05, 1e-12, 1e-3);
    was.cells.push_back(judged("b", 44100, "ok", {0.05, 1e-12, 1e-3}));
    for (auto& c : was.cells) c.processor_s_per_s = 1;
    Results is = was;
    is.cells[0].processor_s_per_s = 2;  // a clock's
    const std::string text = text_of(bench::suite::difference(was, is), was, is);
    EXPECT_TRUE(says(text, "\n2 of 2 cells came back to the last digit")) << text;
    is = was;
    headline(is.cells[1]).value = 0.05000000000000001;  // below noise
    const Difference d = difference(was, is);
    EXPECT_TRUE(d.nothing());
    EXPECT_TRUE(says(text_of(d, was, is), "\n1 of 2 cells came back to the last digit"));
}

TEST(Errors, AMeasureThatTheEarlierFolderLacksIsAColumnAndOneThatIsGoneIsWorse) {
    const Results was = cell("ok", "", 0.05, 1e-12, 1e-3);
    Results is = was;
    is.cells[0].figures[0][bench::study::measure("error_l2_heard")].value = 0.04;
    const Difference more = difference(was, is), less = difference(is, was);
    EXPECT_TRUE(more.findings.empty());
    EXPECT_EQ(more.columns.after, std::vector<std::string>{"error_l2_heard"});
    EXPECT_EQ(turn_in(less, "error_l2_heard"), Turn::worse);
}

TEST(Errors, AreNotExcusedByACertificateThatGrew) {
    const Results was = cell("ok", "", 0.05, 1e-12, 1e-3);
    const Difference nine = difference(was, cell("ok", "", 0.45, 1e-12, 1e9));
    EXPECT_EQ(turn_in(nine, "error_l2_50ms"), Turn::worse);
    EXPECT_EQ(turn_in(nine, "certificate of error_l2_50ms"), Turn::worse);
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
    Results two = cell("ok", "", 0.05, 1e-12, 1e-3), one = two;
    two.cells.push_back(judged("b", 44100, "ok", {0.05, 1e-12, 1e-3}));
    EXPECT_TRUE(difference(two, one).worse());
    EXPECT_EQ(difference(two, one).missing(), 1);
    EXPECT_FALSE(difference(one, two).worse());
}

Results boundary(const std::string& low, const std::string& high) {
    Results f;
    f.boundaries.columns = {"map", "scheme", "x_key", "y_key", "y", "between", "x_low", "x_high"};
    f.boundaries.rows = {{"m", "a", "rate", "", "", "sound and diverged", low, high}};
    return f;
}

TEST(Boundaries, MovedWhereTheirBracketsAreApartOnEitherSide) {
    const Results was = boundary("10", "20");
    for (const auto& [low, high] : {std::pair{"21", "30"}, {"1", "9"}})
        EXPECT_EQ(turn_between(was, boundary(low, high)), Turn::moved) << low;
    for (const auto& [low, high] : {std::pair{"20", "30"}, {"1", "10"}, {"12", "13"}, {"5", "50"}})
        EXPECT_EQ(turn_between(was, boundary(low, high)), Turn::same) << low;
}

TEST(Boundaries, ThatAreGoneAreToldAndAreNotWorse) {
    Results one = boundary("10", "20"), two = one;
    two.boundaries.rows.push_back({"m", "b", "rate", "", "", "sound and diverged", "1", "2"});
    const Difference d = difference(two, one);
    EXPECT_FALSE(d.worse());
    EXPECT_FALSE(d.nothing());
}

TEST(Outcomes, ThatFailAreWorseAndFlagsToo) {
    const Results was = cell("ok", "", 0.05, 1e-12, 1e-3);
    EXPECT_EQ(turn_between(was, cell("diverged", "", 0.05, 1e-12, 1e-3)), Turn::worse);
    EXPECT_EQ(turn_between(cell("diverged", "", 0.05, 1e-12, 1e-3), was), Turn::better);
    EXPECT_EQ(turn_between(was, cell("ok", "adhesion", 0.05, 1e-12, 1e-3)), Turn::worse);
}

TEST(Outcomes, AFurtherFlagAndANegativeErrorAreWorse) {
    Results before = timed(1, 0.02);
    for (auto& c : before.cells) c.flags = "energy";
    Results after = before;
    after.cells[0].flags = "adhesion energy";
    EXPECT_EQ(difference(before, after).count(Turn::worse), 1);
    EXPECT_EQ(difference(after, before).count(Turn::better), 1);
    Results negative = before;
    headline(negative.cells[0]).value = -1;
    EXPECT_EQ(difference(before, negative).count(Turn::worse), 1);
}

TEST(Errors, AreNotExcusedByAFloorThatWasRaised) {
    Results before = timed(1, 0.02);
    for (auto& c : before.cells) headline(c).floor = 1e-12;
    Results after = before;
    headline(before.cells[0]).floor = 1e9;
    headline(after.cells[0]).value = 0.5;
    EXPECT_EQ(difference(before, after).count(Turn::worse), 1);
}

TEST(Outcomes, OfMapsAreComparedPointByPoint) {
    Results a, b;
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
    Results a = cell("ok", "", 0.05, 0, 0), b = a;
    b.cells[0].scheme = "b";
    EXPECT_THROW(difference(a, b), bench::store::UsageError);
}

// ---- The program.

TEST(Diff, FindsAPluginThatIsTwoPerCentOffAndNothingElse) {
    const Scratch scratch;
    const std::string compare =
        "$J compare free_string --schemes honest,modal_two_point --rates 44100,88200 --duration "
        "0.05 --repeats 1 --quiet ";
    const Ended o = shell(
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
              "mkdir x; echo '{}' >x/manifest.json; printf 'a,b\\n1\\n' >x/facts.csv; $J diff x x")
            .code,
        2);
    EXPECT_TRUE(ends(shell(scratch,
                           "mkdir y; echo '{}' >y/manifest.json; printf "
                           "'cell,scheme,rate,status\\na,x,1,ok\\n' >y/facts.csv; "
                           "$J diff y y"),
                     2, "facts.csv: found no column flags"));
    EXPECT_EQ(shell(scratch, "$J diff x").code, 2);
    EXPECT_EQ(
        jvari(scratch, "diff " JVARI_SOURCE "/results/smoke " JVARI_SOURCE "/results/stability")
            .code,
        2);
    EXPECT_EQ(
        jvari(scratch, "diff " JVARI_SOURCE "/results/smoke " JVARI_SOURCE "/results/smoke").code,
        0);
}

// cells.csv is to look at, and people read it.
TEST(Diff, SeesThatCellsCsvNoLongerFollowsFromTheOtherFiles) {
    const Scratch scratch;
    const Ended o =
        shell(scratch,
              "$J compare free_string --schemes modal_two_point --rates 44100 --modes 20 "
              "--reference-modes 20 --duration 0.005 --repeats 1 --out one --quiet >/dev/null\n"
              "$J diff one one --quiet; echo $?\n"
              "for edit in 1s/status/stat/ 2s/,ok,/,refused,/ 2d; do\n"
              "    rm -rf two; cp -r one two; sed -i $edit two/cells.csv; $J diff one two --quiet; "
              "echo $?\n"
              "done\n");
    EXPECT_EQ(o.out, "0\n4\n4\n4\n") << o.err;
}

TEST(Diff, EndsWith4WhereErrorsOrCellsOfTheFirstFolderAreGone) {
    const Scratch scratch;
    const Ended o =
        shell(scratch,
              "make() {\n"
              "    mkdir $1; cd $1; echo '{}' >manifest.json; shift\n"
              "    echo cell,scheme,rate,status,flags,headline_nut >facts.csv\n"
              "    echo cell,tap,measure,value,floor >errors.csv\n"
              "    for cell; do\n"
              "        echo ${cell%=*},${cell%=*},1,ok,,nut >>facts.csv\n"
              "        echo ${cell%=*},nut,error_l2_50ms,${cell#*=}, >>errors.csv\n"
              "    done; cd ..\n"
              "}\n"
              "make both a=0.1 b=0.1; make one a=0.1; make empty a= b=nan\n"
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

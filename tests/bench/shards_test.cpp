// A suite by several processes that share a folder: the same tables to the last byte, each reference made once, what is lost is named; and
// costs of two machines are never compared.
#include "bench/suite/suite_parts.hpp"

#include <fcntl.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <map>
#include <set>

#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/pareto.hpp"
#include "bench/compare/record/scaling_table.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/usage.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* study = R"(
[[cells]]
scenes = ["tanpura_c3_release", "free_string"]
schemes = ["modal_two_point", "modal_strang", "finite_difference_explicit"]
rates = [44100, 88200]
reference_modes = 266
duration = 0.012
[[cells]]
scenes = ["two_point_bridge"]
schemes = ["modal_two_point", "modal_quadratised"]
rates = [88200, 176400]
duration = 0.01
repeats = 2
measure = ["errors", "cost"]
[[map]]
name = "penalty"
scene = "tanpura_c3"
schemes = ["modal_explicit_penalty", "modal_two_point"]
x = { key = "rate", from = 1e5, to = 1e6, points = 3 }
y = { key = "string.0.tension", values = [30, 40] }
set = { "string.0.barrier.0.stiffness" = 4.39e6 }
modes = 60
duration = 0.02
reference = "none"
refine = 5
reproduce = false
[[map]]
name = "tension"
scene = "tanpura_c3_release"
schemes = ["modal_two_point", "modal_strang"]
x = { key = "string.0.tension", values = [30, 40] }
duration = 0.01
reproduce = false
)";

std::string shard(int i, int n) {
    return "suite a.toml --out all --quiet --shard " + std::to_string(i) + "/" + std::to_string(n);
}

TEST(Shards, InAnyOrderGatheredAreTheTablesOfOneProcess) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml") << study;
    ASSERT_EQ(shell(scratch, "$J suite a.toml --out whole --quiet").code, 0) << content(scratch / "stderr");
    Outcome o = shell(scratch, "$J " + shard(1, 5));
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("there is no all/plan.csv: --prepare writes it"), std::string::npos) << o.err;
    ASSERT_EQ(shell(scratch, "$J suite a.toml --out all --prepare").code, 0) << content(scratch / "stderr");
    EXPECT_GT(bench::store::read_csv(content(scratch / "all/plan.csv")).rows.size(), 20u);
    ASSERT_EQ(shell(scratch, "$J " + shard(3, 5) + " & $J " + shard(1, 5) + " && wait $!").code, 0) << content(scratch / "stderr");

    o = shell(scratch, "$J suite a.toml --out all --gather");
    EXPECT_EQ(o.code, 4);
    EXPECT_NE(o.err.find(" missing:"), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("the clock of two_point_bridge: "), std::string::npos) << o.err;
    EXPECT_NE(content(scratch / "all/errors.csv"), content(scratch / "whole/errors.csv"));
    EXPECT_TRUE(fs::exists(scratch / "all/report.html"));

    ASSERT_EQ(shell(scratch, "$J " + shard(5, 5) + " & $J " + shard(4, 5) + " && $J " + shard(2, 5) + " && wait $!").code, 0)
        << content(scratch / "stderr");
    o = shell(scratch, "$J suite a.toml --out all --gather");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(o.err.find(" missing:"), std::string::npos) << o.err;
    EXPECT_NE(o.out.find(" 0 run, 0 timed, 16 read back"), std::string::npos) << o.out;
    for (const char* name : {"errors.csv", "convergence.csv", "maps.csv", "boundaries.csv"})
        EXPECT_EQ(content(scratch.path / "all" / name), content(scratch.path / "whole" / name)) << name;
    EXPECT_GT(bench::store::read_csv(content(scratch / "all/boundaries.csv")).rows.size(), 0u);

    for (const char* lost : {"cells", "points"}) fs::remove(*fs::directory_iterator(scratch.path / "all" / lost));
    EXPECT_EQ(shell(scratch, "$J suite a.toml --out all --gather").code, 4);
    ASSERT_EQ(shell(scratch, "$J " + shard(1, 1)).code, 0);
    EXPECT_EQ(shell(scratch, "$J suite a.toml --out all --gather").code, 0);
    EXPECT_EQ(content(scratch / "all/errors.csv"), content(scratch / "whole/errors.csv"));

    std::ofstream(scratch / "a.toml", std::ios::app) << "[[cells]]\nscenes = [\"free_string\"]\nschemes = [\"modal_strang\"]\n";
    o = shell(scratch, "$J " + shard(1, 5));
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("was written for another suite, or by another program"), std::string::npos) << o.err;
}

TEST(Shards, StartedTogetherMakeEachReferenceOnce) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml") << study;
    ASSERT_EQ(shell(scratch, "$J suite a.toml --out all --prepare --quiet").code, 0);
    std::set<std::string> prepared;
    for (const auto& entry : fs::directory_iterator(scratch / "all/references")) {
        prepared.insert(entry.path().filename());
        fs::remove(entry.path());
    }
    EXPECT_GE(prepared.size(), 4u);
    const int watch = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    ASSERT_GE(inotify_add_watch(watch, (scratch / "all/references").c_str(), IN_MOVED_TO), 0);
    ASSERT_EQ(shell(scratch, "$J " + shard(1, 2) + " & $J " + shard(2, 2) + " && wait $!").code, 0) << content(scratch / "stderr");
    std::map<std::string, int> written;
    alignas(inotify_event) char buffer[65536];
    for (ssize_t n = 0; (n = read(watch, buffer, sizeof buffer)) > 0;)
        for (ssize_t at = 0; at < n;) {
            const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
            ++written[event->name];
            at += static_cast<ssize_t>(sizeof *event) + event->len;
        }
    close(watch);
    EXPECT_EQ(written.size(), prepared.size() + 2);  // and those of a map, whose two schemes are dealt to two shards and share them
    for (const auto& [name, times] : written) EXPECT_EQ(times, 1) << name;
}

TEST(Shards, EveryPartIsDealtOnceAndClocksGoToTheLast) {
    const Scratch scratch;
    const bench::suite::Suite suite = bench::suite::parse_suite(study, "a.toml");
    const bench::compare::Catalogue catalogue;
    const bench::suite::SuitePlan plan = bench::suite::plan_of(suite, catalogue, {});
    const bench::suite::Parts parts = bench::suite::parts_of(plan, suite.maps, catalogue);
    ASSERT_EQ(parts.clocks.size(), 1u);
    ASSERT_EQ(parts.rows.size(), 6u);
    for (const int of : {1, 2, 3, 7, 100}) {
        std::multiset<std::size_t> cells;
        std::size_t rows = 0, clocks = 0;
        for (int i = 1; i <= of; ++i) {
            const bench::suite::Share share = bench::suite::share_of(parts, {i, of});
            cells.insert(share.work.cells.begin(), share.work.cells.end());
            rows += share.rows.size();
            clocks += share.work.clocks.size();
            EXPECT_EQ(share.work.clocks.size(), i == of ? 1u : 0u) << i << " of " << of;
            if (i == of && of > 1) {
                EXPECT_TRUE(share.work.cells.empty() && share.rows.empty());
            }
        }
        EXPECT_EQ(cells.size(), plan.cells.size());
        EXPECT_EQ(std::set<std::size_t>(cells.begin(), cells.end()).size(), plan.cells.size());
        EXPECT_EQ(rows, 6u);
        EXPECT_EQ(clocks, 1u);
    }
    EXPECT_EQ(bench::suite::shard_of("3/20").number, 3);
    for (const char* wrong : {"", "3", "0/2", "3/2", "-1/2", "1/2x", "a/b", "1/"})
        EXPECT_THROW(bench::suite::shard_of(wrong), bench::store::UsageError) << wrong;
}

TEST(Shards, TheScriptForSlurmIsOneThatAShellReads) {
    const Scratch scratch;
    std::ofstream(scratch / "it's a.toml") << study;
    const Outcome o = shell(scratch, "$J suite \"it's a.toml\" --out 'my study' --print slurm > job.sh && sh -n job.sh && cat job.sh");
    EXPECT_EQ(o.code, 0) << o.err;
    for (const char* part :
         {"--prepare", "--shard \"$SLURM_ARRAY_TASK_ID/$JVARI_SHARDS\"", "--gather", "--requeue", "exec '", "--exclusive"})
        EXPECT_NE(o.out.find(part), std::string::npos) << part;
    EXPECT_FALSE(fs::exists(scratch / "my study"));
    EXPECT_EQ(shell(scratch, "$J suite \"it's a.toml\" --prepare").code, 2);
    EXPECT_EQ(shell(scratch, "$J suite \"it's a.toml\" --out a --prepare --gather").code, 2);
}

// ---- Two machines

bench::store::Table timed_on(
    const std::vector<std::string>& machines) {  // one scheme a row, each cheaper and as accurate as the one before
    bench::store::Table t;
    t.columns = {
        "scene",        "scheme",     "options",    "rate",        "modes",  "status", "flags", "error_l2_50ms", "certificate_l2_50ms",
        "cost_s_per_s", "cost_lower", "cost_upper", "ns_per_step", "machine"};
    for (std::size_t i = 0; i < machines.size(); ++i) {
        const std::string cost = std::to_string(10 - i), rate = std::to_string(44100 << i);
        t.rows.push_back({"a", "s" + std::to_string(i), "", rate, "10", "ok", "", "0.005", "1e-9", cost, cost, cost, cost, machines[i]});
    }
    return t;
}

TEST(Machines, EachHasItsOwnFrontAndItsOwnCheapest) {
    const std::vector<std::string> one(4, "A"), two = {"A", "B", "A", "B"};
    const auto front = [](const bench::store::Table& t) {
        return bench::compare::pareto_front(t, bench::store::all_rows(t), "error_l2_50ms", "cost_s_per_s");
    };
    EXPECT_EQ(front(timed_on(one)), (std::vector<bool>{false, false, false, true}));
    EXPECT_EQ(front(timed_on(two)), (std::vector<bool>{false, false, true, true}));

    const bench::store::Table cheapest = bench::compare::cheapest_of(timed_on(two));
    std::map<std::string, std::string> of;
    for (std::size_t i = 0; i < cheapest.rows.size(); ++i)
        if (cheapest.at(i, "target") == "0.01") of[cheapest.at(i, "machine")] = cheapest.at(i, "scheme");
    EXPECT_EQ(of, (std::map<std::string, std::string>{{"A", "s2"}, {"B", "s3"}}));
    EXPECT_NE(bench::compare::cheapest_text(cheapest).find("several machines: each has its own"), std::string::npos);
    EXPECT_EQ(bench::compare::cheapest_of(timed_on(one)).column("machine"), -1);
    EXPECT_NE(bench::store::machines_text(timed_on(two)).find("timed on 2 machines"), std::string::npos);
    EXPECT_EQ(bench::store::machines_text(timed_on(one)), "");
}

TEST(Machines, NoFitAndNoDifferenceIsOfTwo) {
    const auto fits = [](const std::vector<std::string>& machines) {
        bench::store::Table t = timed_on(machines);
        for (auto& row : t.rows) row[1] = "s";  // one scheme at four rates
        return bench::compare::scaling_of(t, {bench::store::all_rows(t)});
    };
    const bench::store::Table one = fits({"A", "A", "A", "A"}), two = fits({"A", "A", "A", "B"});
    ASSERT_EQ(one.rows.size(), 4u);
    ASSERT_EQ(two.rows.size(), 3u);  // a single row of B is no series
    for (std::size_t i = 0; i < two.rows.size(); ++i) EXPECT_EQ(two.at(i, "machine"), "A");
    EXPECT_NE(one.at(0, "exponent"), two.at(0, "exponent"));
}

TEST(Machines, StampsOfTwoInOneFolderGiveASentenceAndACostOfEach) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml") << R"(
[[cells]]
scenes = ["two_point_bridge"]
schemes = ["modal_two_point"]
rates = [88200, 176400]
duration = 0.01
repeats = 2
measure = ["errors", "cost"]
[[cells]]
scenes = ["two_point_bridge"]
schemes = ["modal_quadratised"]
rates = [88200, 176400]
duration = 0.01
repeats = 2
measure = ["errors", "cost"]
)";
    ASSERT_EQ(shell(scratch, "$J suite a.toml --out all --quiet").code, 0) << content(scratch / "stderr");
    const bench::suite::Suite suite = bench::suite::parse_suite(content(scratch / "a.toml"), "a.toml");
    const bench::compare::Catalogue catalogue;
    bench::suite::SuitePlan plan = bench::suite::plan_of(suite, catalogue, {});
    const fs::path cells = scratch / "all/cells";
    const auto timed_elsewhere = [&](std::size_t i, bool as_well) {
        const fs::path here = cells / bench::suite::clock_file(plan.cells[i], bench::store::stamp_now());
        auto clock = bench::suite::read_clock(here, plan.cells[i].identity);
        ASSERT_TRUE(clock);
        EXPECT_GT(clock->wall.median, 0);
        EXPECT_FALSE(clock->stamp.name.empty() || clock->stamp.load.empty() || clock->stamp.at.empty());
        if (!as_well) fs::remove(here);
        clock->stamp.name = "another CPU, 64 cores";
        clock->wall.median = 77;
        std::ofstream(cells / bench::suite::clock_file(plan.cells[i], clock->stamp)) << clock_json(*clock, plan.cells[i].identity);
    };
    timed_elsewhere(0, true);  // of the first set one cell, as well as here: the set stays on this machine
    timed_elsewhere(2, false);
    timed_elsewhere(3, false);
    const Outcome o = shell(scratch, "$J suite a.toml --out all --gather");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.err.find("cells were timed on 2 machines; costs are compared within each alone"), std::string::npos) << o.err;
    const bench::store::Table t = bench::store::read_csv(content(scratch / "all/cells.csv"));
    EXPECT_EQ(t.at(0, "machine"), bench::store::stamp_now().name);
    EXPECT_EQ(t.at(1, "machine"), bench::store::stamp_now().name);
    EXPECT_EQ(t.at(2, "machine"), "another CPU, 64 cores");
    EXPECT_EQ(t.number(3, "wall_seconds"), 77);
    EXPECT_EQ(bench::store::read_csv(content(scratch / "all/errors.csv")).column("machine"), -1);

    fs::remove(cells / bench::suite::clock_file(plan.cells[1], bench::store::stamp_now()));  // the set has no machine that timed all of it
    const Outcome resumed = shell(scratch, "$J suite a.toml --out all --resume");
    EXPECT_NE(resumed.out.find("4 cells, 0 run, 1 timed"), std::string::npos) << resumed.out;
    bench::store::Stamp elsewhere;
    elsewhere.name = "another CPU, 64 cores";
    fs::remove(cells / bench::suite::clock_file(plan.cells[3], elsewhere));  // nor has the other: both of its cells are timed here
    EXPECT_NE(shell(scratch, "$J suite a.toml --out all --resume").out.find("4 cells, 0 run, 2 timed"), std::string::npos);
}

}  // namespace
}  // namespace jvari::test

// A suite by several processes that share a folder: the same tables to the last byte, each cell and
// each reference once, and none lost with who ran it; costs of one machine.
#include <fcntl.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <map>
#include <set>
#include <thread>

#include "bench/store/fresh_file.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/study/cost.hpp"
#include "bench/suite/suite.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* study = R"(
[[cells]]
scenes = ["tanpura_c3_release", "free_string"]
schemes = ["modal_two_point", "modal_quadratised", "finite_difference_explicit"]
rates = [44100, 88200]
reference_modes = 266
search = false
duration = 0.012
[[cells]]
scenes = ["two_point_bridge"]
schemes = ["modal_two_point", "modal_quadratised"]
rates = [88200, 176400]
reference_modes = "cell"
duration = 0.01
repeats = 2
measure = ["errors", "cost"]
[[cells]]
name = "penalty"
scenes = "tanpura_c3"
schemes = ["modal_explicit_penalty", "modal_two_point"]
measure = "outcome"
sweep = { rate = { from = 1e5, to = 1e6, points = 3 }, "string.0.tension" = [30, 40] }
set = { "string.0.barrier.0.stiffness" = 4.39e6 }
modes = 60
duration = 0.02
reference = "none"
refine = 5
[[cells]]
name = "tension"
scenes = "tanpura_c3_release"
schemes = ["modal_two_point", "modal_quadratised"]
measure = "outcome"
sweep = { "string.0.tension" = [30, 40] }
duration = 0.01
reproduce = false
)";

const std::string costs = suite_of("free_string", "modal_two_point", "44100, 88200",
                                   "reference_modes = 'cell'\nduration = 0.01\nrepeats = 2\n"
                                   "measure = ['errors', 'cost']");

// Of what processes wrote into out1, out2 ... : the numbers before a word, as in "16 points, 4
// boundaries: 5 run".
std::vector<int> numbers_before(const std::string& word, const Scratch& scratch, int processes) {
    std::vector<int> all;
    for (int k = 1; k <= processes; ++k) {
        std::istringstream words(content(scratch / ("out" + std::to_string(k))));
        for (std::string last, next; words >> next; last = next)
            if (next == word) all.push_back(std::stoi(last));
    }
    return all;
}

std::vector<std::string> locks_below(const fs::path& folder) {
    std::vector<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".lock") all.push_back(entry.path());
    return all;
}

std::map<std::string, int> moved_into(int watch) {  // how often each file
    std::map<std::string, int> times;
    alignas(inotify_event) char buffer[65536];
    for (ssize_t n = 0; (n = ::read(watch, buffer, sizeof buffer)) > 0;)
        for (ssize_t at = 0; at < n;) {
            const auto* event = reinterpret_cast<const inotify_event*>(buffer + at);
            ++times[event->name];
            at += static_cast<ssize_t>(sizeof *event) + event->len;
        }
    return times;
}

TEST(SharedFolder, ThreeProcessesComeToTheTablesOfOneAndDoNothingTwice) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml") << study;
    ASSERT_EQ(shell(scratch, "$J suite a.toml --out whole >out1").code, 0)
        << content(scratch / "stderr");
    const std::vector<int> alone = numbers_before("run,", scratch, 1);
    ASSERT_EQ(alone.size(), 2u);  // points of maps, cells
    const int watch = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    for (const char* name : {"cells", "references"}) {
        fs::create_directories(scratch.path / "all" / name);
        ASSERT_GE(inotify_add_watch(watch, (scratch.path / "all" / name).c_str(), IN_MOVED_TO), 0);
    }
    const std::string lines =
        "for k in 1 2 3; do $J suite a.toml --out all --resume --jobs 1 >out$k & all=\"$all $!\"; "
        "done\n"
        "for p in $all; do wait $p || exit 1; done";
    ASSERT_EQ(shell(scratch, lines).code, 0) << content(scratch / "stderr");
    int clocks = 0, references = 0;
    for (const auto& [name, times] : moved_into(watch)) {
        EXPECT_EQ(times, 1) << name;
        clocks += name.ends_with(".clock");
        references += name.ends_with(".run");
    }
    close(watch);
    EXPECT_EQ(clocks, 4);
    EXPECT_EQ(references,
              // of each scene the truth, those with fewer modes that bound it, own modes beside a
              // matched one, and one with a cell's own modes and compliance
              20);
    const std::vector<int> shared = numbers_before("run,", scratch, 3);
    ASSERT_EQ(shared.size(), 6u);
    EXPECT_EQ(shared[0] + shared[2] + shared[4], alone[0]);
    EXPECT_EQ(shared[1] + shared[3] + shared[5], alone[1]);
    EXPECT_EQ(alone[1], 16);
    const std::vector<int> timed = numbers_before("timed,", scratch, 3);
    // all by one of them
    EXPECT_EQ(std::set<int>(timed.begin(), timed.end()), (std::set<int>{0, 4}));
    EXPECT_EQ(locks_below(scratch.path), std::vector<std::string>());
    for (const char* name :
         {"errors.csv", "convergence.csv", "maps.csv", "boundaries.csv", "failures/index.csv"})
        EXPECT_EQ(content(scratch.path / "all" / name), content(scratch.path / "whole" / name))
            << name;
    EXPECT_GT(bench::store::read_csv(content(scratch / "all/boundaries.csv")).rows.size(), 0u);
    EXPECT_GT(bench::store::read_csv(content(scratch / "all/failures/index.csv")).rows.size(), 0u);
    std::map<fs::path, fs::file_time_type> minimised;  // kept beside the cells
    for (const auto& entry : fs::directory_iterator(scratch / "all/cells"))
        if (const fs::path index = entry.path() / "index.csv"; fs::exists(index))
            minimised[index] = fs::last_write_time(index);
    EXPECT_EQ(minimised.size(),
              bench::store::read_csv(content(scratch / "all/failures/index.csv")).rows.size());
    const Ended again = shell(scratch, "$J suite a.toml --out all --resume");
    EXPECT_EQ(again.code, 0);
    for (const auto& [index, written] : minimised)
        EXPECT_EQ(fs::last_write_time(index), written) << "minimised again: " << index;
    EXPECT_FALSE(says(again.err, "holds what is not of"));
    EXPECT_TRUE(says(again.out, "16 cells, 0 run, 0 timed, 16 read back"));
}

TEST(SharedFolder, WhoIsKilledHoldsNobodyUp) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml")  // cells of some tenths of a second
        << suite_of("free_string", "modal_two_point,modal_quadratised", "1411200",
                    "modes = 100\nreference_modes = 'cell'\nduration = 0.4\n"
                    "sweep = { 'string.0.tension' = [30, 31, 32, 33] }");
    ASSERT_EQ(shell(scratch, "$J suite a.toml --out whole --quiet").code, 0)
        << content(scratch / "stderr");
    // One of the three is stopped while it runs a cell; the others run all that is left, say for
    // whom they wait, and see it die.
    const Ended o = shell(scratch, R"sh(
for k in 1 2 3; do $J suite a.toml --out all --resume --jobs 1 >out$k 2>err$k & all="$all $!"; done
stopped() { [ "$(sed -n 's/^State:.\(.\).*/\1/p' /proc/$1/status)" = T ]; }
while [ -z "$held" ]; do
    for p in $all; do kill -0 $p || exit 9; done
    for lock in all/cells/????????*.lock; do
        p=$(sed -n 's/^process \([0-9]*\) on .*/\1/p' "$lock" 2>/dev/null); [ -n "$p" ] || continue
        kill -STOP $p || exit 9; until stopped $p; do :; done
        if grep -q "process $p " "$lock" 2>/dev/null; then held=$p cell=${lock%.lock}; break; fi
        kill -CONT $p
    done
done
for p in $all; do [ $p = $held ] || others="$others $p"; done
waits="waiting for process $held on .*, which \(runs free_string\|makes all/references\)"
until [ "$(grep -l "$waits" err1 err2 err3 | wc -l)" = 2 ]; do
    for p in $others; do kill -0 $p || exit 8; done; sleep 0.1
done
[ ! -e "$cell" ] || exit 7
kill -KILL $held
for p in $others; do wait $p || exit 6; done
)sh");
    EXPECT_EQ(o.code, 0) << o.err << content(scratch / "err1") << content(scratch / "err2")
                         << content(scratch / "err3");
    EXPECT_EQ(content(scratch / "all/errors.csv"), content(scratch / "whole/errors.csv"));
    EXPECT_EQ(locks_below(scratch.path), std::vector<std::string>());
}

TEST(SharedFolder, TwoProgramsHaveEachTheirOwnCells) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml")
        << suite_of("free_string,two_point_bridge", "modal_two_point,modal_quadratised",
                    "44100, 88200", "reference_modes = 'cell'\nduration = 0.01");
    const std::string suite = "$J suite a.toml --out ",
                      // another program: its plugin counts into the key
        plugin = " --plugin " JVARI_HONEST;
    ASSERT_EQ(shell(scratch, suite + "whole --quiet").code, 0) << content(scratch / "stderr");
    ASSERT_EQ(shell(scratch, suite + "all --resume >out1 & " + suite + "all --resume" + plugin +
                                 " >out2 && wait $!")
                  .code,
              0);
    EXPECT_EQ(numbers_before("run,", scratch, 2), (std::vector<int>{8, 8}));
    EXPECT_TRUE(
        says(shell(scratch, suite + "all --resume" + plugin).out, " 0 run, 0 timed, 8 read back"));
    EXPECT_TRUE(says(shell(scratch, suite + "all --resume").out, " 0 run, 0 timed, 8 read back"));
    EXPECT_EQ(content(scratch / "all/errors.csv"), content(scratch / "whole/errors.csv"));
}

TEST(SharedFolder, WhatIsNoLockInTheirPlaceHoldsNobodyUp) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml") << suite_of("free_string", "modal_two_point", "44100",
                                                  "reference_modes = 'cell'\nduration = 0.01");
    const std::string suite = "timeout 60 $J suite a.toml --out all --resume";
    ASSERT_EQ(shell(scratch, suite).code, 0) << content(scratch / "stderr");
    const std::string table = content(scratch / "all/errors.csv");
    std::vector<fs::path> files;
    for (const char* name : {"cells", "references"})
        for (const auto& entry : fs::directory_iterator(scratch.path / "all" / name))
            files.push_back(entry.path());
    ASSERT_EQ(files.size(), 3u);
    for (const fs::path& file : files) {
        fs::remove(file);
        if (file == files.back()) ASSERT_EQ(mkfifo((file.string() + ".lock").c_str(), 0600), 0);
        else fs::create_directory(file.string() + ".lock");
    }
    EXPECT_FALSE(says(shell(scratch, suite).err, "no file can be locked here"));
    for (const fs::path& file : files)
        EXPECT_TRUE(fs::exists(file) && fs::exists(file.string() + ".lock")) << file;
    EXPECT_EQ(content(scratch / "all/errors.csv"), table);
    fs::create_directory(scratch / "all/cells/any.lock");
    EXPECT_TRUE(says(shell(scratch, suite).err,
                     "all: no file can be locked here. Processes that share this folder"));
}

TEST(SharedFolder, CostsAreTimedByOneProcessAtATimeOnceAllCellsAreThere) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml") << costs;
    fs::create_directories(scratch / "all/cells");
    const auto files = [&](const char* extension) {
        return std::count_if(
            fs::directory_iterator(scratch / "all/cells"), fs::directory_iterator(),
            [&](const auto& entry) { return entry.path().extension() == extension; });
    };
    std::optional<bench::store::FileLock> other(std::in_place, scratch / "all/cells/clock",
                                                "times the cells");
    Ended o{};
    std::atomic<bool> ended = false;
    std::jthread suite([&] {
        o = jvari(scratch,
                  "suite " + (scratch / "a.toml") + " --resume --out " + (scratch / "all"));
        ended = true;
    });
    const std::string waits = "waiting for process " + std::to_string(getpid()) + " on ";
    while (!ended && content(scratch / "stderr").find(waits) == std::string::npos)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(ended);
    EXPECT_EQ(files(".json"), 2);
    EXPECT_EQ(files(".clock"), 0);
    other.reset();
    suite.join();
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(files(".clock"), 2);
}

TEST(Machines, AFolderHasTheCostsOfOne) {
    const Scratch scratch;
    std::ofstream(scratch / "a.toml") << costs;
    const std::string resume = "$J suite a.toml --out all --resume";
    ASSERT_EQ(shell(scratch, resume + " --quiet").code, 0) << content(scratch / "stderr");
    const bench::suite::Suite suite =
        bench::suite::parse_suite(content(scratch / "a.toml"), "a.toml");
    const bench::study::Plan plan =
        bench::suite::plan_of(suite.sets, bench::compare::Catalogue{}, {});
    const auto file = [&](std::size_t i) {
        return scratch.path / "all/cells" / bench::study::clock_file(plan.jobs[i]);
    };
    auto clock = bench::study::read_clock(file(0), plan.jobs[0].identity);
    ASSERT_TRUE(clock);
    EXPECT_GT(clock->wall.median, 0);
    EXPECT_FALSE(clock->stamp.name.empty() || std::isnan(clock->stamp.load) ||
                 clock->stamp.at.empty());
    fs::remove(file(1));
    EXPECT_TRUE(says(shell(scratch, resume).out, "2 cells, 0 run, 1 timed"));

    clock->stamp.name = "another CPU, 64 cores";
    clock->wall.median = 77;
    std::ofstream(file(0)) << clock_json(*clock, plan.jobs[0].identity);
    fs::remove(file(1));
    fs::remove(scratch.path / "all/cells" / (plan.jobs[1].id + ".json"));
    const Ended o = shell(scratch, resume);
    EXPECT_TRUE(ends(o, 0, "2 cells, 1 run, 0 timed"));  // the errors are no machine's
    EXPECT_TRUE(says(o.err,
                     "the costs in all/cells come from another machine, another CPU, 64 cores; "
                     "cells without a cost are not timed"));
    const bench::store::Table t = bench::store::read_csv(content(scratch / "all/cells.csv"));
    EXPECT_EQ(t.number(0, "wall_seconds"), 77);
    EXPECT_EQ(t.text(1, "cost_s_per_s"), "");
    EXPECT_NE(t.text(1, "error_l2_10ms"), "");
}

}  // namespace
}  // namespace jvari::test

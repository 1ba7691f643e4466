// Any program as a scheme: what it leaves behind, what it says without end, what its command names,
// and how it fails.
#include <array>

#include "bench/store/records.hpp"
#include "tests/command_line.hpp"
#include "tests/sanitized.hpp"

namespace jvari::test {
namespace {

// A script whose trace is silence; `more` comes before.
std::string silence(const std::string& file, const std::string& more = "") {
    return "cat > '" + file + "' <<'E'\n#!/bin/sh\n" + more +
           "\npython3 - \"$@\" <<'P'\nimport json, sys\np = json.load(open(sys.argv[1]))\nwith "
           "open(sys.argv[2], 'w') as f:\n"
           "    print('time_s,' + ','.join(p['tap_names']), file=f)\n"
           "    for n in range(p['rows']): print(*[n / p['tap_rate']] + [0] * p['taps'], sep=',', "
           "file=f)\nP\nE\nchmod +x '" +
           file + "'\n";
}
const std::string run =
    "timeout 20 $J run free_string --duration 0.005 --scheme mine --external 'sh mine' ";
// a sanitizer reserves more memory than any limit
std::string limit_memory(int kilobytes) {
    return sanitized ? "" : "ulimit -v " + std::to_string(kilobytes) + "; ";
}
const std::string suite = "timeout 20 $J suite s.toml --out out --external 'sh mine'\n";

TEST(External, WhatItLeavesBehindIsNotWaitedFor) {
    const Scratch scratch;
    EXPECT_TRUE(
        ends(shell(scratch, silence("mine", "sleep 43.21 &") + run + "&& ! pgrep -f 'sleep 43.21'"),
             0, "rows"));
    EXPECT_TRUE(ends(
        shell(scratch, silence("mine", "setsid sleep 21.43 &") + run + "&& pkill -f 'sleep 21.43'"),
        0, "rows"));
}

TEST(External, OneThatFailsIsNotStartedAgain) {
    const Scratch scratch;
    for (const char* fails : {"exit 1", "echo x >\"$2\"", "kill -9 $$"}) {
        std::ofstream(scratch / "mine") << "[ \"$1\" = represents ] && exit 0\necho x >>calls\n"
                                        << fails << "\n";
        EXPECT_EQ(shell(scratch, "rm -f calls; " + run).code, 4) << fails;
        EXPECT_EQ(content(scratch / "calls"), "x\n") << fails;
    }
}

// However the program dies, and whatever the command has started: also no dead process that waits
// for init to read its exit code.
TEST(External, NothingOfItLivesOnAfterTheProgram) {
    const Scratch scratch;
    std::ofstream(scratch / "mine") << "[ \"$1\" = represents ] && exit 0\nsleep 87.65 & echo $! "
                                       ">>pids; echo $$ >>pids\nsleep 78.56\n";
    const Ended o =
        shell(scratch,
              "$J run free_string --duration 0.005 --scheme mine --external 'cd . && "
              "sh mine' & own=$!\nfor k in $(seq 100); do [ \"$(cat pids 2>/dev/null | "
              "wc -l)\" = 2 ] && break; sleep 0.05; done\nkill -9 $own; wait $own\nfor "
              "k in $(seq 10); do sleep 0.05; live=; for p in $(cat pids); do "
              "[ -e /proc/$p ] && live=\"$live $p\"; done; [ -z "
              "\"$live\" ] && break; done\necho \"$(wc -l <pids) started, live:$live\"");
    EXPECT_EQ(o.out, "2 started, live:\n");
}

TEST(External, OfWhatItSaysTheEndIsKept) {
    const Scratch scratch;
    std::ofstream(scratch / "mine")
        << "head -c 500000000 /dev/zero\necho; echo the last word; exit 7\n";
    EXPECT_TRUE(ends(shell(scratch, limit_memory(400000) + run), 4, "exit code 7: the last word"));
}

TEST(External, ItsTraceIsReadOnlyWhereItCanBeOne) {
    const Scratch scratch;
    std::ofstream(scratch / "mine") << "truncate -s 5G \"$2\"\n";
    EXPECT_TRUE(
        ends(shell(scratch, limit_memory(400000) + run), 4, "has 5369 MB, and 222 rows of 2 taps"));
}

TEST(External, ATimeLimitIsOneOnTheClock) {
    const Scratch scratch;
    std::ofstream(scratch / "mine") << "sleep 30\n";
    std::ofstream(scratch / "s.toml")
        << suite_of("free_string", "mine", "44100",
                    "duration = 0.005\nmodes = 20\nreference_modes = 20\ntime_limit_s = 0.5");
    const Ended o = shell(scratch, suite);
    EXPECT_EQ(o.code, 4);
    EXPECT_TRUE(says(o.out, "past its time limit of 0.5 s"));
}

TEST(External, ItsFilesAreKnownAsTheShellReadsTheCommand) {
    const Scratch scratch;
    shell(scratch, "mkdir 'a b' bin; truncate -s 3G large");
    for (const auto& [command, file, name] :
         {std::array<const char*, 3>{"sh 'a b/mine.sh'", "a b/mine.sh", "mine"},
          {"true large;sh a\\ b/mine.sh", "a b/mine.sh", "mine"},
          {"sh \"$PWD/a b/mine.sh\"", "a b/mine.sh", "mine"},
          {"sh a?b/mine.sh", "a b/mine.sh", "mine"},
          {"mine", "bin/mine", "external"}}) {
        const std::string compare =
            "PATH=$PWD/bin:$PATH $J compare free_string --rates 44100 --modes 20 --reference-modes "
            "20 --duration "
            "0.005 --repeats 1 --resume --out out --schemes ";
        std::ofstream(scratch / "again")
            << compare << name << " --external \"$(cat command)\" 2>&1 | grep read.back\n";
        std::ofstream(scratch / "command") << command;
        const Ended o =
            shell(scratch, limit_memory(2000000) + "rm -rf out\n" + silence(file) +
                               ". ./again; . ./again; echo >>'" + file + "'; . ./again");
        EXPECT_EQ(
            o.out,
            "the errors of 0 of 1 cells were read back\nthe errors of 1 of 1 cells were read back\n"
            "the errors of 0 of 1 cells were read back\n")
            << command;
    }
}

TEST(External, CheckAsksForWhatItSaysThatItRepresents) {
    const Scratch scratch;
    const auto of = [&](const std::string& more, const std::string& says) {
        std::ofstream(scratch / "mine")
            << "if [ \"$1\" = represents ]; then " << says << "; fi\necho only free; exit 3\n";
        return shell(scratch, "timeout 60 $J check mine --external 'sh mine' " + more);
    };
    const std::string named = "--only NameWhatIsMissing,KeepsItsEnergyLedgerInSum";
    const Ended o =
        of(named, "echo represents: damping, initial shape; echo balance: exact; exit 0");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(says(o.out, "NameWhatIsMissing                                 27 scenes"));
    EXPECT_TRUE(
        says(of("--only KeepsItsEnergyLedgerInSum,AllocatesNothingWhileStepping",
                "echo balance: exact; exit 0")
                 .out,
             "\n  2 not asked: refuses it: mine: only free; it runs in a process of its own"));
    EXPECT_TRUE(says(of(named, "exit 1").out, "it promises no balance"));
    EXPECT_TRUE(ends(of(named, "echo represents: thred; exit 0"), 2, "did you mean \"thread\"?"));
    EXPECT_TRUE(ends(of(named, "echo balance: mostly; exit 0"), 2, "there is \"exact\""));
}

TEST(External, ItsCostIsTheOneThatIsReported) {
    const Scratch scratch;
    const std::string compare = silence("mine") +
                                "$J compare free_string --duration 0.005 --external 'sh mine' "
                                "--schemes mine,modal_two_point --modes 20 --reference-modes 20 "
                                "--repeats 1 --out out --rates 44100,88200 --cost mine=";
    const Ended o = shell(scratch, compare + "0.5,1.5");
    EXPECT_EQ(o.code, 0) << o.err;
    const bench::store::Table cost = bench::store::read_csv(content(scratch / "out/cost.csv"));
    std::string found;
    for (const auto& row : cost.rows)
        if (row[cost.column("scheme")] == "mine")
            for (const char* name :
                 {"options", "rate", "cost_s_per_s", "processor_s_per_s", "untimed", "machine"})
                found += row[cost.column(name)].text() + "|";
    EXPECT_EQ(found, "cost=as_reported|44100|0.5|0.5|||cost=as_reported|88200|1.5|1.5|||");
    EXPECT_TRUE(ends(shell(scratch, compare + "0.5"), 2, "found 1 costs for 2 --rates"));
    EXPECT_TRUE(ends(shell(scratch, compare + "1,-1"), 2, "expected a number > 0"));
    EXPECT_TRUE(ends(shell(scratch, compare + "1,1 --cost modal_two_point=1,1"), 2,
                     "this scheme is timed"));
}

TEST(Judge, ATraceThatHoldsNoNumberIsAFailedRowAtItsRateAndNoMore) {
    const Scratch scratch;
    const std::string scene = "free_string --duration 0.01", judge = "$J judge " + scene;
    for (const char* rate : {"44100", "88200", "176400"})
        shell(scratch, "$J run " + scene + " --scheme modal_two_point --energy --quiet --rate " +
                           rate + " --out " + rate + ".csv");
    shell(scratch,
          "awk -F, -v OFS=, 'NR > 300 { $3 = \"NaN\"; $NF = \"inf\" } 1' 88200.csv > nan.csv");
    const std::string why = "88.2 kHz: tap ";
    const Ended o = shell(scratch, judge +
                                       " --trace 44100=44100.csv --trace 88200=nan.csv "
                                       "--trace 176400=176400.csv --out out");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(says(o.out, "at 44.1 kHz: errs by"));
    EXPECT_TRUE(says(o.out, "at 176.4 kHz: errs by"));
    EXPECT_TRUE(says(o.out, why));
    EXPECT_TRUE(says(o.out, "holds no number in row 299, at 0.00678005 s"));
    const bench::store::Table cells = bench::store::read_csv(content(scratch / "out/cells.csv"));
    std::string status;
    for (const auto& row : cells.rows) status += row[cells.column("status")].text() + " ";
    EXPECT_EQ(status, "ok diverged ok ");
    EXPECT_TRUE(ends(shell(scratch, judge + " --trace 88200=nan.csv"), 4, "")) << "nothing is left";
}

TEST(External, WhatTakesLongIsToldOfAtLeastEveryTenSeconds) {
    const Scratch scratch;
    std::ofstream(scratch / "mine") << "[ \"$1\" = represents ] || sleep 60\n";
    const Ended o = shell(scratch,
                          "timeout 14 $J check mine --external 'sh mine' "
                          "--only ItRunsAScene");
    EXPECT_TRUE(says(o.err, "check mine   0 % ItRunsAScene, 10 s"));
}

TEST(External, ThatItFailsIsARowOfAMap) {
    const Scratch scratch;
    std::ofstream(scratch / "mine") << "echo no rows today; exit 1\n";
    for (const char* schemes : {R"("mine", "modal_two_point")", R"("mine")"}) {
        std::ofstream(scratch / "s.toml")
            << "[[cells]]\nname = \"m\"\nscenes = \"free_string\"\nschemes = [" << schemes
            << "]\nduration = 0.005\nmodes = 20\nmeasure = \"outcome\"\n"
               "sweep = { rate = [44100, 88200] }\n";
        EXPECT_TRUE(ends(shell(scratch, "rm -rf out\n" + suite), 0, "error 2"));
        EXPECT_TRUE(
            says(content(scratch / "out/maps.csv"),
                 "m,free_string,mine,rate,44100,,,error,sh mine: exit code 1: no rows today,"));
    }
}

}  // namespace
}  // namespace jvari::test

// Output that cannot be written: a full disk, a reader that goes away, a stream that is closed. The
// exit code says so, files are whole or absent, and what was measured is kept.
#include <nlohmann/json.hpp>

#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

const std::string small_comparison =
    "$J compare free_string --schemes modal_two_point --rates 44100 --duration 0.01 --repeats 1";

TEST(Unwritable, ATraceThatTheDiskDoesNotHoldIsAnErrorAndLeavesNothing) {
    for (const char* file : {"x.csv", "x.wav"}) {
        const Scratch scratch;
        // 16 KiB
        const Ended o = shell(scratch, "ulimit -f 16\n" + run_for + "0.4 --out " + file);
        EXPECT_TRUE(ends(o, 4, "cannot write " + std::string(file) + ": File too large")) << file;
        EXPECT_EQ(scratch.files(), 0) << file;
        EXPECT_EQ(o.out, "");
    }
}

TEST(Unwritable, ATraceStaysAsItWasWhereItsSuccessorDoesNotFit) {
    for (const char* file : {"x.csv", "x.wav"}) {
        const Scratch scratch;
        ASSERT_EQ(shell(scratch, small_run + " --out " + file).code, 0);
        const std::string before = content(scratch / file);
        EXPECT_EQ(shell(scratch, "ulimit -f 16\n" + run_for + "0.4 --out " + file).code, 4);
        EXPECT_EQ(content(scratch / file), before);
    }
}

TEST(Unwritable, AComparisonIsKeptWhereNobodyReadsItsTable) {
    const Scratch scratch;
    const Ended o = shell(scratch, small_comparison + " --out kept | true\nexit ${PIPESTATUS[0]}");
    EXPECT_TRUE(ends(o, 4, "cannot write to standard output: Broken pipe"));
    for (const char* name :
         {"cells.csv", "errors.csv", "cost.csv", "manifest.json", "results.json", "report.html"})
        EXPECT_TRUE(fs::exists(scratch.path / "kept" / name)) << name;
}

TEST(Unwritable, AResultThatDoesNotGetOutIsNoSuccess) {
    const Scratch scratch;
    for (const char* stream : {"> /dev/full", ">&-"})
        for (const std::string& command :
             {small_run, small_run + " --json", std::string("$J list"), std::string("$J --help")}) {
            const Ended o = shell(scratch, command + " " + stream);
            EXPECT_TRUE(ends(o, 4, "cannot write to standard output")) << command << stream;
        }
}

TEST(Unwritable, AMessageThatDoesNotGetOutChangesNothing) {
    const Scratch scratch;
    for (const char* stream : {"2> /dev/full", "2>&-"}) {
        EXPECT_EQ(shell(scratch, std::string("$J run free_string --scheme nope ") + stream).code,
                  2);
        EXPECT_EQ(shell(scratch, small_comparison + " " + stream).code, 0);  // with a note
        const Ended o = shell(
            scratch, std::string("$J run sitar_parabola --scheme exact_linear --json ") + stream);
        EXPECT_EQ(o.code, 3);
        EXPECT_EQ(nlohmann::json::parse(o.out).at("exit_code"), 3);
    }
}

// its number is free for the next that is opened
TEST(Unwritable, AClosedStreamDoesNotBecomeAFile) {
    const Scratch scratch;
    ASSERT_EQ(shell(scratch, small_run + " --out x.csv").code, 0);
    const std::string whole = content(scratch / "x.csv");
    shell(scratch, small_run + " --out x.csv <&- >&- 2>&-");
    EXPECT_EQ(content(scratch / "x.csv"), whole);
}

TEST(Unwritable, WithoutAFolderForScratchTheReportHasNoPicturesAndSaysSo) {
    const Scratch scratch;
    for (const char* library : {"vega", "vega-lite", "vega-embed"}) {
        fs::create_directories(scratch.path / library / "build");
        std::ofstream(scratch.path / library / "build" / (library + std::string(".min.js")))
            << "//";
    }
    const Ended o = shell(scratch, "export JVARI_NODE_MODULES=. TMPDIR=/nonexistent\n" +
                                       small_comparison + " --out kept");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(says(o.err, "no picture: cannot write to /nonexistent"));
    EXPECT_TRUE(fs::exists(scratch / "kept/report.html"));
}

TEST(Unwritable, AFileNameThatIsNoTextIsWrittenAndReported) {
    const Scratch scratch;
    const Ended o = shell(scratch, small_run + " --json --out $'x\\xff.csv'");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(nlohmann::json::parse(o.out).at("out"), "x\ufffd.csv");
    const Ended c = shell(scratch, small_comparison + " --json --out $'d\\xff'");
    EXPECT_EQ(c.code, 0) << c.err;
    EXPECT_EQ(shell(scratch, "$J report --json $'d\\xff'").code, 0);
    EXPECT_EQ(shell(scratch, "$J run --json $'no\\xff.toml' --scheme modal_two_point").code, 2);
}

}  // namespace
}  // namespace jvari::test

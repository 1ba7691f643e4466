// What a trace is written to; what a format does not hold is said before the run.
#include <nlohmann/json.hpp>

#include "bench/store/fresh_file.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

TEST(TraceFile, ALinkStaysOneAndItsTargetIsWritten) {
    const Scratch scratch;
    fs::create_directory(scratch / "elsewhere");
    // to a file that is not there yet
    fs::create_symlink("elsewhere/real.csv", scratch / "link.csv");
    fs::create_symlink("link.csv", scratch / "second.csv");
    for (int n = 0; n < 2; ++n) {
        ASSERT_EQ(shell(scratch, small_run + " --out second.csv").code, 0);
        EXPECT_TRUE(fs::is_symlink(scratch / "second.csv"));
        EXPECT_TRUE(fs::is_symlink(scratch / "link.csv"));
        EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(scratch / "elsewhere/real.csv")));
    }
    fs::create_symlink("circle.csv", scratch / "circle.csv");
    EXPECT_EQ(shell(scratch, small_run + " --out circle.csv").code, 2);
    EXPECT_TRUE(fs::is_symlink(scratch / "circle.csv"));
}

TEST(TraceFile, HasAnyNameThatTheFileSystemTakes) {
    const Scratch scratch;
    const std::string run = "$J run free_string --scheme modal_two_point --duration 0.002 --out ",
                      longest(255, 'a');
    for (const char* extension : {".csv", ".wav"}) {
        const std::string name = longest.substr(0, 255 - std::string(extension).size()) + extension;
        EXPECT_EQ(shell(scratch, run + name).code, 0) << name;
        EXPECT_TRUE(std::filesystem::exists(scratch / name));
        EXPECT_TRUE(ends(shell(scratch, run + "a" + name), 2, "too long"));
    }
}

TEST(TraceFile, IsWrittenBesideItsPlaceUnderANameThatNobodyCanForetell) {
    const Scratch scratch;
    std::ofstream(scratch / "outside") << "mine";
    // what a program of this process would have been foretold to write through
    ASSERT_EQ(shell(scratch,
                    "ln -s $PWD/outside .t.csv.$(hostname).$$.part\n"
                    "exec $J run free_string --scheme modal_two_point --duration 0.002 --out t.csv")
                  .code,
              0);
    EXPECT_EQ(content(scratch / "outside"), "mine");
    EXPECT_FALSE(std::filesystem::is_symlink(scratch / "t.csv"));
    const bench::store::FreshFile one(scratch / "x"), two(scratch / "x");
    EXPECT_NE(one.path(), two.path());
    // there before anything is written: nobody else can make it
    EXPECT_TRUE(std::filesystem::is_regular_file(one.path()));
}

TEST(TraceFile, WhatOneDoesNotHoldIsSaidBeforeTheRun) {
    const Scratch scratch;
    for (const std::string rate : {"44100.5", "500000"}) {
        const Ended o = shell(scratch,
                              "$J run free_string --scheme modal_two_point --energy --modes 20 "
                              "--duration 1e4 --rate " +
                                  rate + " --tap-rate " + rate + " --out x.wav");  // never run
        EXPECT_TRUE(ends(o, 2, "--out x.wav")) << rate;
        EXPECT_TRUE(says(o.err, "a whole number of rows per second from 3000 to 384000"));
        EXPECT_EQ(scratch.files(), 0);
    }
    const Ended o =
        shell(scratch, "$J run free_string --scheme modal_two_point --duration 40000 --out x.wav");
    EXPECT_TRUE(ends(o, 2, "at most 4e+09 bytes"));
}

TEST(TraceFile, NeedsNoTapAndASoundSaysHowLoudItIs) {
    const Scratch scratch;
    std::ofstream(scratch / "none.toml")
        << "name = \"s\"\nduration = 0.1\n[[string]]\nlength = 1.0\nlinear_density = 1e-3\ntension "
           "= 50.0\n"
           "[string.start]\nshape = \"triangle\"\nposition = 0.3\namplitude = 1e-3\n";
    EXPECT_EQ(shell(scratch, "$J run none.toml --scheme modal_two_point --out x.csv").code, 0);
    const Ended o = shell(scratch, "$J run none.toml --scheme modal_two_point --json --out x.wav");
    ASSERT_EQ(o.code, 0) << o.err;
    const std::string level = nlohmann::json::parse(o.out).at("level");
    EXPECT_TRUE(says(level, "peak -1.0 dB"));
    EXPECT_TRUE(says(level, "0 samples clipped"));
    EXPECT_EQ(content(scratch / "x.wav").substr(0, 4), "RIFF");
    EXPECT_EQ(fs::file_size(scratch / "x.wav") - 4411 * 3, 45u);  // one channel, padded
}

}  // namespace
}  // namespace jvari::test

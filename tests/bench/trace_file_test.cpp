// What a trace is written to: what each format does not hold is said before the run, and the same trace is the same bytes.
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/store/fresh_file.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

const std::string small_run = "$J run free_string --scheme modal_two_point --duration 0.05";

TEST(TraceFile, ALinkStaysOneAndItsTargetIsWritten) {
    const Scratch scratch;
    fs::create_directory(scratch / "elsewhere");
    fs::create_symlink("elsewhere/real.csv", scratch / "link.csv");  // to a file that is not there yet
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

std::string scene_with(const std::string& taps) {
    return "name = \"s\"\nsource = \"none\"\nduration = 0.01\n[[string]]\nlength = 1.0\nlinear_density = 1e-3\ntension = 50.0\n"
           "[string.damping]\nlaw = \"none\"\n[string.initial]\nshape = \"triangle\"\nposition = 0.3\namplitude = 1e-3\n" +
           taps;
}
std::string tap(const std::string& name) {
    return "[[tap]]\nname = \"" + name + "\"\nquantity = \"nut_force\"\nstring = 0\n";
}

TEST(TraceFile, HasAnyNameThatTheFileSystemTakes) {
    const Scratch scratch;
    const std::string run = "$J run free_string --scheme modal_two_point --duration 0.002 --out ", longest(255, 'a');
    for (const char* extension : {".csv", ".wav", ".h5"}) {
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
    EXPECT_TRUE(std::filesystem::is_regular_file(one.path()));  // there before anything is written: nobody else can make it
}

TEST(TraceFile, WhatOneDoesNotHoldIsSaidBeforeTheRun) {
    const struct {
        std::string taps, file, rate, expected;
    } cases[] = {{tap("."), "x.h5", "44100", "none can be named"},
                 {"", "x.wav", "44100.5", "a whole number of rows per second from 3000 to 384000"},
                 {"", "x.flac", "500000", "a whole number of rows per second from 3000 to 384000"}};
    for (const auto& c : cases) {
        const Scratch scratch;
        std::ofstream(scratch / "s.toml") << scene_with(c.taps);
        const Outcome o = shell(scratch, "$J run s.toml --scheme modal_two_point --energy --modes 20 --duration 1e4 --rate " + c.rate +
                                             " --tap-rate " + c.rate + " --out " + c.file);  // never run
        EXPECT_TRUE(ends(o, 2, "--out " + c.file)) << c.expected;
        EXPECT_TRUE(says(o.err, c.expected));
        EXPECT_EQ(scratch.files(), 1);
    }
    const Scratch scratch;
    const Outcome o = shell(scratch, "$J run free_string --scheme modal_two_point --duration 40000 --out x.wav");
    EXPECT_TRUE(ends(o, 2, "at most 4e+09 bytes"));
}

TEST(TraceFile, EachHoldsWhatTheOthersDoNot) {
    const Scratch scratch;
    std::string many;
    for (int k = 0; k < 1025; ++k) many += tap("t" + std::to_string(k));
    std::ofstream(scratch / "many.toml") << scene_with(many);
    std::ofstream(scratch / "none.toml") << scene_with("");
    const std::string run = " --scheme modal_two_point --duration 0.001 --out ";
    EXPECT_EQ(shell(scratch, "$J run many.toml" + run + "x.h5").code, 0);
    EXPECT_EQ(shell(scratch, "$J run none.toml" + run + "x.h5").code, 0);
    EXPECT_EQ(shell(scratch, "$J run none.toml" + run + "x.csv").code, 0);
}

TEST(TraceFile, WhatIsPlayedNeedsNoTapAndSaysHowLoudItIs) {
    const Scratch scratch;
    std::ofstream(scratch / "none.toml") << scene_with("");
    for (const std::string file : {"x.wav", "x.flac"})
        for (const std::string format : {"", " --wav-format pcm16"}) {
            const Outcome o = shell(scratch, "$J run none.toml --scheme modal_two_point --duration 0.1 --json --out " + file + format);
            ASSERT_EQ(o.code, 0) << o.err;
            const std::string level = nlohmann::json::parse(o.out).at("level");
            EXPECT_TRUE(says(level, "peak -1.0 dB"));
            EXPECT_TRUE(says(level, "0 samples clipped"));
            EXPECT_EQ(content(scratch / file).substr(0, 4), file == "x.wav" ? "RIFF" : "fLaC");
            if (file == "x.wav") {
                EXPECT_EQ(fs::file_size(scratch / file) - 4411 * (format.empty() ? 3 : 2),
                          format.empty() ? 45u : 44u);  // one channel, padded
            }
        }
}

TEST(TraceFile, Hdf5SaysEverySettingOfTheRun) {
    const Scratch scratch;
    if (shell(scratch, "command -v h5dump").code != 0) GTEST_SKIP() << "h5dump (Debian: hdf5-tools) is missing";
    ASSERT_EQ(shell(scratch,
                    "$J run tanpura_c3 --scheme modal_two_point --duration 0.01 --modes 40 --rate 88200 --option compliance=matched "
                    "--set string.0.tension=33 --out x.h5")
                  .code,
              0);
    const Outcome o = shell(scratch, "h5dump -A x.h5");
    ASSERT_EQ(o.code, 0) << o.err;
    for (const char* name : {"duration", "modes", "sample_rate", "tap_rate", "option.compliance", "set.string.0.tension", "status",
                             "fact.series_compliance", "fact.smallest_contact_force"})
        EXPECT_TRUE(says(o.out, "ATTRIBUTE \"" + std::string(name) + "\"")) << name;
}

TEST(TraceFile, Hdf5HasNoTimeStamps) {
    const Scratch scratch;
    std::ofstream(scratch / "s.toml") << scene_with(tap("nut") + tap(".."));
    const std::string run = "$J run s.toml --scheme modal_two_point --out ";
    ASSERT_EQ(shell(scratch, run + "x.h5").code, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // stamps are whole seconds
    ASSERT_EQ(shell(scratch, run + "y.h5").code, 0);
    EXPECT_EQ(content(scratch / "x.h5"), content(scratch / "y.h5"));
}

}  // namespace
}  // namespace jvari::test

// What `judge` says is behind an error: traces that are wrong in one known way.
#include <cmath>
#include <functional>

#include "bench/store/records.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

// a period of 288 rows
constexpr const char* one_string =
    "name = \"loop\"\nduration = 0.12\n[[string]]\nlength = 1.0\nlinear_density = 1e-3\n"
    "frequency = 153.125\n[string.start]\nshape = \"triangle\"\nposition = 0.3\n"
    "amplitude = 1e-3\nsmoothing = 0.2\n[[tap]]\nname = \"y\"\nquantity = \"displacement\"\n"
    "string = 0\nposition = 0.2\n";

using Change = std::function<void(std::vector<double>&)>;
// What is said of the exact trace where it is changed.
std::string said_of(const Change& change, const std::string& run = "",
                    const char* scene = one_string, const char* scheme = "exact_linear") {
    const Scratch scratch;
    std::ofstream(scratch / "loop.toml") << scene;
    EXPECT_EQ(jvari(scratch, "run " + (scratch / "loop.toml") + " --scheme " + scheme + " --out " +
                                 (scratch / "t.csv") + run)
                  .code,
              0);
    bench::store::Table t = bench::store::read_csv(content(scratch / "t.csv"));
    std::vector<double> y;
    for (std::size_t n = 0; n < t.rows.size(); ++n) y.push_back(t.number(n, "y"));
    change(y);
    t.rows.resize(y.size());
    for (std::size_t n = 0; n < y.size(); ++n)
        t.rows[n][static_cast<std::size_t>(t.column("y"))] = y[n],
        t.rows[n][0] = static_cast<double>(n) / 44100;
    std::ofstream(scratch / "t.csv") << bench::store::csv(t);
    const Ended o = jvari(
        scratch, "judge " + (scratch / "loop.toml") + " --trace 44100=" + (scratch / "t.csv"));
    return o.out;
}

TEST(Cause, OfALoopWhoseFilterDelayWasForgottenIsItsTuning) {
    const std::string cause = said_of([](std::vector<double>& y) {
        for (std::size_t n = 289; n < y.size(); ++n) y[n] = 0.5 * (y[n - 288] + y[n - 289]);
    });
    // 1200 log2(288/288.5)
    EXPECT_TRUE(
        says(cause,
             "it is out of tune, 3.0 cents flat: its partials 1, 2, 3, 4, 6, 7, 8, 9, 11, 12 are "
             "off by "
             "-3.0 -3.0 "))
        << cause;
}

TEST(Cause, OfADelayIsTheDelayAndOfAGainTheGain) {
    const auto late = [](std::vector<double>& y) {
        const std::vector<double> was = y;
        for (std::size_t n = 0; n < y.size(); ++n) y[n] = was[n < 3 ? 0 : n - 3];
    };
    EXPECT_TRUE(says(said_of(late), "it comes 3.00 rows late, 68 us"));
    EXPECT_TRUE(says(said_of([](std::vector<double>& y) {
                         for (std::size_t n = 0; n + 1 < y.size(); ++n)
                             y[n] = 0.5 * (y[n] + y[n + 1]);
                     }),
                     "it comes 0.50 rows early"));
    EXPECT_TRUE(says(said_of([](std::vector<double>& y) {
                         for (double& v : y) v *= 1.1;
                     }),
                     "it is 1.1 times too large"));
    EXPECT_TRUE(says(said_of([](std::vector<double>& y) {
                         for (double& v : y) v *= -1;
                     }),
                     "it has the wrong sign"));
    EXPECT_TRUE(says(said_of([](std::vector<double>& y) {
                         for (double& v : y) v *= -0.5;
                     }),
                     "it has the wrong sign and is 2 times too small"));
    EXPECT_TRUE(says(said_of([](std::vector<double>& y) {
                         for (double& v : y) v = 0;
                     }),
                     "it is 0 throughout"));
    const std::string of_noise = said_of([](std::vector<double>& y) {
        for (std::size_t n = 0; n < y.size(); ++n) y[n] += n % 7 == 3 ? 2e-4 : 0;
    });
    for (const char* cause : {"out of tune", "rows", "times too"})
        EXPECT_FALSE(says(of_noise, cause)) << cause;
}

TEST(Cause, OfAStringThatGrowsIsItsGrowthAndFarBeyondItHasDiverged) {
    const auto growing = [](double by) {
        return said_of([by](std::vector<double>& y) {
            for (std::size_t n = 0; n < y.size(); ++n)
                y[n] *= std::exp(by * static_cast<double>(n) / 44100);
        });
    };
    EXPECT_TRUE(says(growing(30), "it grows: diverged at step "));
    EXPECT_TRUE(says(growing(5), "\n  it grows: a tap reaches "));
    EXPECT_TRUE(says(growing(0.3), "it decays too slowly by 0.3 1/s"));
}

TEST(Cause, OfALossThatIsWrongIsTheDecay) {
    EXPECT_TRUE(says(said_of([](std::vector<double>& y) {
                         for (std::size_t n = 0; n < y.size(); ++n)
                             y[n] *= std::exp(-2.0 * static_cast<double>(n) / 44100);
                     }),
                     "it decays too fast by 2 1/s: its partials 1, 2, 3, 4, 6, "));
}

const auto same = [](std::vector<double>&) {};
const auto moved_by = [](std::size_t rows) {
    return [rows](std::vector<double>& y) {
        const std::vector<double> was = y;
        for (std::size_t n = 0; n < y.size(); ++n) y[n] = was[n < rows ? 0 : n - rows];
    };
};
// Each sixteenth row of a trace with as many more, `late` of them late.
const auto every_sixteenth = [](std::size_t late) {
    return [late](std::vector<double>& y) {
        const std::vector<double> was = y;
        y.resize(5293);
        for (std::size_t n = 0; n < y.size(); ++n) y[n] = was[16 * n < late ? 0 : 16 * n - late];
    };
};
std::string bright_string() {  // the same, with a corner, at its nut
    std::string text = one_string;
    text.replace(text.find("smoothing = 0.2"), 15, "smoothing = 0.02");
    text.replace(text.find("\"displacement\""), 14, "\"nut_force\"");
    return text.erase(text.find("position = 0.2\n"));
}

TEST(Cause, OfATraceThatIsManyTimesTooLargeIsTheFactorWhateverTheStringsEnergyAllows) {
    const auto times = [](double by) {
        return said_of([by](std::vector<double>& y) {
            for (double& v : y) v *= by;
        });
    };
    for (const auto& [by, text] : {std::pair{2, "it is 2 times too large"},
                                   {1000, ": it is 1000 times too large, as mm in place of m are"}})
        EXPECT_TRUE(says(times(by), text) && !says(times(by), "grows")) << times(by);
}

TEST(Cause, OfAnOffsetIsTheOffset) {
    const std::string cause = said_of([](std::vector<double>& y) {
        for (double& v : y) v += 6e-4;
    });
    EXPECT_TRUE(says(cause, "it is off by +0.0006 m throughout, an offset")) << cause;
    EXPECT_FALSE(says(cause, "grows")) << cause;
}

TEST(Cause, OfATraceThatStopsMovingIsTheRowWhereItStops) {
    const std::string cause =
        said_of([](std::vector<double>& y) { std::fill(y.begin() + 2646, y.end(), y[2646]); });
    EXPECT_TRUE(says(cause, "it stands still from row 2646 on, 0.06 s")) << cause;
}

TEST(Cause, OfAHalfRowAQuarterAndAHundredRowsIsTheDelayAlsoOfABrightTone) {
    EXPECT_TRUE(says(said_of(moved_by(100)), "it comes 100.00 rows late"));
    const std::string scene = bright_string();
    for (const auto& [late, text] :
         {std::pair{8, "it comes 0.50 rows late"}, {4, "it comes 0.25 rows late"}}) {
        const std::string cause =
            said_of(every_sixteenth(late), " --tap-rate 705600", scene.c_str());
        EXPECT_TRUE(says(cause, text)) << cause;
    }
}

TEST(Cause, OfAStringOfAnotherLengthOrWithAFreeEndIsTheOctave) {
    EXPECT_TRUE(says(said_of(same, " --set string.0.length=2 --set string.0.frequency=76.5625"),
                     "it sounds an octave low: "));
    const std::string cause = said_of([](std::vector<double>& y) {
        for (std::size_t n = 0; n < y.size(); ++n)
            y[n] =
                5e-4 * std::cos(2 * 3.141592653589793 * 76.5625 * static_cast<double>(n) / 44100);
    });
    EXPECT_TRUE(says(cause, "it sounds an octave low: ") &&
                says(cause, "of a string with a free end"))
        << cause;
    EXPECT_TRUE(says(said_of(same, " --set string.0.frequency=306.25"), "sounds an octave high"));
}

TEST(Cause, OfARateThatWasMistakenIsTheIntervalAlsoBeyondHalfASemitone) {
    const std::string cause = said_of([](std::vector<double>& y) { y.resize(5293); },
                                      " --tap-rate 48000 --duration 0.121");
    EXPECT_TRUE(says(cause, "it is out of tune, 146.7 cents flat: ")) << cause;
}

TEST(Cause, OfPartialsThatAreOffByDifferentIntervalsIsNoMedian) {
    const std::string cause = said_of(same, " --set string.0.bending_stiffness=0.2");
    EXPECT_TRUE(says(cause, "it is out of tune, each partial by another interval: ")) << cause;
}

TEST(Cause, OfFewModesIsTheirNumber) {
    const std::string scene = bright_string(), cause = said_of(same, " --modes 20", scene.c_str());
    EXPECT_TRUE(says(cause, "it has 20 partials: it lacks those above 3.14 kHz")) << cause;
}

TEST(Cause, OfAStringThatTouchesABridgeIsItsTuningAndItsDecayToo) {
    const std::string bridge =
        std::string(one_string)
            .insert(std::string(one_string).find("[string.start]"),
                    "[[string.barrier]]\nshape = \"lumped\"\nposition = 0.1\nheight = "
                    "-1e-4\nstiffness = 2e3\n");
    const auto of = [&](const std::string& run) {
        return said_of(same, run, bridge.c_str(), "exact_contact");
    };
    const std::string flat = of(" --set string.0.frequency=152.86"),
                      lossy = of(
                          " --set string.0.damping.law=polynomial --set string.0.damping.sigma0=6");
    EXPECT_TRUE(says(flat, "it is out of tune, 2.9 cents flat over its first 50 ms")) << flat;
    EXPECT_TRUE(says(lossy, "it decays too fast by ")) << lossy;
}

TEST(Cause, OfAWaveformThatComesNearerWhileItsSpectrumDoesNotIsSaid) {
    const Scratch scratch;
    std::ofstream(scratch / "loop.toml") << one_string;
    std::string traces;
    for (const int times : {1, 2}) {
        const std::string file = scratch / (std::to_string(times) + ".csv");
        ASSERT_EQ(jvari(scratch,
                        "run " + (scratch / "loop.toml") + " --scheme exact_linear --out " + file)
                      .code,
                  0);
        bench::store::Table t = bench::store::read_csv(content(file));
        for (std::size_t n = 0; n < t.rows.size(); ++n)
            t.rows[n][static_cast<std::size_t>(t.column("y"))] =
                times == 1 ? 1.05 * t.number(n, "y") : t.number(n, "y") + (n % 9 == 4 ? 1e-5 : 0);
        std::ofstream(file) << bench::store::csv(t);
        traces += " --trace " + std::to_string(44100 * times) + "=" + file;
    }
    const Ended o = jvari(scratch, "judge " + (scratch / "loop.toml") + traces);
    EXPECT_TRUE(
        ends(o, 0, "\nits third octaves move away from the reference's with the rate, from "))
        << o.out;
}

TEST(Cause, OfAContactThatScalesWithTheStepIsThatItsErrorRises) {
    const Scratch scratch;
    std::ofstream(scratch / "loop.toml")
        << std::string(one_string)
               .insert(std::string(one_string).find("[string.start]"),
                       "[[string.barrier]]\nshape = \"lumped\"\nposition = "
                       "0.1\nheight = -1e-4\nstiffness = 2e3\n");
    std::string traces;
    for (const int times : {1, 2, 4}) {
        const std::string rate = std::to_string(44100 * times), file = scratch / (rate + ".csv");
        ASSERT_EQ(jvari(scratch, "run " + (scratch / "loop.toml") +
                                     " --duration 0.03 --scheme modal_two_point --tap-rate 44100 "
                                     "--rate " +
                                     rate + " --set string.0.barrier.0.stiffness=" +
                                     std::to_string(2e3 / (times * times)) + " --out " + file)
                      .code,
                  0);
        traces += " --trace " + rate + "=" + file;
    }
    const Ended o =
        jvari(scratch, "judge " + (scratch / "loop.toml") + " --duration 0.03" + traces);
    EXPECT_TRUE(ends(o, 0, "\nits error rises with the rate, from ")) << o.out;
}

}  // namespace
}  // namespace jvari::test

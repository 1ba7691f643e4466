// What `judge` says is behind an error: traces that are wrong in one known way.
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
std::string said_of(const Change& change) {
    const Scratch scratch;
    std::ofstream(scratch / "loop.toml") << one_string;
    EXPECT_EQ(jvari(scratch, "run " + (scratch / "loop.toml") + " --scheme exact_linear --out " +
                                 (scratch / "t.csv"))
                  .code,
              0);
    bench::store::Table t = bench::store::read_csv(content(scratch / "t.csv"));
    std::vector<double> y;
    for (std::size_t n = 0; n < t.rows.size(); ++n) y.push_back(t.number(n, "y"));
    change(y);
    for (std::size_t n = 0; n < y.size(); ++n)
        t.rows[n][static_cast<std::size_t>(t.column("y"))] = bench::store::text_of(y[n]);
    std::ofstream(scratch / "t.csv") << bench::store::csv(t);
    const Ended o = jvari(
        scratch, "judge " + (scratch / "loop.toml") + " --trace 44100=" + (scratch / "t.csv"));
    return o.out;
}

TEST(Cause, OfALoopWhoseFilterDelayWasForgottenIsItsTuning) {
    const std::string said = said_of([](std::vector<double>& y) {
        for (std::size_t n = 289; n < y.size(); ++n) y[n] = 0.5 * (y[n - 288] + y[n - 289]);
    });
    // 1200 log2(288/288.5)
    EXPECT_TRUE(says(
        said, "it is out of tune, 3.0 cents flat: its first 10 partials are off by -3.0 -3.0 "))
        << said;
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
                     "it decays too fast by 2 1/s: its first 10 partials are off by "));
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

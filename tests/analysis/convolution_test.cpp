// A response by convolution in blocks and by second-order sections, against the sum that defines it and against closed forms.
#include "analysis/convolution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "analysis/resonators.hpp"

namespace jvari {
namespace {

std::vector<double> noise(int rows, unsigned seed) {
    std::mt19937_64 draw(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<double> x(rows);
    for (double& v : x) v = any(draw);
    return x;
}

double direct(const std::vector<double>& x, const std::vector<double>& h, int n) {
    long double sum = 0;
    for (int m = 0; m < static_cast<int>(h.size()) && m <= n; ++m) sum += static_cast<long double>(h[m]) * x[n - m];
    return static_cast<double>(sum);
}

TEST(Convolution, IsTheSumThatDefinesItWhateverTheBlock) {
    const auto x = noise(1000, 1);
    for (const int length : {1, 7, 64, 65, 300})
        for (const int block : {1, 8, 50, 64}) {
            const auto h = noise(length, 2);
            Convolution convolution(h, block);
            EXPECT_EQ(convolution.block(), block);
            std::vector<double> out(block);
            for (int n = 0; n + block <= 1000; n += block) {
                convolution.advance(std::span(x).subspan(n, block), out);
                for (int k = 0; k < block; ++k)
                    ASSERT_NEAR(out[k], direct(x, h, n + k), 1e-13 * length) << length << " " << block << " " << n + k;
            }
        }
    const auto h = noise(2048, 3);
    const auto whole = convolved(x, h);
    ASSERT_EQ(whole.size(), x.size());
    for (int n = 0; n < 1000; ++n) ASSERT_NEAR(whole[n], direct(x, h, n), 1e-12);
}

TEST(Convolution, BeginsInSilenceAgainOnceItIsReset) {
    const auto x = noise(64, 1), h = noise(40, 2);
    Convolution convolution(h, 16);
    std::vector<double> once(16), again(16);
    convolution.advance(std::span(x).first(16), once);
    convolution.advance(std::span(x).subspan(16, 16), again);
    convolution.reset();
    convolution.advance(std::span(x).first(16), again);
    EXPECT_EQ(once, again);
    EXPECT_THROW(Convolution({}, 16), std::invalid_argument);
    EXPECT_THROW(Convolution(h, 0), std::invalid_argument);
}

// Damped oscillations at frequencies between the poles.
std::vector<double> bells(int rows, double rate) {
    std::vector<double> h(rows, 0.0);
    for (const double f : {220.0, 500.0, 1300.0, 4100.0})
        for (int n = 0; n < rows; ++n) h[n] += std::exp(-200.0 * n / rate) * std::sin(2 * M_PI * f * n / rate);
    return h;
}

TEST(Resonators, MoreSectionsAreNearerAndTheirFilterIsTheirResponse) {
    const double rate = 44100;
    const auto h = bells(2048, rate);
    double last = HUGE_VAL;
    for (const int count : {10, 40, 160}) {
        const Resonators r = resonators_for(h, rate, count);
        ASSERT_EQ(r.sections.size(), static_cast<std::size_t>(count));
        for (const Section& s : r.sections) EXPECT_LT(s.a2, 1);  // stable: the poles lie within the circle
        const double misfit = misfit_db(r, h);
        EXPECT_LT(misfit, last);
        last = misfit;
    }
    EXPECT_LT(last, -15);                        // poles at 4 kHz are 150 Hz apart, the bell's band is 64 Hz wide
    std::vector<double> steady(3 * 44100, 0.0);  // and no gains that cancel only as long as the response was
    steady[0] = 1;
    const auto on = filtered(resonators_for(h, rate, 160), steady);
    for (std::size_t n = 2048; n < on.size(); ++n) ASSERT_LT(std::abs(on[n]), 1e-2) << n;
    const Resonators r = resonators_for(h, rate, 20);
    std::vector<double> impulse(300, 0.0);
    impulse[0] = 1;
    const auto response = filtered(r, impulse);
    const auto x = noise(300, 4), y = filtered(r, x);
    for (int n = 0; n < 300; ++n) ASSERT_NEAR(y[n], direct(x, response, n), 1e-11);
}

TEST(Resonators, AResponseOfTheirOwnPolesIsFoundAgain) {
    const double rate = 44100;
    const Resonators grid = resonators_for(bells(2048, rate), rate, 5);
    Resonators one = grid;
    for (Section& s : one.sections) s.b0 = s.b1 = 0;
    one.sections[2].b0 = 0.3, one.sections[2].b1 = -0.7, one.direct = 0.1;
    std::vector<double> impulse(2048, 0.0);
    impulse[0] = 1;
    EXPECT_LT(misfit_db(resonators_for(filtered(one, impulse), rate, 5), filtered(one, impulse)), -60);
    EXPECT_THROW(resonators_for(impulse, rate, 0), std::invalid_argument);
    EXPECT_THROW(resonators_for(impulse, 100, 4), std::invalid_argument);
    EXPECT_THROW(resonators_for(std::span(impulse).first(8), rate, 4), std::invalid_argument);
}

}  // namespace
}  // namespace jvari

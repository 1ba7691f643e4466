// A response by convolution in blocks, against the sum that defines it.
#include "analysis/convolution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

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
    for (int m = 0; m < static_cast<int>(h.size()) && m <= n; ++m)
        sum += static_cast<long double>(h[m]) * x[n - m];
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
                    ASSERT_NEAR(out[k], direct(x, h, n + k), 1e-13 * length)
                        << length << " " << block << " " << n + k;
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

}  // namespace
}  // namespace jvari

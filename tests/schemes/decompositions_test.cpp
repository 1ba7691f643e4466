#include "schemes/decompositions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <vector>

namespace {
std::vector<long double> random_matrix(int n) {
    std::mt19937 random(n);
    std::uniform_real_distribution<double> between(-1, 1);
    std::vector<long double> m(n * n);
    for (long double& x : m) x = between(random);
    return m;
}
}  // namespace

TEST(Decompositions, UndoWhatTheyDecompose) {
    for (const int n : {1, 2, 5, 24}) {
        const std::vector<long double> m = random_matrix(n);
        const std::vector<double> rows(m.begin(), m.end());
        const auto identity = jvari::product_of(rows, jvari::inverse_of(rows, n), n);
        const auto inverse = jvari::inverse_of(m, n);
        const jvari::Eigenpairs pairs = jvari::eigenpairs_of(m, n);
        std::vector<double> even(rows);
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b) even[a * n + b] = rows[a * n + b] + rows[b * n + a];
        const jvari::SymmetricParts parts = jvari::symmetric_parts(even, n);
        EXPECT_TRUE(std::is_sorted(parts.value.begin(), parts.value.end()));
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b) {
                long double product = 0;
                double rebuilt = 0;
                std::complex<long double> turned = 0;  // by columns: of the b-th pair
                for (int k = 0; k < n; ++k) {
                    product += m[a * n + k] * inverse[k * n + b];
                    rebuilt += parts.value[k] * parts.vector[k * n + a] * parts.vector[k * n + b];
                    turned += m[k * n + a] * pairs.vector[b * n + k];
                }
                EXPECT_NEAR(identity[a * n + b], a == b, 1e-12);
                EXPECT_NEAR(static_cast<double>(product), a == b, 1e-15);
                EXPECT_NEAR(rebuilt, even[a * n + b], 1e-13);
                EXPECT_LT(std::abs(turned - pairs.value[b] * pairs.vector[b * n + a]), 1e-16L);
            }
    }
}

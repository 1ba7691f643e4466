// Newton's iteration on the Legendre polynomial P_n, from the asymptotic guess of its roots
// (Abramowitz & Stegun 22.16.6, 25.4.29).
#include "reference/gauss_legendre.hpp"

#include <cmath>
#include <numbers>

namespace jvari {

void gauss_legendre(std::span<double> node, std::span<double> weight) {
    using Real = long double;
    const int n = static_cast<int>(node.size());
    for (int q = 0; q < (n + 1) / 2; ++q) {
        // a root from above, P_n' there
        Real x = std::cos(std::numbers::pi_v<Real> * (q + 0.75L) / (n + 0.5L)), slope = 0;
        // each doubles the digits: five are enough
        for (int iteration = 0; iteration < 6; ++iteration) {
            Real p = 1, before = 0;
            for (int k = 1; k <= n; ++k) {
                const Real next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                before = p;
                p = next;
            }
            slope = n * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        node[q] = static_cast<double>((1 - x) / 2);
        node[n - 1 - q] = static_cast<double>((1 + x) / 2);
        weight[q] = weight[n - 1 - q] = static_cast<double>(1 / ((1 - x * x) * slope * slope));
    }
}

}  // namespace jvari

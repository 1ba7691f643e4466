// Solves several contacts one by one, with the other forces fixed, until no r changes
// (Gauss-Seidel). The iteration converges if each force falls with its r, because Theta is a Gram
// matrix and the problem is convex. A single contact is solved once.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "schemes/contact/contact_gram.hpp"

namespace jvari {

// force_of(a, b): F of contact a with r = -b + theta_aa F. theta: row-major between the contacts.
template <class ForceOf>
GramSolution solve_in_turn(std::span<const double> theta, const double* b, std::size_t n, double* r,
                           double* force, ForceOf force_of) {
    constexpr int most_sweeps = 10000;
    const auto by_others = [&](std::size_t a) {  // sum of Theta F over the others
        double sum = 0;
        for (std::size_t c = 0; c < n; ++c)
            if (c != a) sum += theta[a * n + c] * force[c];
        return sum;
    };
    GramSolution s;
    s.converged = false;
    std::fill_n(force, n, 0.0);
    for (s.iterations = 1; s.iterations <= most_sweeps && !s.converged; ++s.iterations) {
        // change and range in r [m]; force patterns that Theta hardly distinguishes stay
        // undetermined
        double change = 0, reach = 0;
        for (std::size_t a = 0; a < n; ++a) {
            const double others = by_others(a), F = force_of(a, b[a] - others),
                         theta_aa = theta[a * n + a];
            change = std::max(change, theta_aa * std::abs(F - force[a]));
            reach = std::max(reach, std::abs(b[a]) + std::abs(others) + theta_aa * F);
            force[a] = F;
        }
        s.residual = reach > 0 ? change / reach : 0;
        s.converged = n == 1 || s.residual <= 4 * std::numeric_limits<double>::epsilon();
    }
    --s.iterations;
    if (n == 1) s = {};
    for (std::size_t a = 0; a < n; ++a) r[a] = theta[a * n + a] * force[a] + by_others(a) - b[a];
    return s;
}

}  // namespace jvari

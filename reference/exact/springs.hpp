// Lumped springs on a string: the contacts (one-sided, exponent 1) and the thread (two-sided, with
// a damper). While a set of them is in touch the motion of their points obeys linear Volterra
// equations,
//
//     y_a(t) = p_a(t) + sum_b int_0^t h_ab(t - s) F_b(s) ds,
//     F_b = k_b (height_b - y_b) - r_b y_b'
//
// whose Taylor coefficients follow one from another, and whose remainder a majorant bounds: if
// sum_b sum_i |h_ab^(i)| rho^(-i-1) (k_b + r_b rho) <= 0.9 for every a, then |y_a^(n)| <= C rho^n
// from one n on means the same for all n. h_ab(0) = 0 but of a point with something in series
// (in_series.hpp), whose own h(0) divides its k and r by 1 + r h(0). Times are in units of 1/rate
// (oscillators.hpp). Leaves out: contact loss, exponents other than 1.
#pragma once

#include <optional>
#include <vector>

#include "reference/exact/oscillators.hpp"
#include "reference/in_series.hpp"

namespace jvari {

struct Springs {
    Springs(const Modes&, const Oscillators&, const String&, const std::optional<InSeries>& = {});

    // points 0 ... contacts - 1; the thread, if there is one, is the last point
    int contacts = 0;
    int points = 0;  // contacts and thread
    // one per point; the pluck's force, if there is one, is the last
    int forces = 0;
    std::vector<double> k, r, height;  // [N/m], [N/m] (damper x rate), [m], for each point
    std::vector<double> weights;       // g_a [point][mode]
    std::vector<double> gains;         // g_b/(m rate^2) [force][mode], [m/N]
    std::vector<double> kernel;        // h_ab^(n) [point][force][n], [m/N]
    // largest displacement scale that the pluck can reach, a bound [m]
    double pluck_reach = 0;

    const double* h(int a, int b) const {
        return kernel.data() + (static_cast<long>(a) * forces + b) * longest_series;
    }

    // rho for the contacts that touch: 1/time scale of the springs' motion.
    double growth(const char* touching) const;

    // Over a window of length z: y[a][n] and F[b][n] are n-th derivatives x z^n, n < terms. p[a][n]
    // likewise, n < p_terms, and F of the pluck, are given. With nothing in series.
    void solve(const char* touching, double z, const double* p, int p_terms, int terms, double* y,
               double* F) const;

private:
    void set_floor(double least);

    double floor_ = 0;           // growth is never below this
    std::vector<double> sized_;  // sum_i |h_ab^(i)| floor^(1-i) [point][force]
};

}  // namespace jvari

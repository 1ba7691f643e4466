// The modes of one string as bare oscillators in their own unit of time, 1/rate, rate = the largest
// |eigenvalue|:
//
//     y_i'' + a_i y_i' + b_i y_i = sum_f gain_fi F_f(t),
//     a = 2 sigma/rate <= 2, b = (omega0/rate)^2 <= 1
//
// so that no power of a frequency over- or underflows. Two kernels carry every exact reference with
// contact: the Taylor series of weighted sums of the modes, and the flight over a time t under
// forces of which only the moments m_n = int_0^t (t-s)^n/n! F(s) ds are needed (van Walstijn et al.
// 2016, eq 17, is the equation of motion). Any damping: nothing distinguishes under- from
// overdamped modes.
#pragma once

#include <vector>

#include "reference/partial_sums.hpp"
#include "scenes/modes.hpp"

namespace jvari {

constexpr int longest_series = 56;  // coefficients of any series here

struct Oscillators {
    explicit Oscillators(const Modes&);

    // number of modes, rounded up to whole vectors; the padding beyond the last mode stays zero
    int padded = 0;
    double rate = 0;           // largest |eigenvalue| [1/s]; velocities are u = v/rate [m]
    std::vector<double> a, b;  // padded

    std::vector<double> pad(std::vector<double> row, double factor = 1) const;
};

// p[o*stride + n] = n-th derivative of sum_i weights[o*padded + i] y_i at the present instant, n <
// terms, no force acting; bound[o] = sum_i |weights| (|y_i| + |u_i|), so that |p_n| <= n bound for
// n >= 1. scratch: outputs*(terms + 1)*lanes doubles.
void series(const Oscillators&, const double* y, const double* u, const double* weights,
            int outputs, int terms, double* p, int stride, double* bound, double* scratch);

// The state a time t later: sum_n A^n (state t^n/n! + (0, sum_f gain_f m_fn)), n < terms, by
// Horner. moments[f*stride + n], gains[f][i]. The output may be the input.
void fly(const Oscillators&, const double* y, const double* u, double t, int terms,
         const double* const* gains, const double* moments, int forces, int stride, double* y_out,
         double* u_out);

// sum_i x_i y_i, of padded rows.
double dot(const Oscillators&, const double* x, const double* y);

// How many terms a series with |term n| <= n z^n/n! needs until the rest is below `tolerance`, no
// more than `limit`.
int terms_for(double z, double tolerance, int limit);

}  // namespace jvari

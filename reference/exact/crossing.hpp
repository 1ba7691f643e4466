// Finds the first instant at which a gap turns negative: a slow motion, given by its derivatives,
// plus fast exponential pairs,
//
//     g(u) = sign (sum p_n u^n/n! + Re sum b_k e^(lambda_k u)).
//
// No step can pass a crossing. Over a step d, g stays above g + g'd + g''d^2/2 - A d^3/6 with A a
// bound on |g'''|, or the slow part alone stays above the sum of the pairs' amplitudes. So nothing
// is sampled and nothing is missed, except dips that stay above -bound. Near a crossing the
// derivative has one sign and Householder's iteration finishes. Amplitudes may not grow: Re
// lambda_k <= 0.
#pragma once

#include <complex>

#include "reference/exact/modal_sweep.hpp"

namespace jvari {

constexpr int most_pairs = 8;  // in a gap

struct Gap {
    double sign;
    const double* p;  // [size], zeros behind
    int size;
    // p_n is at most of order growth^n: late terms may be left out early
    double growth;
    const std::complex<double>*b, *lambda;  // [pairs]
    int pairs;

    struct Values {
        double g, slope, curvature;               // slow part and pairs together
        double third;                             // for the pairs
        double slow, slow_slope, slow_curvature;  // without the pairs
        double amplitude;                         // sum |b_k| e^(Re lambda_k u)
    };
    Values at(double u, int terms) const noexcept;
    Values at_start() const noexcept;
    Values at(double u) const noexcept { return at(u, size); }
    int terms_until(double u) const noexcept;       // in whole vectors
    double depth_bound(double end) const noexcept;  // for g in [0, end]
    // Greatest g inside [0, end], or -inf if g has no maximum there. Pairs smaller than 1e-9 times
    // `known` are left out.
    double greatest(double end, double known) const noexcept;
    // Step from u in which g has one turning point at most. The fastest pair larger than `least`
    // decides.
    double one_turn(double u, double least) const noexcept;
};

// First crossing in [0, end], or 2 if there is none. g(0) may be zero already: then the next
// crossing is returned.
double first_crossing(const Gap&, double end, double bound) noexcept;

}  // namespace jvari

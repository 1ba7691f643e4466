#include "reference/exact/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace jvari {

Gap::Values Gap::at(double u, int terms) const noexcept {
    double s[3];
    sweep_functions().evaluate(p, terms, u, s);
    for (double& x : s) x *= sign;
    Values v = {s[0], s[1], s[2], 0, s[0], s[1], s[2], 0};
    for (int k = 0; k < pairs; ++k) {
        const double decay = std::exp(lambda[k].real() * u), phase = lambda[k].imag() * u;
        const double c = decay * std::cos(phase), o = decay * std::sin(phase),
                     lr = lambda[k].real(), li = lambda[k].imag();
        const double br = sign * b[k].real(), bi = sign * b[k].imag();
        const double re = br * c - bi * o, im = br * o + bi * c, re1 = lr * re - li * im,
                     im1 = lr * im + li * re;
        v.g += re;
        v.slope += re1;
        const double re2 = lr * re1 - li * im1, im2 = lr * im1 + li * re1;
        v.curvature += re2;
        v.third += lr * re2 - li * im2;
        v.amplitude += decay * std::sqrt(br * br + bi * bi);
    }
    return v;
}

Gap::Values Gap::at_start() const noexcept {
    Values v = {sign * p[0], sign * p[1], sign * p[2], 0, sign * p[0], sign * p[1], sign * p[2], 0};
    for (int k = 0; k < pairs; ++k) {
        const std::complex<double> b1 = lambda[k] * b[k], b2 = lambda[k] * b1;
        v.g += sign * b[k].real();
        v.slope += sign * b1.real();
        v.curvature += sign * b2.real();
        v.third += sign * (lambda[k] * b2).real();
        v.amplitude += std::sqrt(std::norm(b[k]));
    }
    return v;
}

int Gap::terms_until(double u) const noexcept {
    const double z = growth * u;
    // z^8/8! and z^16/16! are below 1e-15 and 1e-16
    return z < 0.04 ? std::min(size, 8) : z < 0.6 ? std::min(size, 16) : size;
}

double Gap::depth_bound(double end) const noexcept {
    double sum = sign * p[0], power = end;
    for (int n = 1; n < size; power *= end / ++n) sum += std::abs(p[n]) * power;
    for (int k = 0; k < pairs; ++k) sum += std::abs(b[k]);
    return sum;
}

double Gap::one_turn(double u, double least) const noexcept {
    double rate = std::isfinite(growth) ? growth : 0;
    for (int k = 0; k < pairs; ++k)
        if (std::abs(b[k]) * std::exp(lambda[k].real() * u) > least)
            rate = std::max(rate, std::abs(lambda[k]));
    return std::max(
        {1.5 / rate, std::min(0.05 * u, 1e-4), 1e-12});  // some are skipped if there are too many
}

double Gap::greatest(double end, double known) const noexcept {
    const double least = 1e-9 * known;
    // a smaller pair's slope is rounding error
    std::complex<double> amplitudes[most_pairs], rates[most_pairs];
    Gap g = *this;
    g.b = amplitudes, g.lambda = rates, g.pairs = 0;
    for (int k = 0; k < pairs; ++k)
        if (std::abs(b[k]) > least) amplitudes[g.pairs] = b[k], rates[g.pairs++] = lambda[k];
    double greatest = -HUGE_VAL;
    Values before = g.at_start();
    for (double from = 0, to; from < end; from = to) {
        to = std::min(end, from + g.one_turn(from, least));
        const Values after = g.at(to);
        if (before.slope > 0 && after.slope < 0) {
            // Newton's iteration, kept inside
            double low = from, high = to, x = 0.5 * (from + to);
            for (int i = 0; i < 30 && high - low > 1e-9 * to; ++i) {
                const Values now = g.at(x);
                (now.slope > 0 ? low : high) = x;
                greatest = std::max(greatest, now.g);
                const double next = x - now.slope / now.curvature;
                if (std::abs(next - x) < 1e-9 * to) break;
                x = next > low && next < high ? next : 0.5 * (low + high);
            }
        }
        if (to < end) greatest = std::max(greatest, after.g);
        before = after;
    }
    return greatest;
}

namespace {
// Bernstein form for sizes 16, 24 and 32: C(i, n)/(C(size - 1, n) n!) [n][i] turns derivatives into
// coefficients in Bernstein's polynomials of degree size - 1.
const std::vector<std::vector<double>> to_bernstein = [] {
    std::vector<std::vector<double>> tables;
    for (int size = 16; size <= 32; size += 8) {
        std::vector<double> B(size * size, 0.0);
        for (int n = 0; n < size; ++n)
            for (int i = n; i < size; ++i) {
                double x = 1;
                for (int k = 0; k < n; ++k)
                    x *= static_cast<double>(i - k) / ((size - 1 - k) * (k + 1.0));
                B[n * size + i] = x;
            }
        tables.push_back(std::move(B));
    }
    return tables;
}();
// Proves that a gap without pairs is nowhere negative in [0, end], by a bound that is sharper the
// more nearly linear its polynomial is.
bool stays_open(const Gap& gap, double end) noexcept {
    const double z = gap.growth * end;  // a short search is cheaper than this
    if (!(z > 2.5 && z < 100) || gap.pairs > 0 || gap.size < 16 || gap.size > 32 ||
        gap.size % 8 != 0)
        return false;
    double range[2];
    sweep_functions().range(gap.p, to_bernstein[gap.size / 8 - 2].data(), gap.size, end, range);
    return (gap.sign > 0 ? range[0] : -range[1]) >= 0;
}

// Largest d up to `cap` for which g + slope d + curvature d^2/2 - third d^3/6 >= 0 is certain.
double safe_step(double g, double slope, double curvature, double third, double cap) {
    const auto by = [&](double q) {  // g + slope d - q d^2/2 = 0
        const double root = std::sqrt(slope * slope + 2 * q * g);
        if (slope <= 0)
            return root - slope == 0 ? (q == 0 ? HUGE_VAL : 0.0) : 2 * g / (root - slope);
        return q == 0 ? HUGE_VAL : (slope + root) / q;
    };
    if (!(g >= 0)) return 0;
    const double bend = std::max(0.0, -curvature);
    const double first = by(bend + third * cap / 3);
    if (first >= cap) return cap;
    double reach = std::min(cap, 4 * first);
    return std::max(first, std::min(reach, by(bend + third * reach / 3)));
}

// Proves g + slope t + curvature t^2/2 - third t^3/6 >= 0 for all t up to d: the gap stays above a
// concave parabola.
bool safe_over(double g, double slope, double curvature, double third, double d) {
    return g >= 0 && g + d * (slope - 0.5 * d * (std::max(0.0, -curvature) + third * d / 3)) >= 0;
}
// Proves that g falls all the way to d, and is negative there: its slope stays below a convex
// parabola.
bool falls_through(const Gap::Values& v, double third, double d) {
    return v.slope + d * (v.curvature + 0.5 * third * d) < 0 &&
           v.g + d * (v.slope + d * (0.5 * v.curvature + third * d / 6)) < 0;
}
// order 3, or order 4 if the slow part has no third derivative
double householder_step(const Gap::Values& v) {
    const double newton = v.g / v.slope, bend = 0.5 * newton * v.curvature / v.slope;
    return newton * (1 - bend) / (1 - 2 * bend + newton * newton * v.third / (6 * v.slope));
}

struct PairBounds {  // bounds on derivatives, from an instant on: the pairs decay
    double second = 0, third = 0;
    PairBounds(const Gap& gap, double from) {
        for (int k = 0; k < gap.pairs; ++k) {
            const double square = std::norm(gap.lambda[k]),
                         size =
                             std::sqrt(std::norm(gap.b[k])) * std::exp(gap.lambda[k].real() * from);
            second += size * square;
            third += size * square * std::sqrt(square);
        }
    }
};
struct Bounds {  // bounds on derivatives from the start to `until`
    double until;
    int terms;
    double second, third, slow_third;
};
Bounds bounds_between(const Gap& gap, double from, double until) noexcept {
    const PairBounds pairs(gap, from);
    const int terms = gap.terms_until(until);
    double slow[2];
    sweep_functions().bound(gap.p, terms, until, slow);
    return {until, terms, slow[0] + pairs.second, slow[1] + pairs.third, slow[1]};
}

// Finds the crossing if g(low) >= 0 > g(high), and `at` is the gap at x, one of them or between:
// Householder's iteration kept inside.
double crossing_between(const Gap& gap, double low, double high, double x, Gap::Values at,
                        const Bounds& b, double bound) noexcept {
    for (int i = 0; i < 100; ++i) {
        const double step = householder_step(at), bend = 0.5 * at.curvature / at.slope;
        double next = x - step;
        // the second: rounding of g
        const double allowed = std::max(1e-17 * b.until, 1e-3 * bound / std::abs(at.slope));
        if (std::abs(step) <= allowed) return std::clamp(next, low, high);
        if (next > low && next < high) {
            const double rest =
                std::abs(step * step * step) * (bend * bend + b.third / std::abs(6 * at.slope));
            if (rest <= allowed) return next;
        } else {
            next = 0.5 * (low + high);
            if (next == low || next == high) return next;
        }
        x = next;
        at = gap.at(x, b.terms);
        (at.g < 0 ? high : low) = x;
    }
    return x;
}

// first_crossing from `from` on, with the gap `v` there; if there is none, v becomes the gap at the
// end of the bounds.
double crossing_within(const Gap& gap, double from, const Bounds& b, double bound,
                       Gap::Values& v) noexcept {
    const double end = b.until, third = b.third;
    // over this distance no dip is deeper than bound/8
    const double least = std::max(1e-16 * end, b.second > 0 ? std::sqrt(bound / b.second) : end);
    double u = from, before = from;
    for (;;) {
        if (v.g < -bound && u > from) return crossing_between(gap, before, u, u, v, b, bound);
        if (u >= end) return 2;
        const double left = end - u;
        if (v.slope < 0 && v.g > 0) {
            const double span = std::min(-1.5 * householder_step(v), left);
            if (span > 0 && falls_through(v, third, span))
                return crossing_between(gap, u, u + span, u, v, b, bound);
            // the gap falls, perhaps not through
            if (v.slope + left * (v.curvature + 0.5 * third * left) < 0) {
                const auto last = gap.at(end, b.terms);
                if (last.g < 0) return crossing_between(gap, u, end, u, v, b, bound);
                v = last;
                return 2;
            }
        }
        double step = safe_step(std::max(0.0, v.g), v.slope, v.curvature, third, left);
        if (gap.pairs > 0)
            step = std::max(step, safe_step(v.slow - v.amplitude, v.slow_slope, v.slow_curvature,
                                            b.slow_third, left));
        before = u;
        u = std::min(end, u + std::max(step, least));
        v = gap.at(u, b.terms);
    }
}
}  // namespace

double first_crossing(const Gap& gap, double end, double bound) noexcept {
    double fastest = 0;
    for (int k = 0; k < gap.pairs; ++k)
        fastest = std::max({fastest, gap.lambda[k].imag(), -gap.lambda[k].real()});
    Gap::Values v = gap.at_start();
    const Bounds whole = bounds_between(gap, 0, end);
    // the bound overflows, and so does the motion, which ends the run
    if (!std::isfinite(whole.third)) return 2;
    if (safe_over(v.slow - v.amplitude, v.slow_slope, v.slow_curvature, whole.slow_third, end))
        return 2;
    if (stays_open(gap, end)) return 2;
    double from = 0;
    // each stage has separate terms and bounds: early ones are cheap
    for (double to = fastest > 0 ? 8 / fastest : 0.25 * end;; to *= 4) {
        if (to > 0.5 * end) to = end;
        const double crossing = crossing_within(
            gap, from, from == 0 && to == end ? whole : bounds_between(gap, from, to), bound, v);
        if (crossing <= end || to == end) return crossing;
        from = to;
    }
}

}  // namespace jvari

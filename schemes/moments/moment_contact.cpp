// Source: docs/two-moments.md. Discrete gradient: Gonzalez 1996; moments of the force: Galerkin in
// time, Betsch & Steinmann 2001; contact loss: Hunt & Crossley 1975.
#include "schemes/moments/moment_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace jvari {

namespace {
constexpr double half_bit = std::numeric_limits<double>::epsilon();
constexpr double radiates = 0.2;            // value of rho above which rule D takes the contact
constexpr double stiff = 1e10;              // for a rigid barrier, k T_00
constexpr double rounding_squared = 1e-22;  // squared rounding error of r, in rule G
constexpr int most_newton = 100, most_halvings = 25;

MomentMatrix inverse(const MomentMatrix& a) {
    const double det = a.m00 * a.m11 - a.m01 * a.m10;
    return {a.m11 / det, -a.m01 / det, -a.m10 / det, a.m00 / det};
}
}  // namespace

MomentRule::MomentRule(const ContactLaw& law, double beta, LossLaw loss, const MomentMatrix& T,
                       double span, bool alone)
    : law_(law.rigid() ? ContactLaw{stiff / T.m00, 1} : law),
      beta_(beta),
      span_(span),
      c_(1 / law_.k),
      share_(1 / (law_.alpha + 1)),
      halves_(halves_in(law_.alpha)),
      clipped_(loss == LossLaw::clipped),
      galerkin_(alone && !law.rigid() && 3 * T.m11 < radiates * T.m00),
      linear_(!galerkin_ && beta == 0 && law_.alpha == 1) {}

[[gnu::always_inline]] inline MomentRule::Powers MomentRule::powers(double eta) const noexcept {
    if (!(eta > 0)) return {0, 0, 0, 0};
    const double root = halves_ % 2 == 1 ? std::sqrt(eta) : 0,
                 by = law_.k * (halves_ > 0 ? power_of_halves(eta, root, halves_ - 2)
                                            : std::pow(eta, law_.alpha - 1));
    const double force = by * eta;
    return {force * eta * share_, force, law_.alpha * by, root};
}

namespace {
// h_n = u^(n-1) + u^(n-2) w + ... + w^(n-1) = (u^n - w^n)/(u - w), and its derivative by u
struct Sum {
    double value, by_u;
};
[[gnu::always_inline]] inline Sum sum_of_powers(double u, double w, int n) {
    double h = 1, by_u = 0, power_of_w = 1;
    for (int i = 1; i < n; ++i) {
        by_u = by_u * u + h;
        power_of_w *= w;
        h = h * u + power_of_w;
    }
    return {h, by_u};
}
}  // namespace

// DV without a difference, 2 alpha a small whole number: k/(alpha + 1) h_(alpha+1) of both
// penetrations for a whole alpha, else h_(2 alpha+2)/h_2 of their roots.
[[gnu::always_inline]] inline double MomentRule::quotient_by_sums(double from, double to,
                                                                  const Powers& a,
                                                                  const Powers& b) const noexcept {
    const double by = law_.k * share_;
    if (halves_ % 2 == 0) return by * sum_of_powers(from, to, halves_ / 2 + 1).value;
    return by * (sum_of_powers(a.root, b.root, halves_ + 2).value / (a.root + b.root));
}

[[gnu::always_inline]] inline MomentRule::Quotient MomentRule::quotient(
    double from, double to, const Powers& a, const Powers& b) const noexcept {
    if (from <= 0 && to <= 0) return {0, 0, 0};
    const double d = to - from;
    const bool by_sums = from > 0 && to > 0 && halves_ > 0;
    if (!by_sums && from > 0 && std::abs(d) < 0.05 * from) {  // avoids the difference in V
        const double by = 1 / from;
        const auto [value, slope] = power_quotient(law_.alpha + 1, d * by);
        const double mean = a.force * share_ * value, by_to = a.force * share_ * slope * by;
        return {mean, (law_.alpha * mean - to * by_to) * by, by_to};  // DV is homogeneous
    }
    const double by = 1 / d, value = by_sums ? quotient_by_sums(from, to, a, b) : (b.V - a.V) * by;
    if (by_sums && (law_.alpha == 1 || std::abs(d) < 1e-8 * from))
        return {value, 0.5 * a.slope, 0.5 * b.slope};
    return {value, (value - a.force) * by, (b.force - value) * by};
}

bool MomentRule::stays_out(double eta, double b_0, double b_1) const {
    const double E_1 = eta - b_0;
    if (!galerkin_) return E_1 <= 0 && eta + b_1 <= 0;
    if (eta > 0 || E_1 > 0) return false;
    const double slope = 3 * b_1 - b_0;  // the parabola may rise above both ends
    return b_1 <= 0 || slope <= 0 || slope >= 6 * b_1 || eta + slope * slope / (12 * b_1) <= 0;
}

// Exponent 1.   (8)
bool MomentRule::by_lines(const MomentMatrix& T, double E_0, double E_1,
                          MomentContact& s) const noexcept {
    const auto put = [&s](double phi_0, double phi_1, double from, double to) {
        s.phi_0 = phi_0, s.phi_1 = phi_1, s.from = from, s.to = to;
        return true;
    };
    if (E_0 <= 0 && E_1 <= 0) return put(0, 0, E_0, E_1);
    {  // full
        const double a = c_ + T.m00, b = c_ + T.m01, d = c_ - T.m10, e = -c_ - T.m11,
                     det = a * e - b * d, first = e * E_1 - b * E_0, second = a * E_0 - d * E_1;
        if (std::copysign(first, first * det) > std::abs(second)) {
            const double phi_0 = first / det, phi_1 = second / det;
            return put(phi_0, phi_1, c_ * (phi_0 - phi_1), c_ * (phi_0 + phi_1));
        }
    }
    const double A_0 = T.m00 + T.m01, A_1 = T.m10 + T.m11;
    if (E_1 > 0 && !(E_0 > 0 && A_1 >= 0)) {  // enters: no sum below has terms with both signs
        const double rise = E_1 - E_0,
                     square = c_ * c_ * rise * rise - 2 * c_ * E_1 * (A_0 * E_0 + A_1 * E_1);
        if (square >= 0) {
            const double p = E_1 * E_1 / (E_1 * A_0 + c_ * rise + std::sqrt(square)),
                         from = E_0 + A_1 * p, cp = c_ * p;
            if (p > 0 && from <= 0 && E_1 >= A_0 * p)
                return put(p, p, from, cp + std::sqrt(cp * (cp - 2 * from)));
        }
    }
    // leaves: V'(e_0) = q = X_0 + X_1 p, e_1 = y_0 + y_1 p, 2 p (e_0 - e_1) = c q^2
    const double X_0 = E_0 / (c_ + T.m11), X_1 = A_1 / (c_ + T.m11), y_0 = E_1 + T.m01 * X_0,
                 y_1 = -A_0 + T.m01 * X_1;
    const double A = 2 * (c_ * X_1 - y_1) - c_ * X_1 * X_1,
                 B = 2 * (c_ * X_0 - y_0) - 2 * c_ * X_0 * X_1, C = -c_ * X_0 * X_0,
                 square = B * B - 4 * A * C;
    if (!(square >= 0)) return false;
    const double half = -0.5 * (B + std::copysign(std::sqrt(square), B));
    const auto leaves = [&](double p) {
        const double q = X_0 + X_1 * p, from = c_ * q, to = y_0 + y_1 * p;
        if (!(p >= 0 && q >= 0 && to <= 1e-15 * std::abs(E_1))) return false;
        return put(p, p - q, from, std::min(0.0, p > 0 ? from - 0.5 * q * from / p : to));
    };
    return (half != 0 && leaves(C / half)) || (A != 0 && leaves(half / A));
}

// Both ends by the law's tangent at the present penetration, in full contact.
[[gnu::always_inline]] inline MomentRule::Ends MomentRule::first_guess(const MomentMatrix& T,
                                                                       double eta, double E_0,
                                                                       double E_1) const noexcept {
    const double A_0 = T.m00 + T.m01, A_1 = T.m10 + T.m11, low = std::min(E_0, 0.0);
    const double at = eta > 0 ? eta : 0.5 * std::max(E_0, E_1);
    const Powers l = powers(at);
    const double k = l.slope, F = l.force - k * at;
    const double a = 1 - 0.5 * k * A_1 + k * T.m11, b = -0.5 * k * A_1,
                 c = 0.5 * k * A_0 - k * T.m01, d = 1 + 0.5 * k * A_0, R_0 = E_0 + T.m10 * F,
                 R_1 = E_1 - T.m00 * F;
    const double by_det = 1 / (a * d - b * c), to = (a * R_1 - c * R_0) * by_det;
    double x = (d * R_0 - b * R_1) * by_det;
    if (eta <= 0 && E_0 <= 0) {  // enters
        const double out = E_0 + A_1 * E_1 / A_0;
        if (out <= 0) x = low + 0.999 * (out - low);
    }
    if (!(x > low)) x = eta > low ? eta : low + std::max(1e-3 * std::abs(E_0 - E_1), 1e-14);
    return {x, to};
}

// Newton's steps for (9) in full contact, 2 alpha a small whole number. In the roots u, w of both
// ends (in the ends, for a whole alpha) both equations are polynomials: p h_j = k/(alpha + 1)
// h_(m+j) and w^j = E_1 - A_0 p + T_01 k u^m, with p = (u^j + T_11 k u^m - E_0)/A_1.
[[gnu::always_inline]] inline bool MomentRule::by_polynomials(const MomentMatrix& T,
                                                              const Ends& guess, double E_0,
                                                              double E_1,
                                                              MomentContact& s) const noexcept {
    if (halves_ <= 0 || !(guess.from > 0 && guess.to > 0)) return false;
    constexpr int most = 6;
    constexpr double close = 1e-8;  // relative: the next error is about its square
    const bool roots = halves_ % 2 == 1;
    const int j = roots ? 2 : 1, m = roots ? halves_ : halves_ / 2;
    const double by_A_1 = 1 / (T.m10 + T.m11), A_0 = T.m00 + T.m01, by = law_.k * share_;
    const auto end = [=](double x) { return roots ? x * x : x; };
    double u = roots ? std::sqrt(guess.from) : guess.from,
           w = roots ? std::sqrt(guess.to) : guess.to;
    for (s.iterations = 1; s.iterations <= most; ++s.iterations) {
        double below = law_.k;  // k u^(m-1)
        for (int i = 1; i < m; ++i) below *= u;
        const double F = below * u, F_u = m * below, from_u = roots ? 2 * u : 1,
                     to_w = roots ? 2 * w : 1, p = (end(u) + T.m11 * F - E_0) * by_A_1,
                     p_u = (from_u + T.m11 * F_u) * by_A_1, h_j = roots ? u + w : 1;
        const Sum h = sum_of_powers(u, w, m + j);
        const double h_w = sum_of_powers(w, u, m + j).by_u, p_by = roots ? p : 0,
                     R = p * h_j - by * h.value, S = end(w) - E_1 + A_0 * p - T.m01 * F,
                     R_u = p_u * h_j + p_by - by * h.by_u, R_w = p_by - by * h_w,
                     S_u = A_0 * p_u - T.m01 * F_u, by_det = 1 / (R_u * to_w - R_w * S_u),
                     du = (R_w * S - R * to_w) * by_det, dw = (S_u * R - R_u * S) * by_det;
        u += du, w += dw;
        if (!(u > 0 && w > 0)) return false;
        if (std::abs(du) > close * u || std::abs(dw) > close * w) continue;
        s.phi_0 = p + p_u * du, s.phi_1 = s.phi_0 - (F + F_u * du);
        s.from = end(u), s.to = end(w);
        s.residual = std::abs(R) / (p * h_j);
        return s.converged = true;
    }
    return false;
}

// Newton's steps for the end e_1 of a contact that enters, from the energy.
void MomentRule::end_from_energy(double p, double x, MomentContact& s) const noexcept {
    Powers b = powers(s.to);
    for (int i = 0; i < 8; ++i) {
        const double next = s.to - (b.V - p * (s.to - x)) / (b.force - p);
        if (!(next > 0)) break;
        const bool same = std::abs(next - s.to) <= half_bit * s.to;
        s.to = next;
        b = powers(next);
        if (same) break;
    }
}

// Solves one scalar equation in x = e_0, from a guess: p = (x + T_11 V'(x) - E_0)/A_1, e_1 = E_1 -
// A_0 p + T_01 V'(x), g = p - DV(x, e_1) = 0.   (9)
void MomentRule::by_newton(const MomentMatrix& T, double guess, double E_0, double E_1,
                           MomentContact& s) const noexcept {
    const double A_0 = T.m00 + T.m01, A_1 = T.m10 + T.m11, by_A_1 = 1 / A_1;
    double low = std::min(E_0, 0.0), high = std::numeric_limits<double>::infinity(), x = guess;
    double p = 0, to = 0;
    Powers a{}, b{};
    Quotient v{};
    const auto look = [&] {
        a = powers(x);
        p = (x + T.m11 * a.force - E_0) * by_A_1;
        to = E_1 - A_0 * p + T.m01 * a.force;
        b = powers(to);
        v = quotient(x, to, a, b);
    };
    double last = std::numeric_limits<double>::infinity();
    const double close = 2e-8 / law_.alpha;  // relative: the next error is about its square
    s.converged = false;
    for (s.iterations = 1; s.iterations <= most_newton; ++s.iterations) {
        look();
        const double g = p - v.value, by_x = (1 + T.m11 * a.slope) * by_A_1, size = std::abs(g),
                     to_by_x = T.m01 * a.slope - A_0 * by_x,
                     slope = by_x - v.by_from - v.by_to * to_by_x;
        if (g > 0) high = std::min(high, x);
        else low = std::max(low, x);
        double next = x - g / slope;
        const double step = next - x, reach = std::max(std::abs(x), std::abs(to)),
                     scale = std::max(std::abs(v.value), 1e-300);
        if (slope > 0 && std::abs(step) <= close * std::abs(x) &&
            std::abs(step * to_by_x) <= close * reach) {
            p += by_x * step, a.force += a.slope * step, to += to_by_x * step, x = next;
            s.converged = true;
            s.residual = size / scale;
            break;
        }
        if (size > 1e-6 * scale && (!(next > low && next < high) || !(slope > 0)))
            next = std::isfinite(high) ? 0.5 * (low + high) : x + 2 * (x - low) + 1e-14;
        // to rounding, which may be larger if the contact is stiff
        s.converged = size <= 1e-14 * scale || std::abs(next - x) <= half_bit * std::abs(x) ||
                      (size <= 1e-11 * scale && size >= 0.5 * last);
        s.residual = size / scale;
        if (s.converged) break;
        last = size;
        x = next;
    }
    // p, not DV: in a stiff contact DV has the rounding error of penetrations
    s.phi_0 = p, s.phi_1 = p - a.force, s.from = x, s.to = to;
    if (x <= 0 && to > 0 && to < 0.1 * std::abs(E_1)) end_from_energy(p, x, s);  // enters
}

// Brackets p, between 0 and a force that is too large: slower, for cases in which rounding keeps
// by_lines and by_newton from an end.
void MomentRule::by_bracket(const MomentMatrix& T, double E_0, double E_1,
                            MomentContact& s) const noexcept {
    const double A_0 = T.m00 + T.m01, A_1 = T.m10 + T.m11;
    Powers a{};
    const auto miss = [&](double p) {
        s.from = depth_in_series(law_, E_0 + A_1 * p, T.m11);
        a = powers(s.from);
        s.to = E_1 - A_0 * p + T.m01 * a.force;
        s.phi_0 = quotient(s.from, s.to, a, powers(s.to)).value;
        s.phi_1 = s.phi_0 - a.force;
        return p - s.phi_0;
    };
    double low = 0, f_low = miss(0), high = s.phi_0, f_high = miss(high);
    for (int i = 0; f_high < 0 && i < most_newton; ++i, f_high = miss(high))
        low = high, f_low = f_high, high *= 4;
    int side = 0;
    s.converged = f_low == 0;
    for (s.iterations = 1; s.iterations < 2 * most_newton && !s.converged; ++s.iterations) {
        double p = (low * f_high - high * f_low) / (f_high - f_low);
        if (!(p > low && p < high)) p = 0.5 * (low + high);
        const double f = miss(p);
        s.converged = std::abs(f) <= 4 * half_bit * p || high - low <= 4 * half_bit * high;
        if (f > 0) {
            high = p, f_high = f;
            if (side == 1) f_low *= 0.5;
            side = 1;
        } else {
            low = p, f_low = f;
            if (side == -1) f_high *= 0.5;
            side = -1;
        }
    }
}

[[gnu::always_inline]] inline void MomentRule::without_loss(const MomentMatrix& T, double eta,
                                                            double E_0, double E_1,
                                                            MomentContact& s) const noexcept {
    if (E_0 <= 0 && E_1 <= 0) {
        s.phi_0 = s.phi_1 = 0, s.from = E_0, s.to = E_1, s.converged = true;
        return;
    }
    s.converged = law_.alpha == 1 && by_lines(T, E_0, E_1, s);
    if (s.converged) return;
    const double A_1 = T.m10 + T.m11;
    if (A_1 > 1e-6 * T.m00) {
        const Ends guess = first_guess(T, eta, E_0, E_1);
        if (!(eta > 0 && by_polynomials(T, guess, E_0, E_1, s)))
            by_newton(T, guess.from, E_0, E_1, s);
    }
    // if forces hardly move the contact, p is the small difference between two penetrations
    const bool small = A_1 * std::abs(s.phi_0) < 1e-3 * (std::abs(s.from) + std::abs(E_0));
    if (!s.converged || (s.phi_0 != 0 && small)) by_bracket(T, E_0, E_1, s);
}

// Makes the step with the dampers l_0, l_1 from (11).
void MomentRule::damped(const MomentMatrix& T, double eta, double b_0, double b_1, double l_0,
                        double l_1, MomentContact& s) const noexcept {
    const MomentMatrix L{l_0 / span_, l_1 / span_, l_1 / span_, 3 * l_0 / span_};
    MomentMatrix one = times(T, L);
    one.m00 += 1, one.m11 += 1;
    const MomentMatrix I = inverse(one), less = times(I, T);
    without_loss(less, eta, eta + I.m10 * b_0 + I.m11 * b_1, eta - I.m00 * b_0 - I.m01 * b_1, s);
    double r_0 = eta - s.to, r_1 = s.from - eta;
    const auto push = [&](int i) {
        return i == 0 ? s.phi_0 - L.m00 * r_0 - L.m01 * r_1 : s.phi_1 - L.m10 * r_0 - L.m11 * r_1;
    };
    // A creeping contact moves little beside b: rounding errors in r = b + T phi are corrected by
    // changes in r that the dampers alone resist.
    const double off_0 = b_0 + T.m00 * push(0) + T.m01 * push(1) - r_0,
                 off_1 = b_1 + T.m10 * push(0) + T.m11 * push(1) - r_1;
    r_0 += I.m00 * off_0 + I.m01 * off_1, r_1 += I.m10 * off_0 + I.m11 * off_1;
    s.to = eta - r_0, s.from = eta + r_1;
    const double d_0 = L.m00 * r_0 + L.m01 * r_1, d_1 = L.m10 * r_0 + L.m11 * r_1;
    const Powers from = powers(s.from);
    s.lost = law_.potential(eta) - from.V - from.force * (eta - s.from) + d_0 * r_0 + d_1 * r_1;
    s.phi_0 -= d_0, s.phi_1 -= d_1;
    s.slope = {-L.m00, -L.m01, -L.m10, -L.m11};
}

// l_0 = beta DV(e_0, e_1), bracketed from 0 by regula falsi (Illinois); l_1 in a fixed ratio to
// l_0.
void MomentRule::with_loss(const MomentMatrix& T, double eta, double b_0, double b_1,
                           MomentContact& s) const noexcept {
    damped(T, eta, b_0, b_1, 0, 0, s);
    if (s.phi_0 == 0 && s.phi_1 == 0) return;
    int passes = 1;
    double ratio = 0, elastic = 0;
    const auto miss = [&](double l_0) {
        damped(T, eta, b_0, b_1, l_0, ratio * l_0, s);
        ++passes;
        const Powers from = powers(s.from);
        elastic = quotient(s.from, s.to, from, powers(s.to)).value;
        return l_0 - beta_ * elastic;
    };
    miss(0);
    double low = 0, high = beta_ * elastic, f_low = -high;
    if (high > 0) {
        miss(high);
        if (elastic > 0) ratio = std::clamp((elastic - powers(s.from).force) / elastic, -1.0, 1.0);
        high = std::max(beta_ * elastic, 1e-300);
        double f_high = miss(high);
        for (; f_high < 0 && passes < most_newton; f_high = miss(high))
            low = high, f_low = f_high, high *= 4;
        int side = 0;
        for (; passes < most_newton && high - low > 1e-14 * high;) {
            double l = (low * f_high - high * f_low) / (f_high - f_low);
            if (!(l > low && l < high)) l = 0.5 * (low + high);
            const double f = miss(l);
            if (std::abs(f) <= 1e-12 * l) break;
            if (f > 0) {
                high = l, f_high = f;
                if (side == 1) f_low *= 0.5;
                side = 1;
            } else {
                low = l, f_low = f;
                if (side == -1) f_high *= 0.5;
                side = -1;
            }
        }
    }
    if (clipped_ && s.phi_0 < 0)
        shrink(T, eta, b_0, b_1, beta_ * elastic, ratio * beta_ * elastic, s);
    s.iterations = std::max(s.iterations, passes);
}

// Handles a clipped loss: reduces the dampers until the mean contact force does not pull.
void MomentRule::shrink(const MomentMatrix& T, double eta, double b_0, double b_1, double l_0,
                        double l_1, MomentContact& s) const noexcept {
    double low = 0, high = 1;
    for (int i = 0; i < 50; ++i) {
        const double part = 0.5 * (low + high);
        damped(T, eta, b_0, b_1, part * l_0, part * l_1, s);
        (s.phi_0 < 0 ? high : low) = part;
    }
    damped(T, eta, b_0, b_1, low * l_0, low * l_1, s);
}

namespace {
// Gauss's rules on [0, 1]
struct Node {
    double at, weight;
};
constexpr std::array<Node, 3> three = {{{0.1127016653792583, 0.2777777777777778},
                                        {0.5, 0.4444444444444444},
                                        {0.8872983346207417, 0.2777777777777778}}};
constexpr std::array<Node, 8> eight = {{{0.0198550717512319, 0.0506142681451881},
                                        {0.1016667612931866, 0.1111905172266872},
                                        {0.2372337950418355, 0.1568533229389436},
                                        {0.4082826787521751, 0.1813418916891810},
                                        {0.5917173212478249, 0.1813418916891810},
                                        {0.7627662049581645, 0.1568533229389436},
                                        {0.8983332387068134, 0.1111905172266872},
                                        {0.9801449282487681, 0.0506142681451881}}};
}  // namespace

MomentRule::Integrals MomentRule::integrals(double eta, double r_0, double r_1) const noexcept {
    const double A = -3 * r_1, B = 3 * r_1 - r_0, end = eta - r_0;
    std::array<double, 5> cut{};
    std::size_t cuts = 0;
    const auto add = [&](double s) {  // in order
        if (!(s > 0 && s < 1)) return;
        std::size_t i = cuts++;
        for (; i > 0 && cut[i - 1] > s; --i) cut[i] = cut[i - 1];
        cut[i] = s;
    };
    if (const double square = B * B - 4 * A * eta; square > 0) {
        const double half = -0.5 * (B + std::copysign(std::sqrt(square), B));
        if (half != 0) add(eta / half);
        if (A != 0) add(half / A);
    }
    if (clipped_ && beta_ > 0 && A != 0) add(-(span_ / beta_ + B) / (2 * A));
    cut[cuts++] = 1;
    Integrals all;
    const bool polynomial = law_.alpha == 1;
    const std::span<const Node> nodes =
        polynomial ? std::span<const Node>(three) : std::span<const Node>(eight);
    double begin = 0, elastic_0 = 0, elastic_1 = 0;
    for (std::size_t i = 0; i < cuts; begin = cut[i++]) {
        const double length = cut[i] - begin, middle = begin + 0.5 * length;
        if (!((A * middle + B) * middle + eta > 0)) continue;
        for (const Node& node : nodes) {
            const double s = begin + node.at * length, P_1 = 2 * s - 1, w = node.weight * length,
                         rate = (2 * A * s + B) / span_;  // eta'
            const Powers v = powers((A * s + B) * s + eta);
            const bool open = clipped_ && 1 + beta_ * rate < 0;
            const double damping = open ? -1 : beta_ * rate, F = v.force * (1 + damping);
            elastic_0 += w * v.force, elastic_1 += 3 * w * v.force * P_1;
            all.phi_0 += w * F, all.phi_1 += 3 * w * F * P_1;
            all.lost += w * v.force * damping * rate * span_;
            const double by_eta = open ? 0 : v.slope * (1 + damping),
                         by_rate = open ? 0 : v.force * beta_ / span_;
            const double by_0 = -s * by_eta - by_rate,
                         by_1 = 3 * (s - s * s) * by_eta - 3 * P_1 * by_rate;
            all.slope.m00 += w * by_0, all.slope.m01 += w * by_1;
            all.slope.m10 += 3 * w * P_1 * by_0, all.slope.m11 += 3 * w * P_1 * by_1;
        }
    }
    // Powers are no polynomials: the rest of the energy along r (Gonzalez 1996).
    if (const double size = r_0 * r_0 + 3 * r_1 * r_1; !polynomial && size > 0) {
        const double rest =
            (law_.potential(eta) - law_.potential(end) - elastic_0 * r_0 - elastic_1 * r_1) / size;
        all.phi_0 += rest * r_0, all.phi_1 += 3 * rest * r_1;
    }
    return all;
}

// Newton's steps in r with a line search on the residual of r = b + T phi(r), from the guess in s.
bool MomentRule::galerkin_from(const MomentMatrix& T, double eta, double b_0, double b_1,
                               MomentContact& s) const noexcept {
    double r_0 = eta - s.to, r_1 = s.from - eta;
    struct Point {
        Integrals at;
        double e_0, e_1, size;
    };
    const auto look = [&](double x_0, double x_1) {
        Point p{integrals(eta, x_0, x_1), 0, 0, 0};
        p.e_0 = x_0 - b_0 - T.m00 * p.at.phi_0 - T.m01 * p.at.phi_1;
        p.e_1 = x_1 - b_1 - T.m10 * p.at.phi_0 - T.m11 * p.at.phi_1;
        p.size = p.e_0 * p.e_0 + p.e_1 * p.e_1;
        return p;
    };
    const double scale = b_0 * b_0 + b_1 * b_1 + eta * eta + 1e-60;
    Point now = look(r_0, r_1);
    for (int i = 0; i < most_newton && now.size > 1e-29 * scale; ++i) {
        ++s.iterations;
        MomentMatrix J = times(T, now.at.slope);
        J = inverse({1 - J.m00, -J.m01, -J.m10, 1 - J.m11});
        const double d_0 = -(J.m00 * now.e_0 + J.m01 * now.e_1),
                     d_1 = -(J.m10 * now.e_0 + J.m11 * now.e_1);
        int halved = 0;
        const int most = now.size <= rounding_squared * scale ? 1 : most_halvings;
        for (double part = 1; halved < most; ++halved, part *= 0.5) {
            const Point next = look(r_0 + part * d_0, r_1 + part * d_1);
            if (!(next.size < now.size)) continue;
            r_0 += part * d_0, r_1 += part * d_1;
            now = next;
            break;
        }
        if (halved == most) break;
    }
    s.residual = std::sqrt(now.size / scale);
    s.phi_0 = now.at.phi_0, s.phi_1 = now.at.phi_1, s.slope = now.at.slope;
    s.from = eta + r_1, s.to = eta - r_0, s.lost = now.at.lost;
    return now.size <= rounding_squared * scale;
}

// Exponent 1 without loss, in contact over the whole step: phi = k (eta - (r_0 - r_1)/2, -r_0/2).
bool MomentRule::guess_in_full(const MomentMatrix& T, double eta, double b_0, double b_1,
                               MomentContact& s) const noexcept {
    if (law_.alpha != 1 || beta_ > 0 || !(eta > 0)) return false;
    const double half = 0.5 * law_.k;
    const MomentMatrix I = inverse(
        {1 + half * (T.m00 + T.m01), -half * T.m00, half * (T.m10 + T.m11), 1 - half * T.m10});
    const double R_0 = b_0 + T.m00 * law_.k * eta, R_1 = b_1 + T.m10 * law_.k * eta,
                 r_0 = I.m00 * R_0 + I.m01 * R_1, r_1 = I.m10 * R_0 + I.m11 * R_1;
    s.to = eta - r_0, s.from = eta + r_1;
    return s.to > 0 && eta - 0.5 * r_0 + 0.75 * std::min(r_1, 0.0) > 0;
}

// Starts from the line or rule D's step, or else follows a path from no compliances to all. A step
// for which both fail is rule D's, with rule D's loss.
void MomentRule::by_galerkin(const MomentMatrix& T, double eta, double b_0, double b_1,
                             MomentContact& s) const noexcept {
    if (stays_out(eta, b_0, b_1)) {
        s.from = eta, s.to = eta - b_0;
        return;
    }
    if (!guess_in_full(T, eta, b_0, b_1, s)) without_loss(T, eta, eta + b_1, eta - b_0, s);
    s.converged = galerkin_from(T, eta, b_0, b_1, s);
    if (!s.converged) {
        s.from = eta + b_1, s.to = eta - b_0;
        for (double part = 1.0 / 64; part <= 1; part *= 2)
            s.converged = galerkin_from({part * T.m00, part * T.m01, part * T.m10, part * T.m11},
                                        eta, b_0, b_1, s);
    }
    if (s.converged) {
        s.from = eta, s.by_parabola = true;
        return;
    }
    s.slope = {};
    by_rule_d(T, eta, b_0, b_1, s);
}

void MomentRule::by_rule_d(const MomentMatrix& T, double eta, double b_0, double b_1,
                           MomentContact& s) const noexcept {
    if (beta_ > 0) {
        with_loss(T, eta, b_0, b_1, s);
        return;
    }
    without_loss(T, eta, eta + b_1, eta - b_0, s);
    s.lost_by_ends = true;
}

void MomentRule::solve(const MomentMatrix& T, double eta, double b_0, double b_1,
                       MomentContact& s) const noexcept {
    s = {};
    if (linear_ && by_lines(T, eta + b_1, eta - b_0, s)) s.lost_by_ends = true;
    else if (galerkin_) by_galerkin(T, eta, b_0, b_1, s);
    else by_rule_d(T, eta, b_0, b_1, s);
    s.touches = s.to > 0;
}

MomentMatrix MomentRule::answer(const MomentMatrix& T, const MomentContact& s) const noexcept {
    MomentMatrix K = s.slope;
    if (!s.by_parabola) {
        const Powers a = powers(s.from);
        const Quotient v = quotient(s.from, s.to, a, powers(s.to));
        K.m00 -= v.by_to, K.m01 += v.by_from;
        K.m10 -= v.by_to, K.m11 += v.by_from - a.slope;
    }
    const MomentMatrix one = times(T, K);
    return times(K, inverse({1 - one.m00, -one.m01, -one.m10, 1 - one.m11}));
}

}  // namespace jvari

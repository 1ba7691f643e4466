#include "schemes/contact/piecewise_rule.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

PiecewiseLaw::PiecewiseLaw(const ContactLaw& law, double tolerance) {
    const double bend = law.alpha * std::abs(law.alpha - 1) / 8;
    per_octave_ = bend == 0 ? 1 : std::max(1, static_cast<int>(std::ceil(std::sqrt(bend / tolerance))));
    misfit_ = bend / (per_octave_ * per_octave_);
    pieces_.resize(octaves * per_octave_ + 1);
    for (std::size_t j = 1; j < pieces_.size(); ++j) {  // pieces_[0] begins at depth 0
        const int step = static_cast<int>(j) - 1;
        Piece &p = pieces_[j], &last = pieces_[j - 1];
        p.eta = std::ldexp(1 + static_cast<double>(step % per_octave_) / per_octave_, lowest + step / per_octave_);
        p.force = law.force(p.eta);
        const double d = p.eta - last.eta;
        last.slope = (p.force - last.force) / d;
        p.potential = last.potential + 0.5 * (p.force + last.force) * d;
        p.slope = law.slope(p.eta);
    }
}

int PiecewiseLaw::piece_of(double eta) const {
    int exponent = 0;
    const double mantissa = 2 * std::frexp(eta, &exponent) - 1;  // 0 to 1
    const int octave = exponent - 1 - lowest;
    if (octave < 0) return 0;
    return std::min(octave * per_octave_ + static_cast<int>(mantissa * per_octave_) + 1, static_cast<int>(pieces_.size()) - 1);
}

double PiecewiseLaw::potential(double eta) const {
    if (eta <= 0) return 0;
    const Piece& p = pieces_[piece_of(eta)];
    return at(p, eta - p.eta);
}

ContactSolution PiecewiseLaw::solve(double eta, double b, double theta) const noexcept {
    if (eta <= 0 && eta + b <= 0) return {-b, 0.0};  // stays out
    const double V = potential(eta);
    if (eta > 0 && eta * (eta + b) <= theta * V) {  // leaves: r (r + b) = theta V, r >= eta
        const double root = std::sqrt(b * b + 4 * theta * V), r = b > 0 ? 2 * theta * V / (b + root) : 0.5 * (root - b);
        return {r, V / r};
    }
    const int home = eta > 0 ? piece_of(eta) : -1;
    int low = 0, high = eta + b > 0 ? piece_of(eta + b) : home;  // the depth is eta + b without force, and less with one
    if (eta > 0 && eta + b > 0) high = std::max(high, home);
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        const Piece& p = pieces_[middle];
        const double r = eta - p.eta, at_p = r == 0 ? p.force : (V - p.potential) / r;
        (r + b - theta * at_p >= 0 ? low : high) = r + b - theta * at_p >= 0 ? middle : middle - 1;
    }
    const Piece& p = pieces_[low];
    if (low == home) {  // both depths in one piece: a spring
        const double f = p.force + p.slope * (eta - p.eta), r = (theta * f - b) / (1 + 0.5 * theta * p.slope);
        return {r, f - 0.5 * p.slope * r};
    }
    const double R = eta - p.eta, free = R + b;  // r = R - d: A d^2 - 2 B d + C = 0
    const double A = 1 + 0.5 * theta * p.slope, B = 0.5 * (R + free - theta * p.force), C = R * free - theta * (V - p.potential);
    const double root = std::sqrt(std::max(0.0, B * B - A * C));
    double d = R > 0 ? (B > 0 ? C / (B + root) : (B - root) / A) : (B > 0 ? (B + root) / A : C / (B - root));
    const double g = R - d + b - theta * (V - at(p, d)) / (R - d);
    const double slope = -1 - theta * (p.force + p.slope * d - (V - at(p, d)) / (R - d)) / (d - R);
    if (slope < 0 && std::isfinite(g / slope)) d -= g / slope;
    const double r = R - std::max(d, 0.0);
    return {r, std::max(0.0, (V - at(p, R - r)) / r)};
}

}  // namespace jvari

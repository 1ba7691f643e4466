// Contacts of any exponent without iteration: the potential is replaced by one that is quadratic piece by piece and once differentiable,
// whose discrete gradient is found in a bounded number of operations (Bhanuprakash, van Walstijn & Chatziioannou 2024, DAFx). With V~' the
// straight lines between the points (eta_j, V'(eta_j)), and r + b = theta [V~(eta) - V~(eta - r)]/r as in contact.hpp:
//
//     1. out and leaving (the new depth is 0) as there;
//     2. else the piece of the new depth x = eta - r by bisection over the points, as r + b - theta [...]/r grows with r: some ten
//     halvings;
//     3. in it a quadratic, or where eta lies in it as well a division; one step of Newton's method takes off the rounding.
//
// The points are even in each octave of depth, from 2^-60 m on, as many as the tolerance of the force asks for: with m in an octave the
// force errs by (alpha^2 - alpha)/(8 m^2) at most. Exponent 1 is exact. The energy balance is exact with V~ for V. Several contacts: in
// turn. Option `law_tolerance`: the largest relative error of the force (1e-3); fact `law_misfit`.
#pragma once

#include "schemes/contact/rigid_rule.hpp"
#include "schemes/contact/solve_in_turn.hpp"
#include "schemes/making.hpp"

namespace jvari {

inline constexpr Option law_tolerance_option{"law_tolerance", "1e-3", "largest relative error of the contact's force by its pieces"};

class PiecewiseLaw {
public:
    PiecewiseLaw() = default;
    PiecewiseLaw(const ContactLaw&, double tolerance);
    double potential(double eta) const;  // V~ [J]
    double misfit() const { return misfit_; }
    ContactSolution solve(double eta, double b, double theta) const noexcept;

private:
    struct Piece {
        double eta = 0, force = 0, potential = 0, slope = 0;  // of its beginning [m], [N], [J]; V~'' in it [N/m]
    };
    int piece_of(double eta) const;  // eta > 0
    double at(const Piece& p, double d) const { return p.potential + (p.force + 0.5 * p.slope * d) * d; }
    static constexpr int octaves = 64, lowest = -60;
    int per_octave_ = 1;
    double misfit_ = 0;
    std::vector<Piece> pieces_;  // from depth 0 on; the last goes on for ever
};

class PiecewiseRule : public PlainRule {
public:
    static constexpr bool conserves = true;
    static constexpr Option options[] = {law_tolerance_option};
    using Rigid = RigidRule;

    PiecewiseRule(std::span<const ContactLaw> laws, std::span<const double> theta, int) : PlainRule(laws, theta) { by(1e-3); }
    void choose(const Settings& settings) {
        const double tolerance = number_option(settings, law_tolerance_option);
        if (!(tolerance >= 1e-6 && tolerance <= 1)) throw Refusal("option law_tolerance: expected a number from 1e-6 to 1");
        by(tolerance);
    }
    GramSolution solve(const BeforeStep& at, double* r, double* force) noexcept {
        const std::size_t n = pieces_.size();
        if (n == 1) {
            const ContactSolution s = pieces_[0].solve(at.older[0], at.b[0], theta_[0]);
            *r = s.r;
            *force = s.force;
            return {};
        }
        return solve_in_turn(theta_, at.b, n, r, force,
                             [&](std::size_t a, double b) { return pieces_[a].solve(at.older[a], b, theta_[a * n + a]).force; });
    }
    double potential(int a, double eta) const { return pieces_[a].potential(eta); }
    std::vector<Fact> facts() const { return {{facts::law_misfit, pieces_.empty() ? 0 : pieces_.front().misfit()}}; }

private:
    void by(double tolerance) {
        pieces_.clear();
        for (const ContactLaw& law : laws_) pieces_.emplace_back(law, tolerance);
    }
    std::vector<PiecewiseLaw> pieces_;
};

}  // namespace jvari

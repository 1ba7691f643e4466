// Points whose contact forces are known before the step, F_a = V_a'(eta_a^n), for the three-point recursion: a conditionally stable
// control. What depends on the step to come is linear and solved for: the thread, which takes the mean of the outer levels, and contacts
// that lose energy (Hunt-Crossley), which pull by D r more, D = beta V'(eta^n)/span. With S the resistances of those points and r = y^{n+1}
// - y^{n-1},
//
//     r = free + Theta F,   F = F_0 - S r,   so   (I + S^1/2 Theta S^1/2) x = S^1/2 (free + Theta F_0),   x = S^1/2 r
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/contact/contact.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

class ExplicitPoints {
public:
    ExplicitPoints() = default;
    // theta [m/N]: row-major over the points, the contacts first and then the thread. span: between the outer levels [s].
    ExplicitPoints(std::span<const ContactLaw>, std::span<const double> heights, const std::optional<Thread>&,
                   std::span<const double> theta, double span, std::span<const double> contact_loss);

    // Readings of two levels and `free` r [m] in, forces on the string [N] out. The first half step, from rest, has the two outer levels in
    // one and gives half the forces.
    bool first(const double* now, const double* free, double* force) noexcept;
    bool next(const double* now, const double* older, const double* free, double* force) noexcept;

    double potential(const double* reading) const;  // [J]
    double loss(double r_c) const;                  // of the last step [W], the thread's reading moved by r_c
    void clear();
    std::vector<Fact> facts() const;

private:
    bool solve(const double* now, const double* outer, double share, const double* free, double* force) noexcept;

    std::vector<ContactLaw> laws_;
    std::vector<double> heights_, beta_, theta_;
    std::optional<Thread> thread_;
    double span_ = 1, lost_ = 0;                      // [s], by the contacts in the last step [J]
    std::vector<double> resist_, root_, x_, matrix_;  // S [N/m], its root, the unknowns, I + S^1/2 Theta S^1/2 and its factor
    std::vector<int> held_;                           // points with S > 0
    ForceRange range_;
    double deepest_ = 0;
};

}  // namespace jvari

// Steps the ladder in compliance.hpp, which stands in series with a string's points and represents
// the cut modes, exactly under forces that are lines in the step (docs/two-moments.md, section 4).
//
// In the patterns V_k, in which the cut modes' compliance and inertia are both diagonal, the ladder
// separates: with w_k = C V_k/(V_k.C V_k), c_k = V_k.C V_k and u_k = w_k.F
//
//     R_k (d_k' - v_k) = M_k v_k' = u_k - d_k/c_k,       D = sum of w_k d_k                     (4)
//
// Each pattern is stepped by the exponential of its matrix. The points read w_k r_k, with the
// moments r_k0 = d(H) - d(0) and r_k1 of d'. Stored: d^2/2c + M v^2/2. Lost: int (u - d/c)^2/R dt,
// a quadratic form in d, v and u.
#pragma once

#include <array>
#include <vector>

#include "schemes/contact/compliance.hpp"

namespace jvari {

class ExactLadder {
public:
    // Ladder for a string exact in time (MissingMatrix::ladder without a step); span: H [s]
    ExactLadder(const MissingMatrix&, double span);

    struct Pattern {
        double c = 0, mass = 0;  // [m/N], [kg]
        // rows r_0, r_1 and the change in v: from d, v, u_0, u_1
        std::array<std::array<double, 4>, 3> by = {};
        std::array<std::array<double, 4>, 4> loss = {};  // lost = x' loss x, x = (d, v, u_0, u_1)
    };
    int points() const { return points_; }
    const Pattern& pattern(int k) const { return patterns_[static_cast<std::size_t>(k)]; }
    double w(int k, int p) const { return w_[static_cast<std::size_t>(k) * points_ + p]; }

    // x: d for each pattern, then v for each. force: means for the points, then first moments.
    void rest(const double* force, double* x) const noexcept;  // under steady forces [N]
    double yields(const double* x, int p) const noexcept;      // D at a point [m]
    // C^-1 D: the springs' push, under which a steady force would yield equally [N]
    void forces(const double* x, double* out) const noexcept;
    double stored(const double* x) const noexcept;  // [J]
    // in a step from x [J]
    double lost(const double* x, const double* force) const noexcept;

private:
    int points_;
    std::vector<Pattern> patterns_;  // one per point
    std::vector<double> w_, push_;   // pattern by pattern; push_: V_k/c_k [N/m]
};

}  // namespace jvari

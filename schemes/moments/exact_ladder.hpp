// The ladder of compliance.hpp, which stands in series with a string's points for the modes that
// are cut, exact under forces that are lines in the step (docs/two-moments.md, section 4).
//
// In the patterns V_k of the points, in which compliance and inertia of the cut modes are both
// diagonal, it falls apart: with w_k = C V_k/(V_k.C V_k), c_k = V_k.C V_k and u_k = w_k.F
//
//     R_k (d_k' - v_k) = M_k v_k' = u_k - d_k/c_k,       D = sum of w_k d_k                     (4)
//
// Each is stepped by the exponential of its matrix; what the points read of it is w_k r_k, with the
// moments r_k0 = d(H) - d(0) and r_k1 of d'. Stored: d^2/2c + M v^2/2. Lost: int (u - d/c)^2/R dt, a
// quadratic form of d, v and u.
#pragma once

#include <array>
#include <vector>

#include "schemes/contact/compliance.hpp"

namespace jvari {

class ExactLadder {
public:
    // of a string that is exact in time (MissingMatrix::ladder without a step); span: H [s]
    ExactLadder(const MissingMatrix&, double span);

    struct Pattern {
        double c = 0, mass = 0;  // [m/N], [kg]
        // rows r_0, r_1 and the change of v: of d, v, u_0, u_1
        std::array<std::array<double, 4>, 3> by = {};
        std::array<std::array<double, 4>, 4> loss = {};  // lost = x' loss x, x = (d, v, u_0, u_1)
        double d = 0, v = 0;                             // [m], [m/s]
        double free[2] = {};                             // r without forces
        std::array<double, 4> before = {};               // x of the last step
    };

    int points() const { return points_; }
    // adds to Theta, row-major over means and then first moments [m/N]
    void add_compliance(std::vector<double>& theta) const;

    void rest(const double* force) noexcept;  // under steady forces of the points [N]
    void start_from(const ExactLadder& before) noexcept;
    double yields(int p) const noexcept {  // D [m]
        double sum = 0;
        for (std::size_t k = 0; k < patterns_.size(); ++k) sum += w(k, p) * patterns_[k].d;
        return sum;
    }
    // C^-1 D: what the springs push with, where a steady force would yield as much [N]
    void forces(double* out) const noexcept;

    // Adds the moments of its motion without forces: means at r, first moments at r + points.
    template <int few>
    [[gnu::always_inline]] void add_free(double* r) noexcept {
        const int n = few > 0 ? few : points_;
        for (int k = 0; k < n; ++k) {
            Pattern& s = patterns_[static_cast<std::size_t>(k)];
            for (int i = 0; i < 2; ++i) {
                s.free[i] = s.by[i][0] * s.d + s.by[i][1] * s.v;
                for (int p = 0; p < n; ++p) r[i * n + p] += w_[k * n + p] * s.free[i];
            }
        }
    }
    template <int few>
    [[gnu::always_inline]] void step(const double* force) noexcept {  // means, then first moments
        const int n = few > 0 ? few : points_;
        for (int k = 0; k < n; ++k) {
            Pattern& s = patterns_[static_cast<std::size_t>(k)];
            double u_0 = 0, u_1 = 0;
            for (int p = 0; p < n; ++p) {
                u_0 += w_[k * n + p] * force[p];
                u_1 += w_[k * n + p] * force[n + p];
            }
            s.before = {s.d, s.v, u_0, u_1};
            s.v += s.by[2][0] * s.d + s.by[2][1] * s.v + s.by[2][2] * u_0 + s.by[2][3] * u_1;
            s.d += s.free[0] + s.by[0][2] * u_0 + s.by[0][3] * u_1;
        }
    }
    double stored() const noexcept;  // [J]
    double lost() const noexcept;    // in the last step [J]

private:
    double w(std::size_t k, int p) const { return w_[k * static_cast<std::size_t>(points_) + p]; }

    int points_;
    std::vector<Pattern> patterns_;  // as many as points
    std::vector<double> w_, V_;      // pattern by pattern
};

}  // namespace jvari

// What a string lacks at its points, as a step has it: C with a ladder beside it (compliance.hpp), by the rule at midpoints (obstacle.hpp).
//
// The ladder stands for the energy that the cut modes carry away. C alone would keep all of a blow, and alternate from step to step for
// ever.
#pragma once

#include <span>
#include <vector>

#include "schemes/contact/compliance.hpp"

namespace jvari {

struct Residual {
    std::size_t points = 0;
    std::vector<double> C, W, K;  // points x points [m/N], [1], [m/N]
    std::vector<Ladder> ladder;   // of each point
    double span = 1;              // of a step [s]

    Residual() = default;
    Residual(const MissingMatrix&, double span);

    static double times(const std::vector<double>& m, std::size_t a, const double* x, std::size_t n) {
        double sum = 0;
        for (std::size_t b = 0; b < n; ++b) sum += m[a * n + b] * x[b];
        return sum;
    }
    double yield(std::size_t a, const double* P) const { return times(C, a, P, points); }  // D of point a [m]
    double stored(const double* P, const double* v) const {                                // [J]
        double sum = 0;
        for (std::size_t a = 0; a < points; ++a) sum += 0.5 * (P[a] * yield(a, P) + ladder[a].mass * v[a] * v[a]);
        return sum;
    }
};

// A ladder over a step: with D+ - D = K (F - C^-1 D + branch v) its mass takes up `share` of what it lags behind.
struct LadderStep {
    double damper = 0, branch = 0;  // [kg/s]
    double share = 0, mass = 0;     // [1], [kg]
    double mobility = 0;            // 1/resistance of the branch [s/kg]
    double span = 1;                // [s]

    LadderStep() = default;
    LadderStep(const Ladder& l, double span_) : damper(l.damper), branch(l.branch(2 / span_)), mass(l.mass), span(span_) {
        if (mass > 0) share = branch * span / mass, mobility = 1 / l.resistance;
    }
    void follow(double moved, double& v) const { v += share * (moved / span - v); }
    double lost(double moved, double v) const {  // in a step, of v before it [J]
        const double behind = moved / span - v;
        return damper * moved * moved / span + branch * span * (1 - 0.5 * share) * behind * behind;
    }
};

// The same of one contact b and a thread c, either of which may be absent, with its state: D, v, and H = W' D - K branch v of the next
// step, which D+ - D = K F - H.
struct ResidualPair {
    double C_be = 0, C_ce = 0;            // on b and c, of the pluck [m/N]
    double K_bb = 0, K_bc = 0, K_cc = 0;  // [m/N]
    double W_bb = 0, W_bc = 0, W_cb = 0, W_cc = 0;
    double C_bb = 0, C_bc = 0, C_cc = 0;              // [m/N]
    double stiff_bb = 0, stiff_bc = 0, stiff_cc = 0;  // C^-1 [N/m]
    LadderStep b_, c_;
    double D_b = 0, D_c = 0, v_b = 0, v_c = 0, H_b = 0, H_c = 0;  // [m], [m/s]; change from step to step

    ResidualPair() = default;
    ResidualPair(const MissingMatrix&, double span);
    void clear() { D_b = D_c = v_b = v_c = H_b = H_c = 0; }
    double P_b() const { return stiff_bb * D_b + stiff_bc * D_c; }  // of the springs [N]
    double P_c() const { return stiff_bc * D_b + stiff_cc * D_c; }
    double stored() const { return 0.5 * (P_b() * D_b + P_c() * D_c + b_.mass * v_b * v_b + c_.mass * v_c * v_c); }  // [J]
    template <bool b = true, bool c = true>
    [[gnu::always_inline]] void take(double F_b, double F_c) {
        if constexpr (b) {
            const double moved = K_bb * F_b - H_b + (c ? K_bc * F_c : 0);
            D_b += moved;
            b_.follow(moved, v_b);
        }
        if constexpr (c) {
            const double moved = K_cc * F_c - H_c + (b ? K_bc * F_b : 0);
            D_c += moved;
            c_.follow(moved, v_c);
        }
        const double B_b = b ? b_.branch * v_b : 0, B_c = c ? c_.branch * v_c : 0;
        if constexpr (b) H_b = W_bb * D_b - K_bb * B_b + (c ? W_cb * D_c - K_bc * B_c : 0);
        if constexpr (c) H_c = W_cc * D_c - K_cc * B_c + (b ? W_bc * D_b - K_bc * B_b : 0);
    }
    double lost(double F_b, double F_c) const {  // in the step that they are taken for, before they are [J]
        return b_.lost(K_bb * F_b + K_bc * F_c - H_b, v_b) + c_.lost(K_bc * F_b + K_cc * F_c - H_c, v_c);
    }
};

}  // namespace jvari

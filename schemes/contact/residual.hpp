// What a string lacks at its points, as a step has it: C with the dampers R beside it, by the rule at midpoints (obstacle_step.hpp).
//
// R stands for the energy that the cut modes carry away. C alone would keep all of a blow, and alternate from step to step for ever.
#pragma once

#include <span>
#include <vector>

#include "schemes/contact/compliance.hpp"

namespace jvari {

struct Residual {
    std::size_t points = 0;
    std::vector<double> C, W, K;  // points x points [m/N], [1], [m/N]
    std::vector<double> R;        // of each point [kg/s]
    double span = 1;              // of a step [s]

    Residual() = default;
    Residual(const MissingMatrix&, double span);

    static double times(const std::vector<double>& m, std::size_t a, const double* x, std::size_t n) {
        double sum = 0;
        for (std::size_t b = 0; b < n; ++b) sum += m[a * n + b] * x[b];
        return sum;
    }
    double yield(std::size_t a, const double* P) const { return times(C, a, P, points); }  // D of point a [m]
    double stored(const double* P) const {                                                 // [J]
        double sum = 0;
        for (std::size_t a = 0; a < points; ++a) sum += 0.5 * P[a] * yield(a, P);
        return sum;
    }
    double lost_in(const double* change) const {  // change: F - P [N]; in a step [J]
        double sum = 0;
        for (std::size_t a = 0; a < points; ++a) {
            const double moved = times(K, a, change, points);
            sum += R[a] * moved * moved / span;
        }
        return sum;
    }
};

// The same of one contact b and a thread c, either of which may be absent, with its state: D = C P and H = K P. With V = K W, which is
// symmetric like K, a step of the mean forces F makes D+ = D - H + K F and H+ = H - W' H + V F.
struct ResidualPair {
    double C_be = 0, C_ce = 0;            // on b and c, of the pluck [m/N]
    double K_bb = 0, K_bc = 0, K_cc = 0;  // [m/N]
    double V_bb = 0, V_bc = 0, V_cc = 0;  // [m/N]
    double W_bb = 0, W_bc = 0, W_cb = 0, W_cc = 0;
    double C_bb = 0, C_bc = 0, C_cc = 0;              // [m/N]
    double R_b = 0, R_c = 0;                          // over the span [N/m]
    double stiff_bb = 0, stiff_bc = 0, stiff_cc = 0;  // C^-1 [N/m]
    double D_b = 0, D_c = 0, H_b = 0, H_c = 0;        // [m]; change from step to step

    ResidualPair() = default;
    ResidualPair(const MissingCompliance&, double span);
    void clear() { D_b = D_c = H_b = H_c = 0; }
    double P_b() const { return stiff_bb * D_b + stiff_bc * D_c; }  // of the springs [N]
    double P_c() const { return stiff_bc * D_b + stiff_cc * D_c; }
    double stored() const { return 0.5 * (P_b() * D_b + P_c() * D_c); }  // [J]
    template <bool b = true, bool c = true>
    [[gnu::always_inline]] void take(double F_b, double F_c) {
        const double h_b = H_b, h_c = H_c;
        if constexpr (b) D_b += K_bb * F_b - h_b + (c ? K_bc * F_c : 0);
        if constexpr (c) D_c += K_cc * F_c - h_c + (b ? K_bc * F_b : 0);
        if constexpr (b) H_b += V_bb * F_b - W_bb * h_b + (c ? V_bc * F_c - W_cb * h_c : 0);
        if constexpr (c) H_c += V_cc * F_c - W_cc * h_c + (b ? V_bc * F_b - W_bc * h_b : 0);
    }
    double lost(double F_b, double F_c) const {  // in the step that they are taken for, before they are [J]
        const double b = K_bb * F_b + K_bc * F_c - H_b, c = K_bc * F_b + K_cc * F_c - H_c;  // D+ - D
        return R_b * b * b + R_c * c * c;
    }
};

}  // namespace jvari

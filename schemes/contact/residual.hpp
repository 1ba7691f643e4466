// What a string lacks at its points, as a step has it: C with a ladder beside it (compliance.hpp),
// by the rule at midpoints (obstacle.hpp).
//
// The ladder stands for the energy that the cut modes carry away.
// C alone would keep all of a blow, and alternate from step to step for ever.
#pragma once

#include <span>
#include <vector>

#include "schemes/contact/compliance.hpp"

namespace jvari {

// A mass of the ladder over a step: while its pattern moves by `moved` it takes up `share` of what
// it lags behind.
struct MassStep {
    double branch = 0;           // 1/(1/resistance + span/(2 mass)) [kg/s]
    double share = 0, mass = 0;  // [1], [kg]
    double span = 1;             // [s]

    MassStep() = default;
    MassStep(double mass_, double resistance, double span_) : mass(mass_), span(span_) {
        if (mass > 0)
            branch = 1 / (1 / resistance + 0.5 * span / mass), share = branch * span / mass;
    }
    void follow(double moved, double& v) const { v += share * (moved / span - v); }
    double lost(double moved, double v) const {  // in a step, of v before it [J]
        const double behind = moved / span - v;
        return branch * span * (1 - 0.5 * share) * behind * behind;
    }
};

struct Residual {
    std::size_t points = 0;
    std::vector<double> C, W, K;   // points x points [m/N], [1], [m/N]
    std::vector<double> damper;    // points x points: what resists without masses [kg/s]
    std::vector<double> V;         // patterns x points [1]
    std::vector<MassStep> masses;  // of each pattern

    Residual(const MissingMatrix&, double span);

    static double times(const std::vector<double>& m, std::size_t a, const double* x,
                        std::size_t n) {
        double sum = 0;
        for (std::size_t b = 0; b < n; ++b) sum += m[a * n + b] * x[b];
        return sum;
    }
    // D of point a [m]
    double yield(std::size_t a, const double* P) const { return times(C, a, P, points); }
    // at point a by what moves with v [N]
    double pulled(std::size_t a, const double* v, std::size_t n) const {
        double sum = 0;
        for (std::size_t k = 0; k < n; ++k) sum += V[k * n + a] * masses[k].branch * v[k];
        return sum;
    }
    double damped(const double* speed, std::size_t n) const {  // by the damper without masses [W]
        double sum = 0;
        for (std::size_t a = 0; a < n; ++a) sum += speed[a] * times(damper, a, speed, n);
        return sum;
    }
    double stored(const double* P, const double* v) const {  // [J]
        double sum = 0;
        for (std::size_t a = 0; a < points; ++a)
            sum += 0.5 * (P[a] * yield(a, P) + masses[a].mass * v[a] * v[a]);
        return sum;
    }
};

// The same of one contact b and a thread c, either of which may be absent, with its state: D, v of
// the patterns, and H of the next step, in which D+ - D = K F - H.
struct ResidualPair {
    double C_be = 0, C_ce = 0;            // on b and c, of the pluck [m/N]
    double K_bb = 0, K_bc = 0, K_cc = 0;  // [m/N]
    double W_bb = 0, W_bc = 0, W_cb = 0, W_cc = 0;
    double C_bb = 0;                                     // [m/N]
    double stiff_bb = 0, stiff_bc = 0, stiff_cc = 0;     // C^-1 [N/m]
    double damper_bb = 0, damper_bc = 0, damper_cc = 0;  // [kg/s]
    // of the patterns; one that is alone is 1
    double b_[2] = {}, c_[2] = {};
    MassStep m_[2];                                         // of the patterns
    double D_b = 0, D_c = 0, v_[2] = {}, H_b = 0, H_c = 0;  // [m], [m/s]; change from step to step

    ResidualPair() = default;
    ResidualPair(const MissingMatrix&, double span);
    void clear() { D_b = D_c = v_[0] = v_[1] = H_b = H_c = 0; }
    double P_b() const { return stiff_bb * D_b + stiff_bc * D_c; }  // of the springs [N]
    double P_c() const { return stiff_bc * D_b + stiff_cc * D_c; }
    double stored() const {  // [J]
        return 0.5 * (P_b() * D_b + P_c() * D_c + m_[0].mass * v_[0] * v_[0] +
                      m_[1].mass * v_[1] * v_[1]);
    }
    template <bool b = true, bool c = true>
    [[gnu::always_inline]] void take(double F_b, double F_c) {
        constexpr bool both = b && c;
        const double moved_b = b ? K_bb * F_b - H_b + (c ? K_bc * F_c : 0) : 0,
                     moved_c = c ? K_cc * F_c - H_c + (b ? K_bc * F_b : 0) : 0;
        D_b += moved_b, D_c += moved_c;
        double pulls[2];
        for (int k = 0; k < 1 + both; ++k) {
            m_[k].follow(both ? b_[k] * moved_b + c_[k] * moved_c : moved_b + moved_c, v_[k]);
            pulls[k] = m_[k].branch * v_[k];
        }
        const double B_b = both ? b_[0] * pulls[0] + b_[1] * pulls[1] : pulls[0];
        const double B_c = both ? c_[0] * pulls[0] + c_[1] * pulls[1] : pulls[0];
        if constexpr (b) H_b = W_bb * D_b - K_bb * B_b + (c ? W_cb * D_c - K_bc * B_c : 0);
        if constexpr (c) H_c = W_cc * D_c - K_cc * B_c + (b ? W_bc * D_b - K_bc * B_b : 0);
    }
    // in the step that they are taken for, before they are [J]
    double lost(double F_b, double F_c) const {
        const double b = K_bb * F_b + K_bc * F_c - H_b, c = K_bc * F_b + K_cc * F_c - H_c;
        double sum = (damper_bb * b * b + 2 * damper_bc * b * c + damper_cc * c * c) / m_[0].span;
        for (int k = 0; k < 2; ++k) sum += m_[k].lost(b_[k] * b + c_[k] * c, v_[k]);
        return sum;
    }
};

}  // namespace jvari

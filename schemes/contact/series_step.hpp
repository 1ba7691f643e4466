// One step of two time levels for a string's barrier and thread with a compliance in series (series_points.hpp): van Walstijn et al. 2016,
// eqs 43-48, with the thread's own displacement Y_c as one state more. docs/compliance-matching.md derives it and its energy balance.
//
// Over a step of length `span`, with s_z = y_z^{n+1} - y_z^n = u_z + theta_zb F_b + theta_zc F_c and r = r_c/span + k_c/2,
//     F_b = -[Phi(zeta^{n+1}) - Phi(zeta^n)]/(...),  F_c = mean(Y_c - y_c)/C_cc - e F_b,  r (Y_c^{n+1} - Y_c^n) = -F_c - k_c (Y_c - h_c).
// The last two give F_c = v - beta F_b, and the first the scalar equation of contact.hpp with
//     b = -(w of F_b = 0),  theta = theta_bb - beta w_v - e theta_bc.
// The damper takes the value that lets Y_c relax by exp(-kappa span/r_c) a step, as in continuous time and as eq 33 replaces the
// coefficients of the modes; kappa = k_c + 1/(C_cc + theta_cc/2), the string giving way as it does within a step.
#pragma once

#include "schemes/contact/series_points.hpp"

namespace jvari {

struct SeriesStep {
    SeriesPoints points;
    double theta = 0, theta_bc = 0, theta_cc = 0;                  // [m/N]; theta as above
    double inverse_delta = 0, inverse_r = 0, relax = 0, beta = 0;  // relax = k_c/(2 r)
    double w_v = 0, w_Y = 0;
    double damping = 0;      // of the thread as replaced, over span [N/m]
    double overdamping = 0;  // what the replaced damper has beyond r_c, as slow motion feels it [kg/s]
    double fresh = 1;        // share of its distance from rest at which Y_c starts, see start()

    SeriesStep() = default;
    SeriesStep(const SeriesPoints& p, double theta_bb, double bc, double cc, double span) : points(p), theta_bc(bc), theta_cc(cc) {
        if (p.thread && p.r_c > 0) {
            const double kappa = p.k_c + 1 / (p.C_cc + 0.5 * cc), a = kappa * span / p.r_c;
            damping = 0.5 * kappa / std::tanh(0.5 * a);
            inverse_r = 1 / (damping + 0.5 * p.k_c);
            fresh = 2 / a * std::tanh(0.5 * a);
            const double drawn = 1 / (1 + p.k_c * p.C_cc);  // Y_c - h_c per y_c - h_c when nothing is in a hurry
            overdamping = (damping * span - p.r_c) * drawn * drawn;
        }
        if (p.thread) inverse_delta = 1 / (p.C_cc + 0.5 * cc + 0.5 * inverse_r);
        relax = 0.5 * p.k_c * inverse_r;
        beta = (p.e * p.C_cc + 0.5 * bc) * inverse_delta;
        w_v = bc - p.e * (inverse_r + cc);
        w_Y = -p.e * p.k_c * inverse_r;
        theta = theta_bb - beta * w_v - p.e * bc;
    }

    // Y_c - h_c at rest at t = 0: where the string is, scaled so that the first step has the impulse of the exact relaxation.
    double start(double y_c) const {
        if (points.r_c == 0) return 0;
        const double Y = y_c - points.h_c, steady = Y / (1 + points.k_c * points.C_cc);
        return steady + (Y - steady) * fresh;
    }

    // The parts of a step, in their order.
    double pull(double D, double u_c, double Y) const { return (D - 0.5 * u_c - relax * Y) * inverse_delta; }               // v
    double approach(double u_b, double u_c, double v, double Y) const { return points.e * u_c - u_b - w_v * v - w_Y * Y; }  // b
    double moved(double F_c, double Y) const { return -(F_c + points.k_c * Y) * inverse_r; }
};

}  // namespace jvari

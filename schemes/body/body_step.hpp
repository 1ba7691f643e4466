// One step of all strings of an instrument together with the body on which their ends at x = 0
// rest. Derived here, after the usual mode synthesis of a moving support (Debut, Antunes, Marques &
// Carvalho 2014) and the contact equation of van Walstijn et al. 2016, eqs 44-48.
//
// The support moves by w = sum_k z_k, M_k z_k'' + R_k z_k' + K_k z_k = f, one oscillator per body
// mode, and a string by
//
//     u(x, t) = v(x, t) + psi(x) w(t),   psi = 1 - x/L,
//
// v with both ends at rest. psi is straight, so tension and bending stiffness do not couple v and
// w: the potential is v's own and T w^2/2L. The inertia does couple them. With mu_i the integral of
// mu psi over the weight of v's i-th coordinate (mode or node), the kinetic energy is v's own, w'
// sum_i mu_i v_i', and mu L w'^2/6. String losses act on v. So
//
//     the coordinate i feels  -mu_i w'',
//     the body feels
//     f = -sum over strings [ sum_i mu_i v_i'' + (mu L/3) w'' + (T/L) w ]
//         + sum_p e_p F_p + sum psi(x_e) F_e.
//
// Barriers and thread, which press on a string, ride on the support. Each reads u(x_p) - w = v(x_p)
// + e_p w, e_p = -x_p/L, and acts by the same weights. The player's finger and the nut do not ride.
//
// In steps. Whatever the scheme, a force F_p moves the reading at point q by theta_qp F_p from the
// older to the newer level. It moves the acceleration sum_i mu_i v_i'' by theta_mp F_p/kappa, where
// m is the body as one more point, with weights mu_i; kappa = dt^2/2 in two-point schemes, dt^2 in
// three-point ones. With the difference of velocities over dt for all of v'' and w'', the two works
// of the coupling add up to the difference in w' sum mu_i v_i': the energy closes. For a = w'' and
// r, the increment of w, the body's own scheme says
//
//     r = r_0 + beta f,   a = a_0 + (beta/kappa) f,   beta = sum_k of what a unit of f adds to r,
//
// and eliminating f leaves the contact equation of one large string:
//
//     f = f_0 + sum_p c_p F_p/D,   c_p = e_p - theta_mp/kappa,
//     Theta_pq = theta_pq + beta c_p c_q/D,
//     D = 1 + beta [ sum T/2L + sum (mu L/3 - theta_mm/kappa)/kappa ].
//
// So the driver (driver/driver.hpp) treats the strings like one string with the points of all
// strings, contacts first.
#pragma once

#include <vector>

#include "schemes/driver/string_step.hpp"

namespace jvari {

struct BodyMotion {  // without f
    double w = 0;    // at the older level [m]
    // at the step's central level; in two-point steps at the older one [m]
    double now = 0;
    double r = 0;  // from the older to the newer level [m]
    double a = 0;  // w'' [m/s^2]
};
struct BodyMoved {           // in a step
    double r = 0, lost = 0;  // from the older to the newer level [m]; by the body's losses [J]
};

class BodyStep {
public:
    BodyStep() = default;
    // place: for each point on each string, its index among all points. beta [m/N], kappa [s^2].
    BodyStep(const std::vector<StringPoints>&, const std::vector<std::vector<int>>& place,
             double beta, double kappa);

    // between all points, with the body [m/N]
    const std::vector<double>& theta() const { return theta_; }
    double rides(int p) const { return e_[p]; }

    // Turns readings of v and increments without forces into the points' own [m]. inertia: sum mu_i
    // v_i'' over all strings without point and body forces; pluck: sum psi(x_e) F_e.
    void approach(double inertia, double pluck, const BodyMotion&, double* older, double* now,
                  double* free) noexcept;
    void pass(const double* force) noexcept;
    double f() const { return f_; }  // in that step [N]
    double a() const { return a_; }  // w'' [m/s^2]

    // energy of the tension [J]
    double potential(double w) const { return 0.5 * stiffness_ * w * w; }
    // for the ends' share, momentum = sum mu_i v_i' [J]
    double kinetic(double velocity, double momentum) const {
        return (0.5 * inertia_ * velocity + momentum) * velocity;
    }

private:
    double beta_ = 0, kappa_ = 1, D_ = 1;
    // sum mu L/3, the same less theta_mm/kappa [kg]; sum T/L [N/m]
    double inertia_ = 0, rest_mass_ = 0, stiffness_ = 0;
    std::vector<double> e_, to_body_, c_;  // for each point: e_p, theta_pm, c_p
    std::vector<double> theta_;
    double f_ = 0, a_ = 0;
};

}  // namespace jvari

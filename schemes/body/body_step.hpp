// One step of all strings of an instrument together with the body that their ends at x = 0 rest on. Derived here, after the usual mode
// synthesis of a support that moves (Debut, Antunes, Marques & Carvalho 2014) and the contact equation of van Walstijn et al. 2016, eqs
// 44-48.
//
// The support moves by w = sum_k z_k, M_k z_k'' + R_k z_k' + K_k z_k = f, one oscillator per mode of the body, and a string by
//
//     u(x, t) = v(x, t) + psi(x) w(t),   psi = 1 - x/L,
//
// v with both ends at rest. psi is straight, so tension and bending stiffness do not couple v and w: the potential is that of v and T
// w^2/2L. The inertia does. With mu_i the integral of mu psi over the weight of the i-th coordinate of v (mode or node), the kinetic energy
// is that of v, w' sum_i mu_i v_i', and mu L w'^2/6. Losses of the string are those of v. So
//
//     the coordinate i feels  -mu_i w'',
//     the body feels      f = -sum over strings [ sum_i mu_i v_i'' + (mu L/3) w'' + (T/L) w ] + sum_p e_p F_p + sum psi(x_e) F_e.
//
// All that presses on a string, its barriers and its thread, rides on the support: it reads u(x_p) - w = v(x_p) + e_p w, e_p = -x_p/L, and
// acts by the same weights. The player's finger and the nut do not.
//
// In steps. Whatever the scheme, a force F_p moves the reading of the point q by theta_qp F_p from the older to the newer level, and the
// acceleration sum_i mu_i v_i'' by theta_mp F_p/kappa, where m is the body as one more point, of weights mu_i; kappa = dt^2/2 in two-point
// schemes, dt^2 in three-point ones. With the difference of velocities over dt for all of v'' and w'', the two works of the coupling add up
// to the difference of w' sum mu_i v_i': the energy closes. For a = w'' and r, the increment of w, the body's own scheme says
//
//     r = r_0 + beta f,   a = a_0 + (beta/kappa) f,   beta = sum_k of what a unit of f adds to r,
//
// and eliminating f leaves the contact equation of one large string:
//
//     f = f_0 + sum_p c_p F_p/D,   c_p = e_p - theta_mp/kappa,   Theta_pq = theta_pq + beta c_p c_q/D,
//     D = 1 + beta [ sum T/2L + sum (mu L/3 - theta_mm/kappa)/kappa ].
//
// Threads are linear and eliminated, all together; what is left are the contacts of all strings, coupled by the body, solved by the rule of
// discrete gradients (contact/gradient_rule.hpp).
#pragma once

#include <vector>

#include "schemes/contact/gradient_rule.hpp"
#include "schemes/driver/string_step.hpp"

namespace jvari {

struct BodyMotion {
    double w = 0;  // at the older level [m]
    double r = 0;  // from there to the newer one without f [m]
    double a = 0;  // w'' without f [m/s^2]
};

class BodyStep {
public:
    BodyStep() = default;
    BodyStep(const std::vector<StringPoints>&, double beta, double kappa, double span);  // beta [m/N], kappa [s^2], span [s]
    BodyStep halved() const;                                                             // the first of a three-point scheme, from rest

    // Readings of v at the older level and at that of the step's centre, and increments without forces, of every point of every string in
    // turn [m]; sum mu_i v_i'' over all strings without forces of points and body; sum psi(x_e) F_e. Out: the forces on the strings [N].
    // Allocates nothing.
    bool solve(const double* older, const double* now, const double* free, double inertia, double pluck, const BodyMotion&,
               double* force) noexcept;
    double f() const { return f_; }  // of that step [N]
    double a() const { return a_; }  // w'' [m/s^2]

    double potential(const double* reading, double w) noexcept;  // of points and tension at one level [J]
    double lost() const;                                         // per span by contacts and threads in that step [J/s]
    double kinetic(double velocity, double momentum) const {     // of the ends' share, momentum = sum mu_i v_i' [J]
        return (0.5 * inertia_ * velocity + momentum) * velocity;
    }
    int points() const { return static_cast<int>(e_.size()); }
    const Obstacle<GradientRule>& contacts() const { return contacts_; }
    void clear() { contacts_.clear(); }

private:
    struct Spring {  // a thread
        int point;
        double stiffness, damping, rest, s;  // s = k/2 + damping/span [N/m]
    };

    std::vector<StringPoints> strings_;
    double beta_ = 0, kappa_ = 1, span_ = 1, D_ = 1;
    double inertia_ = 0, rest_mass_ = 0, stiffness_ = 0;  // sum mu L/3, the same less theta_mm/kappa [kg]; sum T/L [N/m]
    std::vector<double> e_, to_body_, c_;                 // of each point: e_p, theta_pm, c_p
    std::vector<double> theta_;                           // points x points, with the body [m/N]
    std::vector<int> contact_;                            // the points that are contacts
    std::vector<Spring> thread_;                          //
    std::vector<double> yield_, follow_;                  // (1 + s Theta_tt)^-1, threads x threads; that s Theta_tb, threads x contacts
    Obstacle<GradientRule> contacts_;                     // the threads eliminated
    std::vector<double> older_, free_, pull_, at_, now_, b_, push_;  // workspaces
    std::vector<double> moved_;                                      // of each thread in the last step [m]
    double f_ = 0, a_ = 0;
};

}  // namespace jvari

// The motion of all strings of a scene on a body that moves, as first-order equations for an
// integrator: those of string_equations.hpp for every string, and the body's, coupled by the
// inertia that schemes/body/body_step.hpp derives. Per mode, of strings and of the body,
//
//     p_i' = omega_i v_i,   m_i v_i' = -m_i (omega_i p_i + 2 sigma_i v_i) + G_i - mu_i a,
//     sum over strings of (mu L/3 a + sum mu_i v_i') in G
//
// with a = w''. The mass matrix is diagonal but for the body's rank: with A_i the accelerations
// where the body is held and A_k those of the body where the strings are, b = sum 1/M_k and S = sum
// mu_i^2/m_i,
//
//     f = g - sum mu_i A_i - (sum mu L/3 - S) a,   a = sum A_k + b f,
//     g = -(sum T/L) w + sum e_p F_p + sum psi(x_e) F_e,
//
// one equation for a; then v_k' = A_k + f/M_k and v_i' = A_i - mu_i a/m_i.
#pragma once

#include <optional>

#include "reference/integrator.hpp"
#include "scenes/modes.hpp"
#include "schemes/contact/contact.hpp"

namespace jvari {

struct InstrumentEquations final : Equations {
    // Strings without profiles, and the modes of each.
    InstrumentEquations(const std::vector<String>&, const std::vector<Modes>&,
                        const std::vector<BodyMode>&);

    struct OfString {
        int first = 0, count = 0;  // its modes
        double mass = 0;           // of a mode [kg]
        std::vector<double> mu;    // [kg]
        std::optional<Pluck> pluck = {};
        std::vector<double> g_e = {};
        double finger = 0;  // psi where it is plucked
        bool plucked = false;
        int bridge = 0, thread = 0;  // of its impulses, among the sums
    };
    struct Point {
        int string;
        std::vector<double> g;
        double e;  // -x/L
        ContactLaw law;
        double beta, damping, height;
        bool clipped = false;
    };
    std::vector<OfString> strings;
    std::vector<Point> points;  // the contacts of all strings in turn, then the threads
    int body = 0;               // the first of its modes
    int sums = 0;               // 2 per string [N s], then supplied and dissipated [J]
    double time = 0;            // at t = 0 of the integrator [s]

    int size() const override { return 2 * padded + sums; }
    void slope(double t, const double* z, double* dz) const noexcept override;
    double penetration(int contact, const double* z) const noexcept override;
    double penetration_speed(int contact, const double* z) const noexcept override;
    double contact_force(int contact, const double* z) const noexcept override;
    double scale_squared(const double* z) const noexcept override;
    // of the modes without their coupling
    void solve(double, double gamma, const double* z, const double* b, double* x) noexcept override;

    double pace(const double* z) const noexcept;  // of the fastest motion [1/s]
    double energy(const double* z) const noexcept;
    double omega(int i) const { return omega_[i]; }
    double w(const double* z) const noexcept;
    double w_speed(const double* z) const noexcept;

private:
    struct Motion {
        double y, v;
    };
    Motion motion(const Point&, const double* z) const noexcept;
    struct Pull {
        double F, lost;  // [N], [W]
    };
    Pull pull(int point, Motion) const noexcept;
    bool acts(int point) const noexcept { return point >= contacts || touched[point]; }

    std::vector<double> omega_, damping_, mass_;              // omega0, 2 sigma, m of each mode
    double tension_ = 0, inertia_ = 0, rest_ = 0, give_ = 0;  // sum T/L, sum mu L/3, that less S, b
    double least_scale_ = 0;                                  // [m/s], of what the plucks make
    std::vector<double> compliance_;                          // of each point, sum g^2/m [1/kg]
};

}  // namespace jvari

// First-order equations for one string in its modes, for an integrator (van Walstijn et al. 2016,
// eqs 5-18; contact loss from Issanchou et al. 2016, eq 24). With p = omega0 y, every component is
// a velocity and energy is m/2 times their squares,
//
//     p_i' = omega0_i v_i,   v_i' = -omega0_i p_i - 2 sigma_i v_i + sum_a d_ai F_a,   d_ai = g_ai/m
// and, if the string stretches, minus EA L/8 beta_i^2/m sum (beta_j/omega0_j)^2 p_j^2 p_i/omega0_i
// (Kirchhoff, Carrier), which solve() leaves out of J.
//
//     F_a = k eta|eta|^(alpha-1) (1 - beta v_a) for a touched barrier, k_c (h_c - y_c)
//         - r_c v_c for the thread, F_e(t) for the pluck. With a clipped loss the factor 1 - beta v
//         is not negative, and the spring's work beyond that counts as lost.
//
// The set of touched barriers is given, not decided here: between two events the equations are
// smooth, and odd beyond the barrier's surface so that a trial step may overshoot. Four sums are
// integrated too: impulses of barriers and thread, energy supplied and dissipated. The Jacobian is
// 2x2 blocks plus one rank per force; (I - gamma J) x = b costs O(modes x forces) by Woodbury's
// formula.
//
// For a mass (masses.hpp) p = omega0 y with the string's first omega0, and no force pulls the mass
// back.
//
// The series compliance has its states behind the modes' v (series_states.hpp).
#pragma once

#include <vector>

#include "reference/integrator.hpp"
#include "reference/series_states.hpp"
#include "scenes/modes.hpp"
#include "schemes/contact/contact.hpp"

namespace jvari {

struct StringEquations final : Equations {
    // [N s], [N s], [J], [J]
    enum Sum { bridge_impulse, thread_impulse, supplied, dissipated, sums };

    StringEquations(const Modes&, const String&, const std::optional<InSeries>& = {});

    int points = 0;         // a thread is the last
    double pluck_time = 0;  // since the pluck's start, at t = 0 in the integrator's time [s]
    bool plucked = false;

    int size() const override { return 2 * padded + sums; }  // p, v, sums
    // the states in series, in their own units
    void read_series(const double* z, double* series) const noexcept;
    void put_series(const double* series, double* z) const noexcept;
    void slope(double t, const double* z, double* dz) const noexcept override;
    // eta [m]
    double penetration(int contact, const double* z) const noexcept override;
    // [m/s]
    double penetration_speed(int contact, const double* z) const noexcept override;
    // [N], whether touched or not
    double contact_force(int contact, const double* z) const noexcept override;
    // [J], for a barrier or the thread
    double potential(int point, double y) const noexcept;
    double scale(int mode) const noexcept { return omega_[mode]; }  // p = scale y
    // (beta/omega0)^2
    double reach(int mode) const noexcept { return reach_.empty() ? 0 : reach_[mode]; }
    // for the sum over reach p^2 [J]
    double stretching(double sum) const noexcept { return EA_ * length_ / 32 * sum * sum; }
    // Maximum of: sum over p^2 + v^2, the pressing forces' energy in barriers and thread, 2
    // potential/m, and a hundredth of the pluck's speed.
    double scale_squared(const double* z) const noexcept override;
    // Rounding for a string that starts in equilibrium, where nothing else moves: a contact's force
    // is known to K times the rounding of its height h. On the spring its point swings at omega =
    // sqrt(K sum g d), and mode i with it by eps h K d_i/omega.
    double rounding(const double* z) const noexcept override;
    // Rate bound for motion in contacts with this depth and speed [1/s]; decays: includes points
    // without mass.
    double pace(const double* z, bool decays = true) const noexcept;

    // (I - gamma J(z)) x = b
    void solve(double t, double gamma, const double* z, const double* b,
               double* x) noexcept override;

private:
    void make_workspaces();

    struct Point {
        ContactLaw law;
        double beta, r, height;
        bool clipped = false;
        double sign = 1;
    };
    // force at a point, F, and its derivatives -K to y, -R to v; drag: its loss is drag v^2
    struct Pull {
        double F, K, R, drag, drag_slope;
    };
    struct Motion {
        double y, v;
    };
    bool acts(int a) const noexcept { return a >= contacts || touched[a]; }
    Motion motion(int a, const double* z) const noexcept;
    Pull pull(int a, Motion) const noexcept;
    const double* row(const std::vector<double>& rows, int a) const noexcept {
        return rows.data() + static_cast<long>(a) * padded;
    }

    // w z, in series
    const double* states(const double* z) const noexcept { return z + padded + modes_; }
    double* states(double* z) const noexcept { return z + padded + modes_; }

    double mass_, EA_, length_;
    double least_scale_ = 0;  // from the pluck [m/s]
    int modes_, held_;        // with and without the masses
    bool rests_;              // at the start
    SeriesStates series_;
    std::vector<Point> point_;
    std::vector<Pluck> pluck_;                    // none or one
    std::vector<double> omega_, damping_, loss_;  // omega0, 2 sigma, 2 m sigma
    std::vector<double> falls_;                   // accelerations by weights [m/s^2]
    // (beta/omega0)^2; empty if the string does not stretch
    std::vector<double> reach_;
    std::vector<double> reads_, weights_, gains_;  // g/omega0, g, g/m [point, then the pluck][mode]

    double gamma_ = 0;  // gamma for the members below
    // 1/(1 + 2 gamma sigma + (gamma omega0)^2); S_ab = sum_i g_a d_b/that
    std::vector<double> inverse_, compliance_;
    std::vector<double> small_, force_;  // [point][point + 1], [point]
    std::vector<double> couples_;        // |g_a d_b| [contact][contact]
    mutable std::vector<Motion> motion_;
    mutable std::vector<Pull> pull_;
    mutable std::vector<double> stiffness_;  // [contact]
    // forces; speeds in the series compliance
    mutable std::vector<double> acting_, speed_, change_;
};

}  // namespace jvari

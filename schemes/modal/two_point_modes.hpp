// String in its modes by two-point steps: van Walstijn, Bridges & Mehes 2016, eqs 38-43, and 49,
// 51, 52 for its energy. In modes scaled by sqrt(J/xi)
//
//     s = u + sum_p g_p F_p,   y <- y + s,   u <- s + sum_p g_p F_p - loss s - c y;
//     r_p = g_p.s, Theta_pq = g_p.g_q
//
// which is one fused pass over the modes for one contact and a thread
// (kernels/modal_two_point_kernel.hpp). Here J = 1 + A + B, c = 4 A/J, loss = 2 B/J, xi = dt^2/2m,
// and A, B come from eq 33 (exact) or 32. With compliance=matched m is the mass that gives the mode
// its true impedance (docs/compliance-matching.md). The momentum is q = J u/2 + A y = J (u/2 + c
// y/4). On a body that moves (schemes/body) its acceleration is one more force.
#pragma once

#include "schemes/driver/driver.hpp"
#include "schemes/modal/kernels/modal_two_point_kernel.hpp"
#include "schemes/modal/modal_string.hpp"

namespace jvari {

struct TwoPointCoefficients {  // for one mode (van Walstijn et al. 2016, eqs 32-33)
    double A, B;
};
using TwoPointLaw = TwoPointCoefficients (*)(double omega0, double sigma, double dt);
TwoPointCoefficients exact_two_point(double omega0, double sigma, double dt);  // eq 33

class TwoPointModes {
public:
    static constexpr int levels = 1;
    // a step with many coupled points takes tens of microseconds
    static constexpr long steps_between_looks = 64;

    TwoPointModes(const Descriptor&, const Scene&, const Settings&, TwoPointLaw);

    const StringPoints& points() const { return p_; }
    void reset() noexcept;
    bool start_from(const TwoPointModes& before) noexcept;
    void approach(bool) noexcept;
    ReadingsBeforeStep readings() const { return {y_.data(), y_.data(), free_.data()}; }
    Spent pass(const double* force, double a, bool probed) noexcept;
    void reading(int, double* out) const noexcept;
    double stored() const noexcept;  // (49)
    bool failed() const { return !(std::abs(sum_) < modal_overflow); }
    double tap(int k, const double* mean) const noexcept {
        const TapOfModes& t = taps_[k];
        double sum = 0;
        if (!t.on_y.empty()) sum += dot_(t.on_y.data(), m_, TwoPointColumn::y);
        if (!t.on_u.empty()) sum += dot_(t.on_u.data(), m_, TwoPointColumn::u);
        for (std::size_t p = 0; p < t.on_mean.size(); ++p) sum += t.on_mean[p] * mean[p];
        return sum;
    }
    int dofs() const { return 2 * m_.modes; }
    ModalState state() const;
    std::vector<Fact> facts() const;
    std::vector<FreeMode> free_modes() const { return free_modes_; }

    double inertia() const;   // sum mu_i v_i'' without forces [N]
    double momentum() const;  // sum mu_i v_i' [kg m/s]
    double pluck() const { return F_e_; }

    void fuse(Obstacle&, int steps_per_row);
    FusedRows fused_rows(const Block&, int row, double* sum) noexcept;

private:
    struct TapOfModes {
        AlignedVector on_y, on_u;     // on_u: velocity only
        std::vector<double> on_mean;  // for each point's force; only for contact forces
    };
    struct PluckForce {
        Pluck of;
        std::vector<double> mean;   // in the step first + n, until the scene ends [N]
        std::vector<double> theta;  // for each point [m/N], and for a moving body [s^2]
        long first = 0, steps = 0;
    };
    // readings that a moving body takes from the string, and its pushes: empty without a body
    struct AtBody {
        // scaled; weights for sum mu_i (s_i - 2 q_i) without forces, in y and u
        AlignedVector mu, on_y, on_u;
    };
    // Weights of the modes, with scaled coordinates.
    AlignedVector scaled(const std::vector<double>& weights) const;
    void put(TwoPointColumn, const AlignedVector&, int point = 0);
    void put_pluck(const Pluck&, const Modes&, double duration);
    // A, B: of (33), for each mode
    void put_body(const Modes&, const String&, std::span<const double> A,
                  std::span<const double> B);
    void put_tap(const Tap&, const Modes&, const String&, std::span<const double> A);
    void pluck_modes() noexcept;
    double momentum_of(int i) const {  // q_i/J_i
        return 0.5 * at(TwoPointColumn::u, i) +
               0.25 * at(TwoPointColumn::c, i) * at(TwoPointColumn::y, i);
    }
    double at(TwoPointColumn column, int i) const { return stream_[m_.at(column, i)]; }
    double displacement(int i) const { return at(TwoPointColumn::y, i) / scale_[i]; }  // [m]
    double velocity(int i) const {  // 2q/dt [m/s]
        return 2 * J_[i] * momentum_of(i) / (dt_ * scale_[i]);
    }
    void begin(int i, double displacement, double velocity) noexcept {  // (42) with q = v dt/2
        y0_[i] = displacement * scale_[i];
        u0_[i] = -0.5 * at(TwoPointColumn::c, i) * y0_[i] + dt_ / J_[i] * velocity * scale_[i];
    }

    double dt_ = 0;
    StringPoints p_;
    TwoPointStream m_;
    AlignedVector stream_, J_, y0_, u0_, sums_;
    std::vector<double> scale_;     // sqrt(J/xi)
    std::vector<AlignedVector> g_;  // scaled; the contacts in order, the thread, a moving body
    AlignedVector g_e_;             // the pluck's
    PluckForce pluck_;
    AtBody body_;
    const TwoPointDot dot_ = two_point_dot();
    TwoPointPass pass_ = nullptr;
    // whole rows, on no body
    TwoPointKernel rows_ = nullptr;
    std::vector<FusedTap> fused_taps_;
    Obstacle* obstacle_ = nullptr;
    long steps_per_row_ = 1;
    std::vector<TapOfModes> taps_;
    std::vector<FreeMode> free_modes_;
    std::vector<double> y_, u_, free_, force_;  // at the points; free_: u_ with the pluck
    // yield of the only contact under a steady force, relative to the true one with the same modes;
    // otherwise 0
    double compliance_ = 0;
    double offset_ = 0;  // phase error of a start from rest [rad]
    // in the step: the pluck's force [N]; the points' readings added up [m]
    double F_e_ = 0, sum_ = 0;
};

extern template class Driver<TwoPointModes>;

}  // namespace jvari

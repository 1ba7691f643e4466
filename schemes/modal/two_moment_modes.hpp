// String in its modes, exact in a step under forces that are lines in the step: F = phi_0 + phi_1
// P_1(s) (docs/two-moments.md, sections 2 and 3). Between the ends of a step a mode moves without
// losses, at the frequency w; at its ends the velocity is damped by delta = exp(-2 sigma H), half
// before and half after the row. With z = w H/2, kappa = sqrt(m) omega_0 and the state (a, b) at
// the step's centre, for the motion without the step's forces, y = (a cos w tau + b sin w
// tau)/kappa:
//
//     S_0 = 2 sin z,  S_1 = 2 (sin z/z - cos z),  p_0 = g S_0/kappa,  p_1 = -g S_1/kappa
//     r_0 = sum of p_0 b,  r_1 = sum of p_1 a: the moments of a point's motion without forces   (1)
//     b <- b + sum of p_0 phi_0,  a <- a + sum of p_1 phi_1                                     (2)
//     (a, b) <- (A11 a + A12 b, A22 b - A12 a)                                                  (3)
//     Theta_00 = sum of p_0 q_0/2,  Theta_11 = sum of p_1 q_1/2,
//     Theta_01 = -Theta_10 = -sum of cos z S_1 g_p g_q/kappa^2
//
// Frequency and decay of free motion are exact; without losses the phase is exact too.
#pragma once

#include "schemes/driver/driver.hpp"
#include "schemes/modal/kernels/two_moment_kernel.hpp"
#include "schemes/modal/modal_string.hpp"

namespace jvari {

// One mode over a step H.
struct ExactMode {
    ExactMode(double mass, double omega0, double sigma, double H);
    double sine, cosine, z;  // for z = w H/2
    double kappa;            // [sqrt(kg)/s]
    double delta;            // exp(-2 sigma H)
    // coefficient of v in the velocity after the damping at a row, over w [s]
    double by_v;
    double lead = 0;  // phase by which a release at rest leads the true one [rad]
    double p_0() const { return 2 * sine / kappa; }  // for g = 1
    double p_1() const;
};

struct PluckMoments {  // pluck force in a step [N]
    double mean = 0, first = 0;
};

class TwoMomentModes {
public:
    static constexpr int levels = 1, moments = 2;
    static constexpr long steps_between_looks = 64;

    TwoMomentModes(const Descriptor&, const Scene&, const Settings&);

    const StringPoints& points() const { return p_; }
    void reset() noexcept;
    bool start_from(const TwoMomentModes& before) noexcept;
    void approach(bool) noexcept;
    // free: means for all points, then first moments
    ReadingsBeforeStep readings() const { return {nullptr, nullptr, free_.data()}; }
    double mean_pluck() const { return F_0_; }  // in the step [N]
    Spent pass(const double* force, double, bool probed) noexcept;
    void reading(int, double* out) const noexcept;
    double stored() const noexcept;
    bool failed() const { return !(std::abs(sum_) < modal_overflow); }
    double tap(int k, const double* mean) const noexcept;
    int dofs() const { return 2 * m_.modes; }
    ModalState state() const;
    std::vector<Fact> facts() const { return {{facts::start_phase_offset, offset_}}; }
    std::vector<FreeMode> free_modes() const { return free_modes_; }

    void fuse(MomentObstacle&, int steps_per_row);
    FusedRows fused_rows(const Block&, int row, double* sum) noexcept;

private:
    struct Reading {  // weights for a displacement or a velocity at a row
        AlignedVector on_a, on_b;
    };
    struct TapOfModes {
        Reading on_modes;
        std::vector<double> on_mean;  // for each point's force; only for contact forces
    };
    struct PluckForce {
        Pluck of;
        std::vector<PluckMoments> moments;  // in the step first_step + n
        std::vector<MomentMatrix> theta;    // for each point [m/N]
        AlignedVector p_0, p_1;
        long first_step = 0, steps = 0;
    };
    struct AtRow {
        double y, u;  // displacement, and damped velocity over w, times kappa [sqrt(J)]
    };
    AtRow at_row(int i) const {
        const double a = at(TwoMomentStream::a, i), b = at(TwoMomentStream::b, i);
        return {a * modes_[i].cosine - b * modes_[i].sine,
                a * modes_[i].sine + b * modes_[i].cosine};
    }
    Reading reading_of(const std::vector<double>& weights, bool velocity) const;
    MomentMatrix compliance(const std::vector<double>& g, const std::vector<double>& h) const;
    void put_points(const Modes&, const Scene&);
    void put_pluck(const Modes&, const Pluck&, double duration,
                   const std::vector<std::vector<double>>& g);
    void put_taps(const Modes&, const Scene&);
    void begin(int i, double displacement, double velocity) noexcept;
    Spent spent(const double* force) const noexcept;
    double at(int column, int i) const { return stream_[m_.at(column, i)]; }
    double dot(const Reading& r) const noexcept {
        return sum_of_(r.on_a.data(), r.on_b.data(), m_);
    }

    double dt_ = 0;
    StringPoints p_;
    TwoMomentStream m_;
    AlignedVector stream_, a0_, b0_;
    AlignedVector free_sums_;  // for the kernel: moments at the points without forces
    std::vector<ExactMode> modes_;
    std::vector<Reading> readings_;  // for each point
    PluckForce pluck_;
    double F_0_ = 0, F_1_ = 0;  // the pluck's moments in the step [N]
    const TwoMomentSum sum_of_ = two_moment_sum();
    TwoMomentPass pass_ = nullptr;
    std::vector<TapOfModes> taps_;
    std::vector<FreeMode> free_modes_;
    std::vector<double> free_;  // these with the pluck
    double sum_ = 0;            // sum over the means [m]
    double offset_ = 0;         // phase error of a start from rest [rad]
    long step_ = 0;
    // whole rows
    TwoMomentRowsKernel rows_ = nullptr;
    std::vector<FusedTap> fused_taps_;
    MomentObstacle* obstacle_ = nullptr;
    long steps_per_row_ = 1;
    std::vector<double> force_;
};

extern template class Driver<TwoMomentModes>;

}  // namespace jvari

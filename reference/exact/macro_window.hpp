// One window of a string under point forces: the modes are read once at its start and given the
// forces' moments once at its end.
//
// In between, the contact points' free motion is a short vector of derivatives, and a force acts on
// it through a kernel of derivatives:
//
//     y_a(t) = s_a(t) + sum_b int_0^t h_ab(t - w) F_b(w) dw,
//     M_i(t) = int_0^t (t - w)^i/i! F(w) dw
//
// with t = 1 the full length of a window. Thread and pluck act inside s, h and the moments handed
// to the modes (van Walstijn et al. 2016, eqs 5-22). The thread answers its own point's free motion
// by a convolution, and likewise a force at b by kappa_b * F. Derivatives are cut after `terms`;
// the distance between a point and its series is bounded. Velocities u are displacements per window
// [m]. Leaves out: contact, which its users decide.
#pragma once

#include <utility>
#include <vector>

#include "reference/exact/modal_sweep.hpp"
#include "reference/exact/oscillators.hpp"
#include "reference/exact/series_window.hpp"
#include "reference/exact/springs.hpp"
#include "reference/in_series.hpp"

namespace jvari {

struct WindowChoice {
    long per_row = 1;  // windows between two rows
    int terms = 2;     // derivatives kept
};
// Chooses the window for a relative `tolerance` and a string whose fastest motion grows by e^reach
// between two rows. If stiff contact is split (touching_set.hpp), no window spans more than
// longest_reach: beyond it more terms increase the error. Without contact a window may span
// longest_unsplit, if most_terms are enough for it.
constexpr double longest_reach = 2.5, longest_unsplit = 5;
constexpr int most_split_terms = 24, most_terms = 32;
WindowChoice choose_window(double tolerance, double reach, bool split = true);

class MacroWindow {
public:
    // `interval` between rows [s]; windows a row and terms, 0: chosen by the tolerance
    MacroWindow(const Modes&, const String&, double interval, double tolerance,
                const std::optional<InSeries>& = {}, int windows = 0, int terms = 0);

    Oscillators osc;
    Springs springs;
    int contacts, terms;
    long per_row;
    int size;  // terms in whole vectors
    // stride for rows of derivatives and moments; they are zero from `size` on, so that sums may
    // run over
    int stride;
    double length;  // full window [1/rate]
    // growth: the final limit on the ratio between each derivative and the one before
    double reach;

    double seconds() const { return length / osc.rate; }  // an impulse is M_0 times this
    // has zeros before it too
    const double* kernel(int a, int b) const {
        return &kernel_[(static_cast<long>(a) * contacts + b) * (stride + size) + size];
    }
    // for the open window
    const double* free_motion(int a) const { return &free_[static_cast<long>(a) * stride]; }
    // bound on the distance from the true motion [m]
    double truncation() const { return truncation_; }
    // for a gap [m]
    double rounding() const { return rounding_; }
    // for a displacement, by an impulse M_0 of 1 [m]
    double kernel_truncation() const { return kernel_truncation_; }
    const SweepFunctions& sweep() const { return *sweep_; }

    // z: the series state (in_series.hpp), if there is any
    void open(const double* y, const double* u, bool plucked, double since_pluck,
              const double* z = nullptr) noexcept;

    // Modal state at `at`, under contact forces with moments M[contact][stride]. The output may be
    // the input of open().
    void state_at(double at, const double* M, const double* y, const double* u, double* y_out,
                  double* u_out) noexcept;
    // The same within a window, cheaper and good for integrals: (y, u) acts as the impulses (u + a
    // y) delta + y delta'.
    void state_near(double at, const double* M, const double* y, const double* u, double* y_out,
                    double* u_out) noexcept;
    // until the instant in the last state_at [N s]
    double thread_impulse() const { return thread_impulse_; }
    const double* series_state() const { return z_now_.data(); }  // z at that instant
    const std::optional<InSeries>& series() const { return series_; }
    double thread_force() const { return thread_force_; }  // at that instant [N]
    // z' there [per window], under the contact and thread forces
    void series_speed(const double* F, double* out) const noexcept {
        in_window_.front().speed(z_now_.data(), F, out);
    }

    struct Push {
        double force = 0, change = 0;  // pluck force [N], and its derivative [N/window]
    };
    Push push_at(double at) const noexcept;
    // growth ratio of derivatives in the open window
    double push_growth() const { return plucked_ ? push_growth_ : 0; }
    bool threaded() const { return springs.points > contacts; }

private:
    double largest_eigenvalue() const;
    std::vector<double> reply_series(double window, int count) const;
    void answer(const double* reply, const double* motion, double window, int count,
                double* F) const;
    void impulse_response(int force, double window, int count, const double* reply, double* y,
                          double* F) const;
    void make_base(const Modes&);
    void put_weight(const Modes&, const String&);
    void make_kernel();
    // Adds the fall of masses under their weights, which is exact beside any motion of the modes.
    void fall(double at, double* y_out, double* u_out) const noexcept;
    void free_flow(double at, std::vector<double>& e) const noexcept;
    int act(double at, const double* e, const double* M) noexcept;
    void move(int forces, const double* flow, const double* y, const double* u, double* y_out,
              double* u_out) noexcept;

    const SweepFunctions* sweep_;
    // derivatives known for the thread's force: its damper needs one more for its point's motion
    int known_;
    std::optional<InSeries> series_;
    std::vector<SeriesWindow> in_window_;  // none or one
    // series state at the window's start and at the instant in the last state_at
    std::vector<double> z_, z_now_;
    std::vector<const double*> moments_of_;
    std::vector<Pluck> pluck_;  // none or one
    std::vector<char> none_;
    std::vector<int> sweep_terms_;
    std::vector<double> a_, b_;  // in window units
    // base_: each mode's scale, the weight at the last point (a tiny value at its nodes, 0 if there
    // is no mode). Other weights and the force gains are stored relative to it, in window units;
    // base_gain_: the gain for the last point's own force.
    std::vector<double> base_, over_base_, weights_, gains_, base_moments_;
    double base_gain_ = 0;
    std::vector<double> slower_;                 // reach^-n
    std::vector<std::pair<int, double>> falls_;  // mode of a mass with a weight, its acceleration
    double tail_, modal_tail_, truncation_ = 0, rounding_ = 0, kernel_truncation_ = 0,
                               thread_impulse_ = 0, thread_force_ = 0, push_growth_ = 0;
    bool plucked_ = false;
    // h_ab; kappa_b; F_c from p_c; h_ac; free motion's matrix
    std::vector<double> kernel_, answer_, reply_, by_thread_, flow_, flow_at_;
    std::vector<double> p_, free_, force_, moments_, reach_, scratch_, impulse_, offset_, zeros_,
        ones_;
    std::vector<const double*> acting_, acting_moments_;
};

// u^n/n!, n < count, and some more: in whole vectors
void powers(double u, int count, double* e) noexcept;
extern const std::vector<double> inverse_factorial;

}  // namespace jvari

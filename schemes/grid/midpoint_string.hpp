// A string on a grid stepped by the two-step midpoint rule: finite_difference_hamiltonian.cpp has
// its equations and source.
#pragma once

#include <cmath>

#include "scenes/excitation.hpp"
#include "schemes/aligned.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/grid/five_point_pass.hpp"
#include "schemes/grid/grid_scheme.hpp"
#include "schemes/grid/grid_solve.hpp"

namespace jvari {

class MidpointString {
public:
    static constexpr int levels = 1;
    static constexpr long steps_between_looks = steps_on_grid_between_questions;

    MidpointString(const GridString& string, double dt)
        : g_(string), dt_(dt), xi_(dt * dt / (2 * g_.mass)) {
        const double quarter = 0.25 * dt * dt, h2 = g_.grid.dx * g_.grid.dx;
        solve_ = GridSolve(g_.grid, 1 + g_.loss.sigma0 * dt, -quarter * g_.c2 - g_.loss.sigma1 * dt,
                           quarter * g_.kappa2 + g_.loss.sigma2 * dt);
        double slope = quarter * g_.c2 / h2, curve = quarter * g_.kappa2 / (h2 * h2);
        // all multiples of this unit are doubles up to a0
        const double unit = std::ldexp(1.0, std::ilogb(2 * slope + 6 * curve) - 52);
        slope = unit * std::nearbyint(slope / unit);
        curve = unit * std::nearbyint(curve / unit);
        pull_ = {-2 * (2 * slope + 6 * curve), 2 * (slope + 4 * curve), -2 * curve, 2, 0, 0};
        pass_ = five_point_pass(pull_);
        for (const Stencil& s : g_.stencils) responses_.push_back(solve_.response(s));
        g_.points.theta = compliances(g_.stencils, responses_, xi_, g_.grid);
        for (auto* v : {&older_, &free_}) v->assign(g_.stencils.size(), 0.0);
        for (auto* b : {&y_store_, &q_store_, &s_store_})
            *b = AlignedVector(offset + g_.grid.intervals + five_point_overhang);
        reset();
    }

    const StringPoints& points() const { return g_.points; }
    ReadingsBeforeStep readings() const { return {older_.data(), older_.data(), free_.data()}; }

    void reset() noexcept {
        for (auto* b : {&y_store_, &q_store_, &s_store_}) std::fill_n(b->data(), b->size(), 0.0);
        y_ = y_store_.data() + offset;
        q_ = q_store_.data() + offset;
        s_ = s_store_.data() + offset;
        std::copy_n(g_.start.data(), g_.grid.intervals + 1, y_);
        for (int l = 0; l <= g_.grid.intervals; ++l) q_[l] = 0.5 * dt_ * g_.start_velocity[l];
        diverged_ = false;
        step_ = 0;
        budget_ = HUGE_VAL;
    }
    void expect(double energy) noexcept { budget_ = energy; }  // energy at the start [J]

    void approach(bool) noexcept {
        const int N = g_.grid.intervals;
        double *y = y_, *s = s_;
        y[0] = y[N] = 0;  // odd about both ends
        y[-1] = -y[1];
        y[N + 1] = -y[N - 1];
        pass_(pull_, N, solve_.input(), y, q_, nullptr);
        F_e_ = g_.points.pluck ? mean_force(*g_.points.pluck, step_ * dt_, dt_) : 0;
        if (F_e_ != 0) g_.pluck_stencil.add(xi_ * F_e_, solve_.input());
        solve_(s);
        for (std::size_t p = 0; p < g_.stencils.size(); ++p) {
            older_[p] = g_.stencils[p].read(y);
            free_[p] = g_.stencils[p].read(s);
        }
    }
    Spent pass(const double* force, double, bool probed) noexcept {
        for (std::size_t p = 0; p < responses_.size(); ++p)
            if (force[p] != 0) responses_[p].add(xi_ * force[p], s_);
        Spent spent;
        if (F_e_ != 0) {
            spent.supplied = F_e_ * g_.pluck_stencil.read(s_);
            budget_ += std::max(spent.supplied, 0.0);
        }
        if (probed) spent.dissipated = dt_ * loss();
        move_(g_.grid.intervals, y_, q_, s_);
        ++step_;
        if (step_ % divergence_check == 0 && !(kinetic() <= divergence_factor * budget_ + 1e-30))
            diverged_ = true;
        return spent;
    }
    bool failed() const { return diverged_; }

    void reading(int, double* out) const noexcept {
        for (std::size_t p = 0; p < g_.stencils.size(); ++p) out[p] = g_.stencils[p].read(y_);
    }
    double stored() const noexcept {
        const Squares d = squares(g_.grid, [y = y_](int l) { return y[l]; });
        return kinetic() + 0.5 * g_.mass * (g_.c2 * d.slope + g_.kappa2 * d.curve);
    }
    double tap(int k, const double* mean) const noexcept {
        const GridTap& t = g_.taps[k];
        if (t.stencil.weight.empty()) return heard_force(t.quantity, g_.points, mean);
        return t.quantity == Quantity::velocity ? t.stencil.read(q_) * 2 / dt_ : t.stencil.read(y_);
    }
    int dofs() const { return 2 * (g_.grid.intervals - 1); }
    std::vector<Fact> facts() const { return grid_facts(g_); }
    std::vector<FreeMode> free_modes() const {
        std::vector<FreeMode> all;
        for (int i = 1; i < g_.grid.intervals; ++i) all.push_back(midpoint_mode(g_, dt_, i));
        return all;
    }

private:
    static constexpr int offset = 7;  // node 1 on a 64-byte boundary, node -1 inside

    double kinetic() const noexcept {
        double sum = 0;
        for (int l = 1; l < g_.grid.intervals; ++l) sum += q_[l] * q_[l];
        return 2 * g_.mass / (dt_ * dt_) * sum;  // v = 2q/dt
    }
    double loss() const noexcept {  // power [W]: <v, R v>, v = s/dt
        const Squares d = squares(g_.grid, [s = s_](int l) { return s[l]; });
        return 2 * g_.mass / (dt_ * dt_) *
               (g_.loss.sigma0 * d.own + g_.loss.sigma1 * d.slope + g_.loss.sigma2 * d.curve);
    }

    GridString g_;
    double dt_, xi_;
    FivePointWeights pull_;  // 2 (q - A y), A = dt^2 K/4
    FivePointPass pass_ = nullptr;
    MidpointPass move_ = midpoint_pass();
    GridSolve solve_;  // I + A + B
    std::vector<Stencil> responses_;
    std::vector<double> older_, free_;
    AlignedVector y_store_, q_store_, s_store_;
    double *y_ = nullptr, *q_ = nullptr, *s_ = nullptr;  // [l] is node l
    long step_ = 0;
    double F_e_ = 0, budget_ = HUGE_VAL;
    bool diverged_ = false;
};

}  // namespace jvari

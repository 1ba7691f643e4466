// A string on a grid stepped by the two-step midpoint rule: finite_difference_hamiltonian.cpp has its equations and source. `Solve` is
// how its five diagonals are solved: GridSolve, or what is to be compared with it.
#pragma once

#include <cmath>

#include "scenes/excitation.hpp"
#include "schemes/aligned.hpp"
#include "schemes/grid/five_point_pass.hpp"
#include "schemes/grid/grid_scheme.hpp"
#include "schemes/grid/grid_solve.hpp"

namespace jvari {

template <class Solve>  // as GridSolve
class MidpointString final : public Scheme {
public:
    MidpointString(const GridString& string, double dt, int steps_per_row)
        : g_(string), dt_(dt), xi_(dt * dt / (2 * g_.mass)), steps_(steps_per_row) {
        const double quarter = 0.25 * dt * dt, h2 = g_.grid.dx * g_.grid.dx;
        solve_ = Solve(g_.grid, 1 + g_.loss.sigma0 * dt, -quarter * g_.c2 - g_.loss.sigma1 * dt, quarter * g_.kappa2 + g_.loss.sigma2 * dt);
        double slope = quarter * g_.c2 / h2, curve = quarter * g_.kappa2 / (h2 * h2);
        const double unit = std::ldexp(1.0, std::ilogb(2 * slope + 6 * curve) - 52);  // all multiples of it are doubles up to a0
        slope = unit * std::nearbyint(slope / unit);
        curve = unit * std::nearbyint(curve / unit);
        pull_ = {-2 * (2 * slope + 6 * curve), 2 * (slope + 4 * curve), -2 * curve, 2, 0, 0};
        pass_ = five_point_pass(pull_);
        const int points = static_cast<int>(g_.points.size());
        for (const Stencil& s : g_.points) responses_.push_back(solve_.response(s));
        obstacle_ = g_.obstacle(compliances(g_.points, responses_, xi_, g_.grid), dt);
        if (g_.series) obstacle_.put_in_series(*g_.series, 1);
        for (auto* v : {&older_, &free_, &force_, &now_}) v->assign(points, 0.0);
        for (auto* b : {&y_store_, &q_store_, &s_store_}) *b = AlignedVector(offset + g_.grid.intervals + five_point_overhang);
        MidpointString::reset();
    }

    void reset() noexcept override {
        for (auto* b : {&y_store_, &q_store_, &s_store_}) std::fill_n(b->data(), b->size(), 0.0);
        y_ = y_store_.data() + offset;
        q_ = q_store_.data() + offset;
        s_ = s_store_.data() + offset;
        std::copy_n(g_.initial.data(), g_.grid.intervals + 1, y_);
        obstacle_.clear();
        g_.read(y_, 0, older_.data());
        obstacle_.begin(older_.data());
        failed_ = {};
        step_ = 0;
        bridge_ = thread_ = supplied_ = dissipated_ = 0;
        budget_ = stored();
    }

    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows && failed_.outcome == Outcome::ok; ++row) {
            write(out, row);
            for (int i = 0; i < steps_ && failed_.outcome == Outcome::ok; ++i) {
                step(out.energy != nullptr);
                if (out.stopped(i, steps_on_grid_between_questions)) return {};
            }
        }
        return failed_;
    }

    int dofs() const override { return 2 * (g_.grid.intervals - 1); }
    std::vector<Fact> facts() const override { return grid_facts(g_, obstacle_); }
    std::vector<FreeMode> free_modes() const override {
        std::vector<FreeMode> all;
        for (int i = 1; i < g_.grid.intervals; ++i) all.push_back(midpoint_mode(g_, dt_, i));
        return all;
    }

private:
    static constexpr int offset = 7;  // node 1 on a 64-byte boundary, node -1 inside

    void step(bool probed) noexcept {
        const int N = g_.grid.intervals;
        double *y = y_, *s = s_;
        mirror();
        pass_(pull_, N, solve_.input(), y, q_, nullptr);
        const double F_e = g_.pluck_at((step_ + 0.5) * dt_);
        if (F_e != 0) g_.pluck_stencil.add(xi_ * F_e, solve_.input());
        solve_(s);
        const int points = obstacle_.points();
        const double change = !g_.by_pluck() ? 0 : g_.pluck_at((step_ + 1) * dt_) - g_.pluck_at(step_ * dt_);
        g_.read(y, step_ * dt_, older_.data());
        for (int a = 0; a < points; ++a) free_[a] = g_.points[a].read(s) + (change != 0 ? g_.series->pluck[a] * change : 0);
        if (points > 0 && !obstacle_.solve(older_.data(), free_.data(), force_.data())) failed_ = {Outcome::not_converged, step_};
        for (int a = 0; a < points; ++a)
            if (force_[a] != 0) responses_[a].add(xi_ * force_[a], s);
        for (int a = 0; a < obstacle_.contacts(); ++a) bridge_ += force_[a];
        if (g_.thread) thread_ += force_.back();
        if (F_e != 0) {
            const double work = F_e * g_.pluck_stencil.read(s);
            supplied_ += work;
            budget_ += std::max(work, 0.0);
        }
        if (change != 0)  // the work on the points that the pluck moves by way of what is in series
            for (int a = 0; a < points; ++a) supplied_ -= force_[a] * g_.series->pluck[a] * change;
        if (probed) dissipated_ += dt_ * loss();
        move_(N, y, q_, s);
        ++step_;
        if (step_ % divergence_check == 0 && !(kinetic() <= divergence_factor * budget_ + 1e-30)) failed_ = {Outcome::diverged, step_ - 1};
    }

    void mirror() noexcept {  // odd about both ends
        const int N = g_.grid.intervals;
        y_[0] = y_[N] = 0;
        y_[-1] = -y_[1];
        y_[N + 1] = -y_[N - 1];
    }
    double kinetic() const noexcept {
        double sum = 0;
        for (int l = 1; l < g_.grid.intervals; ++l) sum += q_[l] * q_[l];
        return 2 * g_.mass / (dt_ * dt_) * sum;  // v = 2q/dt
    }
    double stored() noexcept {
        const Squares d = squares(g_.grid, [y = y_](int l) { return y[l]; });
        g_.read(y_, step_ * dt_, older_.data());
        return kinetic() + 0.5 * g_.mass * (g_.c2 * d.slope + g_.kappa2 * d.curve) + obstacle_.potential(older_.data());
    }
    double loss() const noexcept {  // power [W]: <v, R v> and the thread's damper, v = s/dt
        const Squares d = squares(g_.grid, [s = s_](int l) { return s[l]; });
        double power = 2 * g_.mass / (dt_ * dt_) * (g_.loss.sigma0 * d.own + g_.loss.sigma1 * d.slope + g_.loss.sigma2 * d.curve);
        if (!g_.points.empty()) power += obstacle_.loss(g_.points.back().read(s_));
        return power;
    }

    void write(const Block& out, int row) noexcept {
        const double bridge = bridge_ / steps_, thread = thread_ / steps_;
        bridge_ = thread_ = 0;
        const auto velocity = [&](const Stencil& at) { return at.read(q_) * 2 / dt_; };
        write_taps(out, row, g_.taps, y_, velocity, bridge, thread);
        if (g_.series) {
            g_.read(y_, step_ * dt_, older_.data());
            obstacle_.forces(0, now_.data());
            add_series_taps(out, row, g_, now_.data(), g_.pluck_at(step_ * dt_));
        }
        if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
        supplied_ = dissipated_ = 0;
    }

    GridString g_;
    double dt_, xi_;
    int steps_;
    FivePointWeights pull_;  // 2 (q - A y), A = dt^2 K/4
    FivePointPass pass_ = nullptr;
    MidpointPass move_ = midpoint_pass();
    Solve solve_;  // I + A + B
    std::vector<Stencil> responses_;
    ObstacleStep obstacle_;
    std::vector<double> older_, free_, force_, now_;
    AlignedVector y_store_, q_store_, s_store_;
    double *y_ = nullptr, *q_ = nullptr, *s_ = nullptr;  // [l] is node l
    long step_ = 0;
    double bridge_ = 0, thread_ = 0, supplied_ = 0, dissipated_ = 0, budget_ = 0;
    Status failed_;
};

}  // namespace jvari

// A string on a grid stepped by a three-point scheme,
//
//     M (u+ - 2u + u-)/dt^2 + R (u+ - u-)/2dt + K u = sum g F/(mu dx),     K = -c^2 D2 + kappa^2 D4, M = I + m D2 + m4 D4
//
// R = 2 sigma0 - 2 sigma1 D2 + 2 sigma2 D4,
// with contacts and thread over the span 2 dt (obstacle_step.hpp). Update solves for u+: explicit where m = sigma1 dt and m4 = -sigma2 dt
// (Bilbao, Torin & Chatziioannou 2015: the backward difference in the loss), banded where m = (1 - theta) dx^2/2 (Bilbao 2009, theta
// scheme).
//
// The string is stepped one ahead of the row it writes: at row n it holds u^{n-1}, u^n, u^{n+1}. So
//   velocity is the central difference (u^{n+1} - u^{n-1})/2dt;
//   contact forces, which act over [n - 1/2, n + 1/2], count half at either end of a row's interval (trapezoid);
//   energy `stored` at row n is that of the half step, mass/2 <d, M d>/dt^2 + mass/2 <u^{n+1}, K u^n> + [P^{n+1} + P^n]/2, d = u^{n+1} -
//   u^n, `supplied` and `dissipated` are sums over the steps centred on the instants after the last row's, so that the columns balance
//   exactly.
// Start from rest: u^1 = u^0 + dt^2/2 (acceleration), contacts and thread taken between u^0 and u^1, so that the start is stable however
// stiff they are, of second order, and without losses exactly the scheme's own cosine.
// On a body that moves (schemes/body) the points of all strings are solved for together, and its acceleration is one more force.
#pragma once

#include <cmath>
#include <numbers>

#include "scenes/excitation.hpp"
#include "schemes/aligned.hpp"
#include "schemes/body/body_modes.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/grid/five_point_pass.hpp"
#include "schemes/grid/grid_scheme.hpp"
#include "schemes/making.hpp"

namespace jvari {

constexpr int node_offset = 7;  // of node 0 in its array: node 1 on a 64-byte boundary, node -1 inside

template <class Update>  // operator()(next, now, before): u+ without forces, `before` its last `now`; response(g): what a unit of dt^2/(mu
                         // dx) on g adds to u+
class ThreePointString final : public Scheme {
public:
    ThreePointString(const GridString& string, double dt, int steps_per_row, double m, double m4, Update update,
                     std::vector<Fact> facts = {})
        : g_(string),
          dt_(dt),
          m_(m),
          m4_(m4),
          gain_(dt * dt / g_.mass),
          steps_(steps_per_row),
          update_(std::move(update)),
          own_(std::move(facts)) {
        const int points = static_cast<int>(g_.points.size());
        for (const Stencil& s : g_.points) responses_.push_back(update_.response(s));
        if (g_.pluck) pluck_response_ = update_.response(g_.pluck_stencil);
        if (g_.at_body) {
            mu_response_ = update_.response(g_.mu);
            g_.at_body->theta = compliances_of_points();
        } else {
            const std::vector<double> theta = compliances_of_points();
            std::vector<double> half(theta.size());
            for (std::size_t i = 0; i < theta.size(); ++i) half[i] = 0.5 * theta[i];
            obstacle_ = g_.obstacle(theta, 2 * dt);
            start_ = g_.obstacle(half, dt);
        }
        if (g_.series) {
            obstacle_.put_in_series(*g_.series, 2);
            start_.put_in_series(*g_.series, 1);
        }
        for (auto* v : {&older_, &free_, &force_, &reading_, &now_}) v->assign(points, 0.0);
        for (auto& b : buffer_) b = AlignedVector(node_offset + g_.grid.intervals + five_point_overhang);
        ThreePointString::reset();
    }

    // ---- On a body (schemes/body/instrument.hpp)

    const StringAtBody& at_body() const { return *g_.at_body; }
    const double* older() const { return older_.data(); }
    const double* free() const { return free_.data(); }
    double inertia() const { return inertia_; }
    double pluck() const { return F_e_; }
    double share() const {  // most that the ends' inertia takes of a node's, sum over the sine modes of mu_j^2/(M - dt^2 K/4) [kg]
        const int N = g_.grid.intervals;
        double sum = 0;
        for (int j = 1; j < N; ++j) {
            const double half = 0.5 * std::numbers::pi * j / N, s = 2 * std::sin(half) / g_.grid.dx, square = s * s;
            const double left = 1 - (m_ - m4_ * square) * square - 0.25 * dt_ * dt_ * (g_.c2 + g_.kappa2 * square) * square;
            sum += 0.5 * g_.mass / (N * std::tan(half) * std::tan(half) * left);
        }
        return sum;
    }
    void begin() noexcept {
        at_rest();
        const double *now = level_[1], *next = level_[2];
        inertia_ = 2 / (dt_ * dt_) * (g_.mu.read(next) - g_.mu.read(now));
        F_e_ = g_.pluck_at(0);
    }
    void start(const double* force, double a) noexcept {
        std::copy_n(force, force_.size(), force_.data());
        a_ = a;
        half_a_step();
        budget_ = HUGE_VAL;  // what the others give it is not known here
    }
    void pass(const double* force, double a, bool probed) noexcept {
        std::copy_n(force, force_.size(), force_.data());
        a_ = a;
        probed ? pass<true>() : pass<false>();
    }
    void reading(int level, double* out) const noexcept { g_.read(level_[1 + level], 0, out); }
    double momentum() const noexcept { return (g_.mu.read(level_[2]) - g_.mu.read(level_[1])) / dt_; }  // of the half step
    bool failed() const { return failed_.outcome != Outcome::ok; }

    // ----

    void reset() noexcept override {
        at_rest();
        start_.begin(older_.data());
        if (!start_.solve(older_.data(), free_.data(), force_.data())) failed_ = {Outcome::not_converged, 0};
        half_a_step();
        obstacle_.follow(start_);
        budget_ = std::abs(stored());
    }

private:
    void at_rest() noexcept {  // level 1 without the forces
        const int N = g_.grid.intervals;
        for (int i = 0; i < 3; ++i) {
            level_[i] = buffer_[i].data() + node_offset;
            std::fill_n(buffer_[i].data(), buffer_[i].size(), 0.0);
        }
        double *before = level_[0], *now = level_[1], *next = level_[2];
        std::copy_n(g_.initial.data(), N + 1, now);
        std::copy_n(g_.initial.data(), N + 1, before);
        mirror(now);
        mirror(before);
        obstacle_.clear();
        start_.clear();
        failed_ = {};
        step_ = 0;
        update_(next, now, before);  // so that it keeps what it needs of u-
        update_(next, now, before);  // with u- = u this is u + dt^2 (acceleration)
        for (int l = 1; l < N; ++l) next[l] = now[l] + 0.5 * (next[l] - now[l]);
        pluck(0, 0.5, next);
        g_.read(now, 0, older_.data());
        g_.read(next, dt_, free_.data());
        for (std::size_t a = 0; a < free_.size(); ++a) free_[a] -= older_[a];
    }
    void half_a_step() noexcept {  // level 1 with them
        double *before = level_[0], *next = level_[2];
        for (std::size_t a = 0; a < force_.size(); ++a)
            if (force_[a] != 0) responses_[a].add(0.5 * gain_ * force_[a], next);
        if (g_.at_body) mu_response_.add(-0.5 * gain_ * a_, next);
        std::copy_n(next - 1, g_.grid.intervals + 2, before - 1);  // at rest: u^{-1} = u^1
        bridge_ = thread_ = supplied_ = dissipated_ = 0;           // row 0 takes the halves of this force
    }

    std::vector<double> compliances_of_points() const {  // and then of the body where there is one
        std::vector<Stencil> places = g_.points, responses = responses_;
        if (g_.at_body) {
            places.push_back(g_.mu);
            responses.push_back(mu_response_);
        }
        return compliances(places, responses, gain_, g_.grid);
    }

public:
    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows && failed_.outcome == Outcome::ok; ++row) {
            write(out, row);
            if (!(out.energy ? steps<true>(out) : steps<false>(out))) return {};
        }
        return failed_;
    }

    int dofs() const override { return 2 * (g_.grid.intervals - 1); }
    std::vector<Fact> facts() const override {
        std::vector<Fact> all = grid_facts(g_, obstacle_);
        all.insert(all.end(), own_.begin(), own_.end());
        return all;
    }
    std::vector<FreeMode> free_modes() const override {
        std::vector<FreeMode> all;
        for (int i = 1; i < g_.grid.intervals; ++i) all.push_back(three_point_mode(g_, dt_, m_, m4_, i));
        return all;
    }

private:
    template <bool probe>
    bool steps(const Block& out) noexcept {  // of a row; false: the caller wants no more
        for (int i = 0; i < steps_ && failed_.outcome == Outcome::ok; ++i) {
            step<probe>();
            if (out.stopped(i, steps_on_grid_between_questions)) return false;
        }
        return true;
    }
    void mirror(double* u) const noexcept {  // odd about both ends
        const int N = g_.grid.intervals;
        u[-1] = -u[1];
        u[0] = u[N] = 0;
        u[N + 1] = -u[N - 1];
    }
    double bridge_force() const noexcept {
        double sum = 0;
        for (std::size_t a = 0; a < g_.laws.size(); ++a) sum += force_[a];
        return sum;
    }
    double thread_force() const noexcept { return g_.thread ? force_.back() : 0; }

    double pluck(double t, double share, double* next) const noexcept {  // returns the force [N]
        const double F = g_.pluck_at(t);
        if (F != 0) pluck_response_.add(share * gain_ * F, next);
        return F;
    }

    template <bool probed>
    void step() noexcept {
        approach();
        if (!force_.empty() && !obstacle_.solve(older_.data(), free_.data(), force_.data())) failed_ = {Outcome::not_converged, step_ - 1};
        pass<probed>();
    }

public:
    void approach(bool = false) noexcept {  // the next step without the points' forces
        double* spare = level_[0];
        level_[0] = level_[1];
        level_[1] = level_[2];
        level_[2] = spare;
        const double* before = level_[0];
        double *now = level_[1], *next = level_[2];
        ++step_;
        mirror(now);
        update_(next, now, before);
        F_e_ = pluck(step_ * dt_, 1, next);
        g_.read(before, (step_ - 1) * dt_, older_.data());
        g_.read(next, (step_ + 1) * dt_, free_.data());
        for (std::size_t a = 0; a < free_.size(); ++a) free_[a] -= older_[a];
        if (g_.at_body) inertia_ = (g_.mu.read(next) - 2 * g_.mu.read(now) + g_.mu.read(before)) / (dt_ * dt_);
    }

private:
    template <bool probed>
    void pass() noexcept {
        const double *before = level_[0], F_e = F_e_;
        double* next = level_[2];
        const int points = static_cast<int>(force_.size());
        for (int a = 0; a < points; ++a)
            if (force_[a] != 0) responses_[a].add(gain_ * force_[a], next);
        if (g_.at_body) mu_response_.add(-gain_ * a_, next);
        bridge_ += bridge_force();
        thread_ += thread_force();
        if (F_e != 0) {
            const double work = 0.5 * F_e * (g_.pluck_stencil.read(next) - g_.pluck_stencil.read(before));
            supplied_ += work;
            budget_ += std::max(work, 0.0);
        }
        if (g_.by_pluck()) {  // the work on the points that the pluck moves by way of what is in series
            const double change = g_.pluck_at((step_ + 1) * dt_) - g_.pluck_at((step_ - 1) * dt_);
            for (int a = 0; a < points; ++a) supplied_ -= 0.5 * force_[a] * g_.series->pluck[a] * change;
        }
        if (probed) dissipated_ += dt_ * loss();
        if (step_ % divergence_check == 0 && !(kinetic(0, 0) <= divergence_factor * budget_ + 1e-30))
            failed_ = {Outcome::diverged, step_ - 1};
    }

    double kinetic(double m, double m4) const noexcept {  // mass/2 <d, (I + m D2 + m4 D4) d>/dt^2
        const double *now = level_[1], *next = level_[2];
        const Squares d = squares(g_.grid, [=](int l) { return next[l] - now[l]; });
        return 0.5 * g_.mass / (dt_ * dt_) * (d.own - m * d.slope + m4 * d.curve);
    }
    double stored() noexcept {
        double *now = level_[1], *next = level_[2];
        mirror(now);
        mirror(next);
        double slope = 0, curve = 0;
        for (int l = 0; l < g_.grid.intervals; ++l) {
            slope += (next[l + 1] - next[l]) * (now[l + 1] - now[l]);
            curve += (next[l + 1] - 2 * next[l] + next[l - 1]) * (now[l + 1] - 2 * now[l] + now[l - 1]);
        }
        const double h2 = g_.grid.dx * g_.grid.dx;
        double sum = kinetic(m_, m4_) + 0.5 * g_.mass * (g_.c2 * slope + g_.kappa2 / h2 * curve) / h2;
        for (const int level : {0, 1}) {
            g_.read(level == 0 ? now : next, (step_ + level) * dt_, reading_.data());
            sum += 0.5 * obstacle_.potential(reading_.data(), level);
        }
        return sum;
    }
    double loss() const noexcept {  // power [W]: <v, R v> and the thread's damper, v = (u+ - u-)/2dt
        const double *before = level_[0], *next = level_[2];
        const Squares d = squares(g_.grid, [=](int l) { return next[l] - before[l]; });
        double power = 0.5 * g_.mass / (dt_ * dt_) * (g_.loss.sigma0 * d.own + g_.loss.sigma1 * d.slope + g_.loss.sigma2 * d.curve);
        if (!g_.points.empty()) power += obstacle_.loss(g_.points.back().read(next) - older_.back());
        return power;
    }

public:
    void write(const Block& out, int row) noexcept {
        const double *before = level_[0], *next = level_[2];
        const double last_bridge = bridge_force(), last_thread = thread_force();
        const double bridge = step_ == 0 ? 0 : (bridge_ - 0.5 * last_bridge) / steps_;
        const double thread = step_ == 0 ? 0 : (thread_ - 0.5 * last_thread) / steps_;
        bridge_ = 0.5 * last_bridge;
        thread_ = 0.5 * last_thread;
        const auto velocity = [&](const Stencil& at) { return (at.read(next) - at.read(before)) / (2 * dt_); };
        write_taps(out, row, g_.taps, level_[1], velocity, bridge, thread);
        if (g_.series) {
            g_.read(level_[1], step_ * dt_, reading_.data());
            obstacle_.forces(0, now_.data());
            add_series_taps(out, row, g_, now_.data(), g_.pluck_at(step_ * dt_));
        }
        if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
        supplied_ = dissipated_ = 0;
    }

private:
    GridString g_;
    double dt_, m_, m4_, gain_;  // gain_ = dt^2/(mu dx) [m/N]
    int steps_;
    Update update_;
    std::vector<Fact> own_;
    std::vector<Stencil> responses_;
    Stencil pluck_response_, mu_response_;
    double F_e_ = 0, inertia_ = 0, a_ = 0;  // of the step: the pluck [N]; sum mu v'' without forces [N], w'' [m/s^2]
    ObstacleStep obstacle_, start_;
    std::vector<double> older_, free_, force_, reading_, now_;
    AlignedVector buffer_[3];
    double* level_[3] = {};  // u^{n-1}, u^n, u^{n+1}; [l] is node l
    long step_ = 0;          // n
    double bridge_ = 0, thread_ = 0, supplied_ = 0, dissipated_ = 0, budget_ = 0;
    Status failed_;
};

// A string on its grid as a scheme, or all strings of a scene on a moving body. make(scene of one string) -> unique_ptr<String>.
template <class String, class Make>
std::unique_ptr<Scheme> on_its_support(const Scene& scene, const Settings& settings, Make make) {
    return on_its_support<String>(scene, steps_per_row(settings), make,
                                  [&] { return ThreePointBody(scene.body->modes, 1 / settings.sample_rate); });
}

// (2M - dt^2 K) u - (M - dt R/2) u-, M = I + m D2 + m4 D4, over `divisor`. Of the increment u+ - u- instead: (2M - dt^2 K) u - 2M u-, which
// is what is left after (M + dt R/2) u-.
class FivePoint {
public:
    enum class Of { next, increment };
    FivePoint(const GridString& g, double dt, double m, double m4, double divisor, Of of = Of::next) : intervals_(g.grid.intervals) {
        kept_ = AlignedVector(node_offset + intervals_ + five_point_overhang);
        const double h2 = g.grid.dx * g.grid.dx, s = g.c2 * dt * dt / h2, q = g.kappa2 * dt * dt / (h2 * h2);
        const double n = m / h2, n4 = m4 / (h2 * h2);
        const LossFit& loss = g.loss;
        w_.a0 = (2 - 4 * n + 12 * n4 - 2 * s - 6 * q) / divisor;
        w_.a1 = (2 * n - 8 * n4 + s + 4 * q) / divisor;
        w_.a2 = (2 * n4 - q) / divisor;
        // M - dt R/2, or 2M
        const double p0 = of == Of::next ? 1 - loss.sigma0 * dt : 2, p = of == Of::next ? n + loss.sigma1 * dt / h2 : 2 * n,
                     p4 = of == Of::next ? n4 - loss.sigma2 * dt / (h2 * h2) : 2 * n4;
        w_.b0 = -(p0 - 2 * p + 6 * p4) / divisor;
        w_.b1 = -(p - 4 * p4) / divisor;
        w_.b2 = -p4 / divisor;
        pass_ = five_point_pass(w_);
    }
    void operator()(double* next, const double* now, const double* before) noexcept {
        pass_(w_, intervals_, next, now, before, kept_.data() + node_offset);
    }

private:
    int intervals_;
    FivePointWeights w_;
    FivePointPass pass_;
    AlignedVector kept_;  // of the level before
};

}  // namespace jvari

// A string on a grid stepped by a three-point scheme,
//
//     M (u+ - 2u + u-)/dt^2 + R (u+ - u-)/2dt + K u = sum g F/(mu dx),
//     K = -c^2 D2 + kappa^2 D4, M = I + m D2 + m4 D4
//
// R = 2 sigma0 - 2 sigma1 D2 + 2 sigma2 D4,
// with contacts and thread over the span 2 dt (contact/obstacle.hpp). Update solves for u+:
// explicit where m = sigma1 dt and m4 = -sigma2 dt (Bilbao, Torin & Chatziioannou 2015: the
// backward difference in the loss),
// banded where m = (1 - theta) dx^2/2 (Bilbao 2009, theta scheme).
//
// At row n it holds u^{n-1}, u^n, u^{n+1}; velocity is the central difference (u^{n+1} -
// u^{n-1})/2dt, and the energy of the half step n + 1/2 is mass/2 <d, M d>/dt^2 + mass/2 <u^{n+1},
// K u^n>, d = u^{n+1} - u^n.
// Start: u^1 = u^0 + dt v + dt^2/2 (acceleration), contacts and thread taken between u^0 and
// u^1, so that the start is stable however stiff they are, of second order, and without losses
// exactly the scheme's own cosine.
// On a body that moves (schemes/body) the points of all strings are solved for together, and its
// acceleration is one more force.
#pragma once

#include <cmath>
#include <numbers>

#include "scenes/excitation.hpp"
#include "schemes/aligned.hpp"
#include "schemes/body/body_modes.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/grid/five_point_pass.hpp"
#include "schemes/grid/grid_scheme.hpp"
#include "schemes/making.hpp"

namespace jvari {

// position of node 0 in its array: node 1 on a 64-byte boundary, node -1 inside
constexpr int node_offset = 7;

// operator()(next, now, before): u+ without forces, `before` its last `now`; response(g): the
// increment that a unit of dt^2/(mu dx) on g adds to u+
template <class Update>
class ThreePointString {
public:
    static constexpr int levels = 2;
    static constexpr long steps_between_looks = steps_on_grid_between_questions;

    ThreePointString(const GridString& string, double dt, double m, double m4, Update update,
                     std::vector<Fact> facts = {})
        : g_(string),
          dt_(dt),
          m_(m),
          m4_(m4),
          gain_(dt * dt / g_.mass),
          update_(std::move(update)),
          own_(std::move(facts)) {
        std::vector<Stencil> places = g_.stencils;
        for (const Stencil& s : g_.stencils) responses_.push_back(update_.response(s));
        if (g_.points.pluck) pluck_response_ = update_.response(g_.pluck_stencil);
        std::vector<Stencil> responses = responses_;
        if (g_.on_body) {
            mu_response_ = update_.response(g_.mu);
            places.push_back(g_.mu);
            responses.push_back(mu_response_);
        }
        g_.points.theta = compliances(places, responses, gain_, g_.grid);
        for (auto* v : {&older_, &now_, &free_}) v->assign(g_.stencils.size(), 0.0);
        if (g_.moves) drift_.assign(g_.grid.intervals + 1, 0.0);
        for (auto& b : buffer_)
            b = AlignedVector(node_offset + g_.grid.intervals + five_point_overhang);
        reset();
    }

    const StringPoints& points() const { return g_.points; }
    ThreadStart thread_start() const { return ThreadStart::plain; }
    ReadingsBeforeStep readings() const { return {older_.data(), now_.data(), free_.data()}; }

    void reset() noexcept {  // level 1 without the points' forces
        const int N = g_.grid.intervals;
        for (int i = 0; i < 3; ++i) {
            level_[i] = buffer_[i].data() + node_offset;
            std::fill_n(buffer_[i].data(), buffer_[i].size(), 0.0);
        }
        double *before = level_[0], *now = level_[1], *next = level_[2];
        std::copy_n(g_.start.data(), N + 1, now);
        mirror(now);
        if (!drift_.empty()) {  // u+ with u- = u - 2 dt v
            for (int l = 0; l <= N; ++l) before[l] = now[l] - 2 * dt_ * g_.start_velocity[l];
            mirror(before);
            update_(next, before, before);
            update_(next, now, before);
            for (int l = 0; l <= N; ++l)
                drift_[l] = 0.5 * dt_ * g_.start_velocity[l] + 0.25 * next[l];
        }
        std::copy_n(g_.start.data(), N + 1, before);
        mirror(before);
        diverged_ = false;
        step_ = 0;
        budget_ = HUGE_VAL;
        update_(next, now, before);  // lets the update keep the part of u- that it needs
        update_(next, now, before);  // with u- = u this is u + dt^2 (acceleration)
        for (int l = 1; l < N; ++l) {
            const double by_speed = drift_.empty() ? 0 : drift_[l] - 0.25 * next[l];
            next[l] = now[l] + 0.5 * (next[l] - now[l]) + by_speed;
        }
        F_e_ = pluck(0, 0.5, next);
        for (std::size_t p = 0; p < now_.size(); ++p) {
            now_[p] = older_[p] = g_.stencils[p].read(now);
            free_[p] = g_.stencils[p].read(next) - older_[p];
        }
        if (g_.on_body)
            inertia_ =
                2 / (dt_ * dt_) *
                (g_.mu.read(next) - g_.mu.read(now) - dt_ * g_.mu.read(g_.start_velocity.data()));
    }
    void start(const double* force, double a) noexcept {  // level 1 with them
        double *before = level_[0], *next = level_[2];
        for (std::size_t p = 0; p < responses_.size(); ++p)
            if (force[p] != 0) responses_[p].add(0.5 * gain_ * force[p], next);
        if (g_.on_body) mu_response_.add(-0.5 * gain_ * a, next);
        std::copy_n(next - 1, g_.grid.intervals + 2, before - 1);  // u^{-1} = u^1 - 2 dt v
        for (std::size_t l = 0; l < drift_.size(); ++l) before[l] -= 2 * dt_ * g_.start_velocity[l];
    }
    // energy at the start [J]
    void expect(double energy) noexcept { budget_ = std::abs(energy); }

    void approach(bool) noexcept {
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
        older_.swap(now_);
        for (std::size_t p = 0; p < now_.size(); ++p) {
            now_[p] = g_.stencils[p].read(now);
            free_[p] = g_.stencils[p].read(next) - older_[p];
        }
        if (g_.on_body)
            inertia_ = (g_.mu.read(next) - 2 * g_.mu.read(now) + g_.mu.read(before)) / (dt_ * dt_);
    }
    Spent pass(const double* force, double a, bool probed) noexcept {
        const double* before = level_[0];
        double* next = level_[2];
        for (std::size_t p = 0; p < responses_.size(); ++p)
            if (force[p] != 0) responses_[p].add(gain_ * force[p], next);
        if (g_.on_body) mu_response_.add(-gain_ * a, next);
        Spent spent;
        if (F_e_ != 0) {
            spent.supplied =
                0.5 * F_e_ * (g_.pluck_stencil.read(next) - g_.pluck_stencil.read(before));
            budget_ += std::max(spent.supplied, 0.0);
        }
        if (probed) spent.dissipated = dt_ * loss();
        if (step_ % divergence_check == 0 &&
            !(kinetic(0, 0) <= divergence_factor * budget_ + 1e-30))
            diverged_ = true;
        return spent;
    }
    bool failed() const { return diverged_; }

    void reading(int level, double* out) const noexcept {
        for (std::size_t p = 0; p < g_.stencils.size(); ++p)
            out[p] = g_.stencils[p].read(level_[1 + level]);
    }
    double stored() noexcept {
        double *now = level_[1], *next = level_[2];
        mirror(now);
        mirror(next);
        double slope = 0, curve = 0;
        for (int l = 0; l < g_.grid.intervals; ++l) {
            slope += (next[l + 1] - next[l]) * (now[l + 1] - now[l]);
            curve +=
                (next[l + 1] - 2 * next[l] + next[l - 1]) * (now[l + 1] - 2 * now[l] + now[l - 1]);
        }
        const double h2 = g_.grid.dx * g_.grid.dx;
        return kinetic(m_, m4_) + 0.5 * g_.mass * (g_.c2 * slope + g_.kappa2 / h2 * curve) / h2;
    }
    double tap(int k, const double* mean) const noexcept {
        const GridTap& t = g_.taps[k];
        if (t.stencil.weight.empty()) return heard_force(t.quantity, g_.points, mean);
        if (t.quantity == Quantity::velocity)
            return (t.stencil.read(level_[2]) - t.stencil.read(level_[0])) / (2 * dt_);
        return t.stencil.read(level_[1]);
    }
    int dofs() const { return 2 * (g_.grid.intervals - 1); }
    std::vector<Fact> facts() const {
        std::vector<Fact> all = grid_facts(g_);
        all.insert(all.end(), own_.begin(), own_.end());
        return all;
    }
    std::vector<FreeMode> free_modes() const {
        std::vector<FreeMode> all;
        for (int i = 1; i < g_.grid.intervals; ++i)
            all.push_back(three_point_mode(g_, dt_, m_, m4_, i));
        return all;
    }

    // ---- On a body (schemes/body/instrument.hpp)

    double inertia() const { return inertia_; }
    double pluck() const { return F_e_; }
    // greatest part of a node's inertia that the ends' inertia takes, sum over the sine modes of
    // mu_j^2/(M - dt^2 K/4) [kg]
    double share() const {
        const int N = g_.grid.intervals;
        double sum = 0;
        for (int j = 1; j < N; ++j) {
            const double half = 0.5 * std::numbers::pi * j / N, s = 2 * std::sin(half) / g_.grid.dx,
                         square = s * s;
            const double left = 1 - (m_ - m4_ * square) * square -
                                0.25 * dt_ * dt_ * (g_.c2 + g_.kappa2 * square) * square;
            sum += 0.5 * g_.mass / (N * std::tan(half) * std::tan(half) * left);
        }
        return sum;
    }
    // at the half step
    double momentum() const noexcept {
        return (g_.mu.read(level_[2]) - g_.mu.read(level_[1])) / dt_;
    }

private:
    void mirror(double* u) const noexcept {  // odd about both ends
        const int N = g_.grid.intervals;
        u[-1] = -u[1];
        u[0] = u[N] = 0;
        u[N + 1] = -u[N - 1];
    }
    double pluck(double t, double share, double* next) const noexcept {  // returns the force [N]
        const double F = g_.points.pluck ? mean_about(*g_.points.pluck, t, dt_) : 0;
        if (F != 0) pluck_response_.add(share * gain_ * F, next);
        return F;
    }
    double kinetic(double m, double m4) const noexcept {  // mass/2 <d, (I + m D2 + m4 D4) d>/dt^2
        const double *now = level_[1], *next = level_[2];
        const Squares d = squares(g_.grid, [=](int l) { return next[l] - now[l]; });
        return 0.5 * g_.mass / (dt_ * dt_) * (d.own - m * d.slope + m4 * d.curve);
    }
    double loss() const noexcept {  // power [W]: <v, R v>, v = (u+ - u-)/2dt
        const double *before = level_[0], *next = level_[2];
        const Squares d = squares(g_.grid, [=](int l) { return next[l] - before[l]; });
        return 0.5 * g_.mass / (dt_ * dt_) *
               (g_.loss.sigma0 * d.own + g_.loss.sigma1 * d.slope + g_.loss.sigma2 * d.curve);
    }

    GridString g_;
    double dt_, m_, m4_, gain_;  // gain_ = dt^2/(mu dx) [m/N]
    Update update_;
    std::vector<Fact> own_;
    std::vector<Stencil> responses_;
    Stencil pluck_response_, mu_response_;
    double F_e_ = 0, inertia_ = 0;  // in the step: the pluck [N]; sum mu v'' without forces [N]
    std::vector<double> older_, now_, free_;
    AlignedVector buffer_[3];
    std::vector<double> drift_;  // each node's drift by a velocity at t = 0; none at rest [m]
    double* level_[3] = {};      // u^{n-1}, u^n, u^{n+1}; [l] is node l
    long step_ = 0;              // n
    double budget_ = HUGE_VAL;
    bool diverged_ = false;
};

// Makes a scheme from a string on its grid, or from all strings of a scene on a moving body.
// make(scene of one string) -> unique_ptr<String>.
template <class String, class Make>
std::unique_ptr<Scheme> on_three_point_support(const Descriptor& scheme, const Scene& scene,
                                               const Settings& settings, const RuleChoice& rule,
                                               Make make) {
    return on_its_support<String>(scheme, scene, settings, rule, make, [&] {
        return ThreePointBody(scene.body->modes, 1 / settings.sample_rate);
    });
}

// (2M - dt^2 K) u - (M - dt R/2) u-, M = I + m D2 + m4 D4, over `divisor`. For the increment u+ -
// u- instead: (2M - dt^2 K) u - 2M u-, the remainder after (M + dt R/2) u-.
class FivePoint {
public:
    enum class Of { next, increment };
    FivePoint(const GridString& g, double dt, double m, double m4, double divisor, Of of = Of::next)
        : intervals_(g.grid.intervals) {
        kept_ = AlignedVector(node_offset + intervals_ + five_point_overhang);
        const double h2 = g.grid.dx * g.grid.dx, s = g.c2 * dt * dt / h2,
                     q = g.kappa2 * dt * dt / (h2 * h2);
        const double n = m / h2, n4 = m4 / (h2 * h2);
        const LossFit& loss = g.loss;
        w_.a0 = (2 - 4 * n + 12 * n4 - 2 * s - 6 * q) / divisor;
        w_.a1 = (2 * n - 8 * n4 + s + 4 * q) / divisor;
        w_.a2 = (2 * n4 - q) / divisor;
        // M - dt R/2, or 2M
        const double p0 = of == Of::next ? 1 - loss.sigma0 * dt : 2,
                     p = of == Of::next ? n + loss.sigma1 * dt / h2 : 2 * n,
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
    AlignedVector kept_;  // for the level before
};

}  // namespace jvari

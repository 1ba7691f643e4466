// Puts a string's missing compliance in series with its points: springs, and beside them a ladder
// (compliance.hpp). One form serves any number of points; up to 5 are unrolled. The equations come
// from docs/compliance-matching.md, "The step".
//
//     symbol        meaning                                              unit        equation
//     C             compliance of the springs                            m/N         1
//     R_0           resistance without masses: `damper`                  kg/s        1
//     V, B, a       patterns; `branch` and `share` of the mass of each   1, kg/s, 1  1, 2
//     W, K          (R C/h + 1/2)^-1 with R = R_0 + V' B V; C W          1, m/N      3
//     D, P          stretch C P of the springs, their forces             m, N        4, 5
//     v             velocities of the masses                             m/s         2
//     Q, H          P - V' B v; K Q                                      N, m        4, 6
//     F, h          mean forces over a step, its span                    N, s        4
//
// The ladder represents the energy that the cut modes carry away. C alone would keep the whole
// energy of a blow, and alternate from step to step for ever.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "schemes/contact/compliance.hpp"
#include "schemes/contact/products.hpp"

namespace jvari {

// A ladder mass over a step: while its pattern moves by `moved`, the mass takes up `share` of its
// lag.
struct MassStep {
    double branch = 0;           // 1/(1/resistance + span/(2 mass)) [kg/s]
    double share = 0, mass = 0;  // [1], [kg]
    double span = 1;             // [s]

    MassStep() = default;
    MassStep(double mass_, double resistance, double span_) : mass(mass_), span(span_) {
        if (mass > 0)
            branch = 1 / (1 / resistance + 0.5 * span / mass), share = branch * span / mass;
    }
    double behind(double moved, double v) const { return moved / span - v; }  // [m/s]
    double lost(double behind) const {                                        // in a step [J] (7)
        return branch * span * (1 - 0.5 * share) * behind * behind;
    }
};

class Residual {
public:
    // levels: number of levels that a step spans. With two levels, every other step forms a
    // separate chain with a separate state.
    Residual(const MissingMatrix&, double span, int levels);

    double K(std::size_t i) const { return K_[i]; }  // row-major over the points
    // Values for each point; level 0: the start of the next step, 1: the level after it.
    const double* yields(int level) const { return state_[level].out.data(); }  // D [m]
    const double* force(int level) const { return state_[level].x.data(); }     // P [N]
    // H for the next step [m]
    const double* pulled() const { return state_[0].out.data() + points_; }
    // the level on which it is centred, or from which it starts
    int centre() const { return levels_ - 1; }

    void rest(const double* force) noexcept {  // under steady point forces [N]
        std::copy_n(force, points_, steady_.begin());
        for (State& s : state_) {
            std::copy_n(force, points_, s.x.begin());
            std::fill(s.x.begin() + points_, s.x.end(), 0.0);
            show<0>(s.x.data(), s);
        }
    }
    void follow(const Residual& first) noexcept {  // after it made the first half step
        rest(first.steady_.data());
        take(state_[1], first.state_[0]);
    }
    void start_from(const Residual& before) noexcept {
        for (int level = 0; level < 2; ++level) take(state_[level], before.state_[level]);
    }
    void step(const double* F) noexcept {
        switch (points_) {
            case 1: return step<1>(F);
            case 2: return step<2>(F);
            case 3: return step<3>(F);
            case 4: return step<4>(F);
            case 5: return step<5>(F);
            default: return step<0>(F);
        }
    }
    template <int few>
    [[gnu::always_inline]] void step(const double* F) noexcept {
        const int n = few > 0 ? few : points_;
        State& s = state_[0];
        double local[few > 0 ? 5 * few : 1];  // in registers
        double *Q = few > 0 ? local : Q_.data(), *before = few > 0 ? Q + few : before_.data(),
               *x = few > 0 ? before + 2 * few : s.x.data();
        for (int a = 0; a < n; ++a) Q[a] = F[a] - s.out[2 * n + a];
        for (int i = 0; i < 2 * n; ++i) before[i] = s.x[i];
        for (int i = 0; i < 2 * n; ++i) x[i] = keeps_[i] * before[i];
        add_product<2 * few>(by_force_.data(), Q, n, x, 2 * n);
        show<few>(x, s);
        if constexpr (few > 0) {
            for (int a = 0; a < n; ++a) Q_[a] = Q[a];
            for (int i = 0; i < 2 * n; ++i) before_[i] = before[i], s.x[i] = x[i];
        }
        if (levels_ == 2) std::swap(state_[0], state_[1]);
    }

    double stored(int level) const {  // [J] (7)
        const State& s = state_[level];
        double sum = 0;
        for (int a = 0; a < points_; ++a) {
            const double v = s.x[points_ + a];
            sum += 0.5 * (s.x[a] * s.out[a] + masses_[a].mass * v * v);
        }
        return sum;
    }
    double lost() const;  // in the last step [J] (7)

private:
    struct State {
        std::vector<double> x;    // P for points, v for patterns
        std::vector<double> out;  // D, H, Q for points
    };
    // Computes D, H and Q from P and v
    template <int few>
    [[gnu::always_inline]] void show(const double* x, State& s) noexcept {
        const int n = few > 0 ? few : points_;
        double local[few > 0 ? 3 * few : 1];
        double* out = few > 0 ? local : s.out.data();
        product<3 * few>(by_state_.data(), x, 2 * n, out, 3 * n);
        if constexpr (few > 0)
            for (int i = 0; i < 3 * n; ++i) s.out[i] = out[i];
    }
    void take(State& to, const State& from) noexcept {
        to.x = from.x;
        show<0>(to.x.data(), to);
    }

    int points_, levels_;
    double rate_;                     // 1/span [1/s]
    std::vector<double> K_;           // points x points
    std::vector<double> damper_, V_;  // V: patterns x points
    std::vector<MassStep> masses_;    // for each pattern
    // A step, by columns: x from F - Q, the part of x that stays, out from x.
    std::vector<double> by_force_, keeps_, by_state_;
    State state_[2];
    std::vector<double> steady_;      // for points, at rest [N]
    std::vector<double> Q_, before_;  // F - Q in the last step, and x before it
};

}  // namespace jvari

// What a string lacks at its points stands in series with them: springs, and beside them a ladder
// (compliance.hpp). One form for any number of points; 1 and 2 are unrolled. The equations are
// those of docs/compliance-matching.md, "The step".
//
//     symbol        meaning                                              unit        equation
//     C             compliance of the springs                            m/N         1
//     R_0           what resists without masses: `damper`                kg/s        1
//     V, B, a       patterns; `branch` and `share` of the mass of each   1, kg/s, 1  1, 2
//     W, K          (R C/h + 1/2)^-1 with R = R_0 + V' B V; C W          1, m/N      3
//     D, P          stretch C P of the springs, their forces             m, N        4, 5
//     v             velocities of the masses                             m/s         2
//     Q, H          P - V' B v; K Q                                      N, m        4, 6
//     F, h          mean forces over a step, its span                    N, s        4
//
// The ladder stands for the energy that the cut modes carry away. C alone would keep all of a blow,
// and alternate from step to step for ever.
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "schemes/contact/compliance.hpp"

namespace jvari {

// A mass of the ladder over a step: while its pattern moves by `moved` it takes up `share` of what
// it lags behind.
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
    void follow(double behind, double& v) const { v += share * behind; }      // (2)
    double lost(double behind) const {                                        // in a step [J] (7)
        return branch * span * (1 - 0.5 * share) * behind * behind;
    }
};

class Residual {
public:
    // levels: how many of them a step spans. Where they are two, every other step is a chain of its
    // own, with a state of its own.
    Residual(const MissingMatrix&, double span, int levels);

    double K(std::size_t i) const { return K_[i]; }  // row-major over the points
    // Of each point; level 0: that the next step starts from, 1: the one after it.
    const double* yields(int level) const { return state_[level].D.data(); }  // D [m]
    const double* force(int level) const { return state_[level].P.data(); }   // P [N]
    const double* pulled() const { return state_[0].H.data(); }  // of the next step [m]
    int centre() const { return levels_ - 1; }  // the level that it is centred on, or starts from

    void rest(const double* force) noexcept {  // under steady forces of the points [N]
        std::copy_n(force, points_, steady_.begin());
        for (State& s : state_) {
            std::copy_n(force, points_, s.P.begin());
            std::fill(s.v.begin(), s.v.end(), 0.0);
            prepare<0>(s, s.P.data(), s.Q.data());
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
        const std::size_t n = few > 0 ? few : points_;
        State& s = state_[0];
        double local[3][std::max(few, 1)];  // in registers
        double *Q = few > 0 ? local[0] : s.Q.data(), *moved = few > 0 ? local[1] : moved_.data(),
               *P = few > 0 ? local[2] : s.P.data();
        for (std::size_t a = 0; a < n; ++a) Q[a] = F[a] - s.Q[a];
        for (std::size_t a = 0; a < n; ++a) {
            moved_[a] = moved[a] = times(K_, a, Q, n);    // (4)
            s.P[a] = P[a] = s.P[a] + times(W_, a, Q, n);  // (5)
        }
        for (std::size_t k = 0; k < n; ++k) {
            behind_[k] = masses_[k].behind(times(V_, k, moved, n), s.v[k]);
            masses_[k].follow(behind_[k], s.v[k]);
        }
        prepare<few>(s, P, Q);
        if (levels_ == 2) std::swap(state_[0], state_[1]);
    }

    double stored(int level) const {  // [J] (7)
        const State& s = state_[level];
        double sum = 0;
        for (std::size_t a = 0; a < points_; ++a)
            sum += 0.5 * (s.P[a] * s.D[a] + masses_[a].mass * s.v[a] * s.v[a]);
        return sum;
    }
    double lost() const {  // in the last step [J] (7)
        double sum = 0;
        for (std::size_t a = 0; a < points_; ++a)
            sum += moved_[a] * times(damper_, a, moved_.data(), points_);
        sum *= rate_;
        for (std::size_t k = 0; k < points_; ++k) sum += masses_[k].lost(behind_[k]);
        return sum;
    }

private:
    struct State {
        std::vector<double> P, v, D, Q, H;  // of points, of patterns (v)
    };
    [[gnu::always_inline]] static double times(const std::vector<double>& m, std::size_t a,
                                               const double* x, std::size_t n) {
        double sum = 0;
        for (std::size_t b = 0; b < n; ++b) sum += m[a * n + b] * x[b];
        return sum;
    }
    void take(State& to, const State& from) noexcept {
        to.P = from.P;
        to.v = from.v;
        prepare<0>(to, to.P.data(), to.Q.data());
    }
    // D, Q and H of what P and v are
    template <int few>
    [[gnu::always_inline]] void prepare(State& s, const double* P, double* Q) noexcept {
        const std::size_t n = few > 0 ? few : points_;
        for (std::size_t a = 0; a < n; ++a) {
            double resisted = 0;
            for (std::size_t k = 0; k < n; ++k)
                resisted += V_[k * n + a] * masses_[k].branch * s.v[k];
            s.D[a] = times(C_, a, P, n);
            s.Q[a] = Q[a] = P[a] - resisted;
        }
        for (std::size_t a = 0; a < n; ++a) s.H[a] = times(K_, a, Q, n);
    }

    std::size_t points_;
    int levels_;
    double rate_;                     // 1/span [1/s]
    std::vector<double> C_, W_, K_;   // points x points
    std::vector<double> damper_, V_;  // V: patterns x points
    std::vector<MassStep> masses_;    // of each pattern
    State state_[2];
    std::vector<double> steady_;          // of points, at rest [N]
    std::vector<double> moved_, behind_;  // in the last step: of points [m], of patterns [m/s]
};

}  // namespace jvari

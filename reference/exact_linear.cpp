// Closed form for strings that touch nothing: every mode is a damped oscillator,
//
//     y_i(t) = e^(-sigma t) (cos wt + sigma sin(wt)/w) y_i(0) + e^(-sigma t) sin(wt)/w v_i(0)
//              + Duhamel integral of the pluck,
//
// w^2 = omega0^2 - sigma^2, hyperbolic if that is negative, t itself in place of sin(wt)/w if it is
// zero (van Walstijn et al. 2016, eqs 16-21). Every 32nd row after the last forced one comes
// straight from the state there, with the phase reduced in long double. A row between them comes
// from the row before, by the flight over one row: no error accumulates beyond 32 roundings. The
// loss of a string without acting forces is the difference in its energies. Under a force, loss and
// supply are integrated like Duhamel's integral: Gauss-Legendre on panels that are short against
// the fastest mode and the pluck's own time scale.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/gauss_legendre.hpp"
#include "reference/pluck_parts.hpp"
#include "reference/readout.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/start.hpp"
#include "schemes/making.hpp"

namespace jvari {

namespace {
struct Flight {  // y = yy y0 + yv v0, v = vy y0 + vv v0
    double yy, yv, vy, vv;
};

Flight flight(double omega0, double sigma, long double t) {
    double c, s;  // e^(-sigma t) cos wt, e^(-sigma t) sin(wt)/w
    if (omega0 > sigma) {
        const long double turn = 2 * std::numbers::pi_v<long double>;
        const long double w = std::sqrt((static_cast<long double>(omega0) - sigma) *
                                        (static_cast<long double>(omega0) + sigma));
        const long double phase = w * t;
        const double reduced = static_cast<double>(phase - turn * std::rint(phase / turn));
        const double decay = static_cast<double>(std::exp(-static_cast<double>(sigma * t)));
        c = decay * std::cos(reduced);
        s = decay * std::sin(reduced) / static_cast<double>(w);
    } else {
        const double time = static_cast<double>(t),
                     nu = std::sqrt((sigma - omega0) * (sigma + omega0));
        // sigma - nu without cancellation
        const double slow = std::exp(-omega0 * omega0 / (sigma + nu) * time);
        c = 0.5 * slow * (1 + std::exp(-2 * nu * time));
        s = nu == 0 ? slow * time : slow * -std::expm1(-2 * nu * time) / (2 * nu);
    }
    return {c + sigma * s, s, -omega0 * omega0 * s, c - sigma * s};
}

constexpr int nodes = 16;
constexpr long rows_to_a_flight = 32;
constexpr long panels_between_questions = 16;  // (Block::stopped)

class ExactLinear final : public Scheme {
public:
    ExactLinear(const String& s, const Scene& scene, Modes modes, double tap_rate)
        : modes_(std::move(modes)),
          readout_(scene, modes_),
          parts_(s.pluck),
          start_(start_of(modes_, s)),
          tap_rate_(tap_rate) {
        for (int i = 0; i < modes_.count(); ++i)
            rate_ = std::max({rate_, modes_.omega0[i], 2 * modes_.sigma[i]});
        if (s.pluck) {
            pluck_.push_back(*s.pluck);
            excited_ = footprint_weights(modes_, s.pluck->position, s.pluck->width);
            for (double& g : excited_) g /= modes_.mass;
            // the phase 2 pi h_e/tau_e turns at most at the rate pi (1 + k coth k)/tau_e
            const double k = std::abs(s.pluck->skew);
            if (s.pluck->time.empty())
                rate_ = std::max(rate_, std::numbers::pi * (2 + k) / s.pluck->duration);
        }
        for (State* state : {&anchor_, &state_, &node_state_})
            state->y = state->v = start_.displacement;
        for (int i = 0; i < modes_.count(); ++i)
            each_row_.push_back(flight(modes_.omega0[i], modes_.sigma[i], 1.0L / tap_rate));
        gauss_legendre(node_, weight_);
        reset();
    }
    void reset() noexcept override {
        for (State* state : {&anchor_, &state_}) {
            std::copy(start_.displacement.begin(), start_.displacement.end(), state->y.begin());
            std::copy(start_.velocity.begin(), start_.velocity.end(), state->v.begin());
        }
        anchor_row_ = row_ = 0;
        supplied_ = dissipated_ = 0;
    }
    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row) {
            readout_.write(out, row, state_.y.data(), state_.v.data(), 1, 0, 0);
            if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
            next_row(out);
        }
        return {};
    }
    int dofs() const override { return 2 * modes_.count(); }
    ModalState state() const override { return {state_.y, state_.v}; }

private:
    struct State {
        std::vector<double> y, v;
    };
    void next_row(const Block& out) noexcept {
        const bool probe = out.energy != nullptr;
        supplied_ = dissipated_ = 0;
        const double interval = 1 / tap_rate_, now = row_ / tap_rate_;
        bool plucked = false;
        parts_.each(now, interval, 1,
                    [&](double, double, bool acts) { return plucked |= acts, true; });
        if (!plucked) {
            const double before = probe ? stored() : 0;
            ++row_;
            if ((row_ - anchor_row_) % rows_to_a_flight == 0)
                fly(anchor_, static_cast<long double>(row_ - anchor_row_) / tap_rate_, state_);
            else fly_a_row();
            if (probe) dissipated_ = before - stored();
            return;
        }
        const bool whole = parts_.each(now, interval, 1, [&](double from, double to, bool) {
            const double length = to - from;
            const long count = panels(length);
            for (long k = 0; k < count; ++k) {
                const double a = now + from +
                                 length * static_cast<double>(k) / static_cast<double>(count),
                             b = now + from +
                                 length * static_cast<double>(k + 1) / static_cast<double>(count);
                if (probe) ledger(a, b);
                push(state_, a, b);
                if (out.stopped(k, panels_between_questions)) return false;
            }
            return true;
        });
        if (!whole) return;
        anchor_row_ = ++row_;
        anchor_.y = state_.y;  // same size: copies in place
        anchor_.v = state_.v;
    }
    void fly_a_row() noexcept {
        const Flight* f = each_row_.data();
        double *y = state_.y.data(), *v = state_.v.data();
        for (int i = 0; i < modes_.count(); ++i) {
            const double at = y[i], moves = v[i];
            y[i] = f[i].yy * at + f[i].yv * moves;
            v[i] = f[i].vy * at + f[i].vv * moves;
        }
    }
    void fly(const State& from, long double t, State& to) const noexcept {
        for (int i = 0; i < modes_.count(); ++i) {
            const Flight f = flight(modes_.omega0[i], modes_.sigma[i], t);
            const double y = from.y[i], v = from.v[i];
            to.y[i] = f.yy * y + f.yv * v;
            to.v[i] = f.vy * y + f.vv * v;
        }
    }
    // Moves the state by free flight and the pluck's force, over one panel
    void push(State& state, double from, double to) const noexcept {
        fly(state, static_cast<long double>(to) - from, state);
        if (pluck_.empty() || from >= pluck_[0].start + pluck_[0].duration || to <= pluck_[0].start)
            return;
        for (int q = 0; q < nodes; ++q) {
            const double length = to - from,
                         impulse = weight_[q] * length * force(pluck_[0], from + node_[q] * length);
            for (int i = 0; i < modes_.count(); ++i) {
                const Flight f = flight(modes_.omega0[i], modes_.sigma[i], length * (1 - node_[q]));
                state.y[i] += f.yv * impulse * excited_[i];
                state.v[i] += f.vv * impulse * excited_[i];
            }
        }
    }
    // integrates the energies over one panel by quadrature, from state_
    void ledger(double from, double to) noexcept {
        std::copy(state_.y.begin(), state_.y.end(), node_state_.y.begin());
        std::copy(state_.v.begin(), state_.v.end(), node_state_.v.begin());
        double at = from;
        for (int q = 0; q < nodes; ++q) {
            const double next = from + node_[q] * (to - from);
            push(node_state_, at, next);
            at = next;
            double loss = 0, power = 0;
            for (int i = 0; i < modes_.count(); ++i) {
                loss += 2 * modes_.mass * modes_.sigma[i] * node_state_.v[i] * node_state_.v[i];
                if (!pluck_.empty()) power += modes_.mass * excited_[i] * node_state_.v[i];
            }
            dissipated_ += weight_[q] * (to - from) * loss;
            if (!pluck_.empty())
                supplied_ += weight_[q] * (to - from) * power * force(pluck_[0], next);
        }
    }
    double stored() const noexcept {
        double sum = 0;
        for (int i = 0; i < modes_.count(); ++i) {
            const double p = modes_.omega0[i] * state_.y[i];
            sum += state_.v[i] * state_.v[i] + p * p;
        }
        return 0.5 * modes_.mass * sum;
    }
    long panels(double length) const noexcept {
        return static_cast<long>(
            std::clamp(std::ceil(length * rate_ / 3), 1.0,
                       0.5 * static_cast<double>(std::numeric_limits<long>::max())));
    }

    Modes modes_;
    Readout readout_;
    std::vector<Pluck> pluck_;  // none or one
    PluckParts parts_;
    ModalStart start_;
    std::vector<double> excited_;        // g_e/m
    double tap_rate_, rate_ = 0;         // rate: the fastest rate among modes and pluck [1/s]
    State anchor_, state_, node_state_;  // at the last forced row; at this row; the probe's
    std::vector<Flight> each_row_;
    long anchor_row_ = 0, row_ = 0;
    double supplied_ = 0, dissipated_ = 0;
    std::array<double, nodes> node_{}, weight_{};
};

std::unique_ptr<Scheme> make_exact_linear(const Descriptor&, const Scene& scene,
                                          const Settings& settings) {
    const String& s = scene.strings.at(0);
    Settings unsampled = settings;
    unsampled.sample_rate = 0;
    return std::make_unique<ExactLinear>(s, scene, modes_of(s, unsampled), settings.tap_rate);
}
}  // namespace

const Descriptor exact_linear = {.name = "exact_linear",
                                 .source = "closed form of van Walstijn et al. 2016, eqs 16-21",
                                 .represents = Feature::bending_stiffness | Feature::damping |
                                               Feature::frequency_dependent_damping |
                                               Feature::measured_modes | Feature::initial_shape |
                                               Feature::pluck | Feature::initial_velocity |
                                               Feature::equilibrium,
                                 .balance = Balance::to_tolerance,
                                 .clock = Clock::continuous,
                                 .make = make_exact_linear};

}  // namespace jvari

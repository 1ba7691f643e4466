// A scheme that keeps the whole contract: the exact solution of each mode of one free string, from
// row to row. The schemes of this folder derive from it, and each breaks one promise. Leaves out
// contacts, thread, pluck and further strings.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "scenes/modes.hpp"
#include "scenes/start.hpp"
#include "schemes/making.hpp"
#include "schemes/plugin.hpp"

namespace jvari {

constexpr Features honest_features = Feature::bending_stiffness | Feature::damping |
                                     Features(Feature::frequency_dependent_damping) |
                                     Features(Feature::initial_shape);

class Honest : public Scheme {
public:
    Honest(const Scene& scene, const Settings& settings) : scene_(scene) {
        steps_per_row(settings);
        const String& s = scene.strings.front();
        modes_ = modes_of(s, settings);
        shape_ = start_of(modes_, s).displacement;
        for (int i = 0; i < modes_.count(); ++i) {
            const double sigma = modes_.sigma[i], omega0 = modes_.omega0[i],
                         T = 1 / settings.tap_rate;
            const double omega = std::sqrt(omega_squared_damped(omega0, sigma)),
                         p = std::exp(-sigma * T);
            const double c = p * std::cos(omega * T), w = p * std::sin(omega * T) / omega;
            steps_.push_back({c + sigma * w, w, -omega0 * omega0 * w, c - sigma * w});
        }
        for (const Tap& tap : scene.taps) {
            const bool on_string =
                tap.quantity == Quantity::displacement || tap.quantity == Quantity::velocity;
            if (on_string) weights_.push_back(displacement_weights(modes_, tap.position));
            else if (tap.quantity == Quantity::nut_force)
                weights_.push_back(nut_force_weights(modes_, s));
            else weights_.emplace_back(modes_.count(), 0.0);  // no contact
        }
        y_ = shape_;
        v_.assign(y_.size(), 0.0);
        start_ = before_ = stored();
    }
    void reset() noexcept override {
        y_ = shape_;
        v_.assign(y_.size(), 0.0);
        before_ = start_;
        row_ = 0;
    }
    Status advance(const Block& out) noexcept override {
        for (int n = 0; n < out.rows; ++n, ++row_) {
            for (int k = 0; k < out.taps; ++k) {
                const auto& of = scene_.taps[k].quantity == Quantity::velocity ? v_ : y_;
                double sum = 0;
                for (std::size_t i = 0; i < of.size(); ++i) sum += weights_[k][i] * of[i];
                out.tap[n + k * out.stride] = sum;
            }
            const double now = stored();
            if (out.energy) write_energy(out, n, now, 0, before_ - now);
            spoil(out, n);
            before_ = now;
            for (std::size_t i = 0; i < y_.size(); ++i) {
                const double y = y_[i], v = v_[i];
                y_[i] = steps_[i].yy * y + steps_[i].yv * v;
                v_[i] = steps_[i].vy * y + steps_[i].vv * v;
            }
        }
        return {};
    }
    int dofs() const override { return static_cast<int>(y_.size() + v_.size()); }

    // What a fault breaks in a row that is written: row n of the block, row_ of the run.
    virtual void spoil(const Block&, int /*n*/) noexcept {}

    struct Step {
        double yy, yv, vy, vv;
    };
    double stored() const {
        double sum = 0;
        for (std::size_t i = 0; i < y_.size(); ++i)
            sum += 0.5 * modes_.mass *
                   (v_[i] * v_[i] + modes_.omega0[i] * modes_.omega0[i] * y_[i] * y_[i]);
        return sum;
    }

    Scene scene_;
    Modes modes_;
    std::vector<Step> steps_;
    std::vector<std::vector<double>> weights_;
    std::vector<double> shape_, y_, v_;
    double start_ = 0, before_ = 0;  // stored at the start, in the row before [J]
    long row_ = 0;                   // the next
};

template <class Made>
std::unique_ptr<Scheme> planted(const Descriptor&, const Scene& scene, const Settings& settings) {
    return std::make_unique<Made>(scene, settings);
}

}  // namespace jvari

#define JVARI_PLANTED(name, Made)                                                            \
    static const jvari::Descriptor table[] = {{#name, "a test", jvari::honest_features,      \
                                               jvari::Balance::exact, jvari::Clock::stepped, \
                                               jvari::planted<Made>}};                       \
    JVARI_PLUGIN(table)

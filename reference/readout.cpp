#include "reference/readout.hpp"

#include <utility>

#include "reference/masses.hpp"
#include "reference/partial_sums.hpp"

namespace jvari {

JVARI_CLONES
double weighted_sum(const double* w, const double* y, int count) {
    double sum[8] = {};
    int i = 0;
    for (; i + 8 <= count; i += 8)
        for (int k = 0; k < 8; ++k) sum[k] += w[i + k] * y[i + k];
    for (; i < count; ++i) sum[0] += w[i] * y[i];
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}

Readout::Readout(const Scene& scene, const Modes& modes) : modes_(modes.count()) {
    for (const Mass& m : scene.strings.front().masses) {
        mass_.push_back(m);
        share_.push_back(share_of(modes, m));
    }
    momentum_.resize(mass_.size());
    force_ = momentum_;
    for (const Tap& tap : scene.taps) {
        quantity_.push_back(tap.quantity);
        of_mass_.push_back(tap.mass.value_or(-1));
        std::vector<double> w(modes_, 0.0);
        if (tap.mass) w[modes_ - masses() + *tap.mass] = share_[*tap.mass];
        else if (tap.quantity == Quantity::displacement || tap.quantity == Quantity::velocity)
            w = displacement_weights(modes, tap.position);
        if (tap.quantity == Quantity::nut_force)
            w = nut_force_weights(modes, scene.strings.front());
        w = weights_below(tap.below, std::move(w), modes);
        weights_.insert(weights_.end(), w.begin(), w.end());
    }
}

void Readout::begin(const double* u, double rate, double tap_rate) {
    tap_rate_ = tap_rate;
    started_ = false;
    for (int m = 0; m < masses(); ++m)
        momentum_[m] = mass_[m].mass * share_[m] * u[modes_ - masses() + m] * rate;
}

void Readout::write(const Block& out, int row, const double* y, const double* u, double rate,
                    double bridge, double thread, const std::vector<double>& impulse) const {
    for (int m = 0; m < masses(); ++m) {
        const double now = mass_[m].mass * share_[m] * u[modes_ - masses() + m] * rate;
        // row 0 has no interval before
        const double weight = started_ ? mass_[m].weight : 0;
        bridge -= force_[m] =
            mass_[m].joined() ? tap_rate_ * impulse[m] : tap_rate_ * (momentum_[m] - now) + weight;
        momentum_[m] = now;
    }
    started_ = true;
    for (int k = 0; k < out.taps; ++k) {
        const double* w = weights_.data() + static_cast<long>(k) * modes_;
        double v = 0;
        switch (quantity_[k]) {
            case Quantity::displacement:
                v = weighted_sum(w, y, modes_);
                if (of_mass_[k] >= 0 && mass_[of_mass_[k]].spring > 0)
                    v += mass_[of_mass_[k]].rest();
                break;
            case Quantity::nut_force: v = weighted_sum(w, y, modes_); break;
            case Quantity::velocity: v = weighted_sum(w, u, modes_) * rate; break;
            case Quantity::bridge_force: v = of_mass_[k] < 0 ? bridge : force_[of_mass_[k]]; break;
            case Quantity::thread_force: v = thread; break;
            case Quantity::driving_force: v = -(bridge + thread); break;
        }
        out.tap[k * out.stride + row] = v;
    }
}

}  // namespace jvari

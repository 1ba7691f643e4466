// Masses that meet a string from below: each is one more mode, with frequency 0 and weight -1 at
// its contact, which reads y - z and pushes string and mass with opposite equal forces.
//
//     d = the way of a mass in a step, d <- d - dt^2/m F,   z <- z + d
//
// In two-point steps z^{n+1} = z^n + d - dt^2/2m F, with v = d/dt at n. In three-point ones d = z^n
// - z^{n-1}, and z is one step ahead, like the string. Both keep m d^2/(2 dt^2) + the contact's
// energy: the invariant in string_step.hpp. Under forces that are lines in the step the motion is
// exact:
//
//     z <- z + d - dt^2/m (phi_0/2 - phi_1/6),   d <- d - dt^2/m phi_0
#pragma once

#include <algorithm>
#include <vector>

#include "schemes/driver/string_step.hpp"

namespace jvari {

template <int levels, int moments = 1>
class FreeMasses {
public:
    explicit FreeMasses(const StringPoints& p)
        : masses_(p.masses), first_(p.contacts.count() - static_cast<int>(masses_.size())) {
        for (const Tap& tap : masses_.empty() ? std::vector<Tap>() : p.taps)
            taps_.push_back({tap.quantity, tap.mass.value_or(-1)});
        dt_ = p.dt;
        z_.resize(masses_.size());
        d_ = z_;
        heard_.resize(p.count());
        clear();
    }

    bool empty() const { return masses_.empty(); }
    int dofs() const { return 2 * static_cast<int>(masses_.size()); }

    void clear() noexcept {
        for (std::size_t k = 0; k < masses_.size(); ++k)
            z_[k] = -masses_[k].gap, d_[k] = dt_ * masses_[k].velocity;
    }
    // Theta for a step that spans this many dt, row-major over the points [m/N]
    std::vector<double> yielding(std::vector<double> theta, int span) const {
        const std::size_t P = heard_.size(), all = moments * P;
        for (std::size_t k = 0; k < masses_.size(); ++k) {
            const std::size_t a = first_ + k;
            theta[a * (all + 1)] += span * yields(k);
            if constexpr (moments == 2) {
                theta[a * all + P + a] -= yields(k) / 3;
                theta[(P + a) * all + a] += yields(k) / 3;
            }
        }
        return theta;
    }
    // Turns the string's readings into the contacts': `steps` is counted from the instant of z. The
    // second function does the same for the way in `steps`.
    void subtract(double* reading, double steps) const noexcept {
        for (std::size_t k = 0; k < masses_.size(); ++k)
            reading[first_ + k] -= z_[k] + steps * d_[k];
    }
    void subtract_way(double* increment, double steps) const noexcept {
        for (std::size_t k = 0; k < masses_.size(); ++k) increment[first_ + k] -= steps * d_[k];
    }
    void approach() noexcept {  // the string's
        for (std::size_t k = 0; levels == 2 && k < z_.size(); ++k) z_[k] += d_[k];
    }
    void pass(const double* force) noexcept {
        for (std::size_t k = 0; k < z_.size(); ++k) {
            if (levels == 1) z_[k] += d_[k] - yields(k) * force[first_ + k];
            if (moments == 2) z_[k] += yields(k) / 3 * force[heard_.size() + first_ + k];
            d_[k] -= 2 * yields(k) * force[first_ + k];
        }
    }
    // the first half step of a three-point scheme
    void start(const double* force) noexcept {
        for (std::size_t k = 0; k < z_.size(); ++k) d_[k] -= yields(k) * force[first_ + k];
    }
    double stored() const noexcept {
        double sum = 0;
        for (std::size_t k = 0; k < z_.size(); ++k)
            sum += 0.5 * masses_[k].mass * (d_[k] / dt_) * (d_[k] / dt_);
        return sum;
    }

    // Forces that the taps hear: `mean` for all points without the masses; the masses' own taps
    // overwrite the result.
    const double* unheard(const double* mean) noexcept {
        std::copy_n(mean, heard_.size(), heard_.begin());
        std::fill_n(heard_.begin() + first_, masses_.size(), 0.0);
        return heard_.data();
    }
    void write(const Block& out, int row, const double* mean, const double* force) const noexcept {
        for (std::size_t t = 0; t < taps_.size(); ++t) {
            const auto [quantity, k] = taps_[t];
            if (k < 0) continue;
            // in three-point schemes d belongs to the half step after the row
            const double back = levels == 2 ? yields(k) * force[first_ + k] : 0;
            out.tap[t * out.stride + row] = quantity == Quantity::displacement ? z_[k]
                                            : quantity == Quantity::velocity ? (d_[k] + back) / dt_
                                                                             : mean[first_ + k];
        }
    }

private:
    struct Heard {
        Quantity quantity;
        int mass;  // -1: the string
    };
    double yields(std::size_t k) const { return 0.5 * dt_ * dt_ / masses_[k].mass; }

    std::vector<Mass> masses_;
    std::vector<Heard> taps_;
    int first_;  // index of their first contact
    double dt_ = 0;
    std::vector<double> z_, d_, heard_;  // [m], [m], [N]
};

}  // namespace jvari

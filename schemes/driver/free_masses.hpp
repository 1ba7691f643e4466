// Masses that meet a string from below: each is one more mode, free or on a spring and a damper.
// Its weight is -1 at its contact, which reads y - z and pushes string and mass with opposite equal
// forces. With x = z - rest() and the coefficients of modal_coefficients.hpp, d is the way of a
// mass in a step without its contact:
//
//     two-point    s = d - f,   z <- z + s,   d <- s - f - 4A/J x - 2B/J s + 2 w,   J = 1 + A + B
//     three-point  z <- z + d,  d <- C~ d - kappa x + 2 w - 2 f
//
// f = dt^2/(2 m J) F for the contact force F, w the same for a weight without a spring; J = 1 in
// three points. A free mass keeps d <- d - 2 f. In two-point steps the speed at n is v = (J (d - w)
// + 2 A x)/dt. In three-point ones d = z^n - z^{n-1}, and z is one step ahead, like the string.
// Both keep the invariant in string_step.hpp with the energies below. Under forces that are lines
// in the step the motion of a free mass is exact:
//
//     z <- z + d - dt^2/m (phi_0/2 - phi_1/6),   d <- d - dt^2/m phi_0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "schemes/driver/string_step.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

template <int levels, int moments = 1>
class FreeMasses {
public:
    explicit FreeMasses(const StringPoints& p)
        : first_(p.contacts.count() - static_cast<int>(p.masses.size())), dt_(p.dt) {
        for (const Tap& tap : p.masses.empty() ? std::vector<Tap>() : p.taps)
            taps_.push_back({tap.quantity, tap.mass.value_or(-1)});
        for (const Mass& m : p.masses) masses_.emplace_back(m, dt_);
        heard_.resize(p.count());
        clear();
    }

    bool empty() const { return masses_.empty(); }
    int dofs() const { return 2 * static_cast<int>(masses_.size()); }

    void clear() noexcept {
        for (One& m : masses_) {
            m.z = -m.of.gap;
            m.d = m.first_way();
            m.back = levels == 2 ? dt_ * m.of.velocity - m.d : 0;
        }
    }
    // Theta for a step that spans this many dt, row-major over the points [m/N]
    std::vector<double> yielding(std::vector<double> theta, int span) const {
        const std::size_t P = heard_.size(), all = moments * P;
        for (std::size_t k = 0; k < masses_.size(); ++k) {
            const std::size_t a = first_ + k;
            const double yields = masses_[k].yields;
            theta[a * (all + 1)] += span * yields;
            if constexpr (moments == 2) {
                theta[a * all + P + a] -= yields / 3;
                theta[(P + a) * all + a] += yields / 3;
            }
        }
        return theta;
    }
    // Turns the string's readings into the contacts': `steps` is counted from the instant of z.
    void subtract(double* reading, double steps) const noexcept {
        for (std::size_t k = 0; k < masses_.size(); ++k)
            reading[first_ + k] -= masses_[k].z + steps * masses_[k].d;
    }
    // The same for the way in a step of the scheme, and in the first half step of three points.
    void subtract_way(double* increment, double steps) const noexcept {
        for (std::size_t k = 0; k < masses_.size(); ++k)
            increment[first_ + k] -= steps == 2 ? masses_[k].d + masses_[k].next : masses_[k].d;
    }
    // for the way in dt by the speeds at t = 0
    void subtract_speed(double* way) const noexcept {
        for (std::size_t k = 0; k < masses_.size(); ++k)
            way[first_ + k] -= dt_ * masses_[k].of.velocity;
    }
    void approach() noexcept {  // the string's
        if (levels == 1) return;
        for (One& m : masses_) {
            m.z += m.d;
            m.next = m.d - m.loss * m.d - m.pull * m.x() + 2 * m.fall;
        }
    }
    // Returns the loss by dampers [J].
    double pass(const double* force) noexcept {
        double lost = 0;
        for (std::size_t k = 0; k < masses_.size(); ++k) {
            One& m = masses_[k];
            const double F = force[first_ + k];
            if (levels == 1) {
                const double s = m.d - m.yields * F;
                m.z += s;
                if (moments == 2) m.z += m.yields / 3 * force[heard_.size() + first_ + k];
                m.d = m.d - 2 * m.yields * F - m.pull * m.x() - m.loss * s + 2 * m.fall;
                lost += m.inertia() * m.loss * s * s;
            } else {
                const double before = m.d;
                m.d = m.next - 2 * m.yields * F;
                m.back = m.yields * F + 0.5 * (before - m.next);
                lost += 0.25 * m.inertia() * m.loss * (m.d + before) * (m.d + before);
            }
        }
        return lost;
    }
    // the first half step of a three-point scheme
    void start(const double* force) noexcept {
        for (std::size_t k = 0; k < masses_.size(); ++k) {
            One& m = masses_[k];
            m.d -= m.yields * force[first_ + k];
            m.back += m.yields * force[first_ + k];
        }
    }
    double stored() const noexcept {
        double sum = 0;
        for (const One& m : masses_) sum += levels == 1 ? m.stored() : m.stored_between();
        return sum;
    }

    // Forces that the taps hear: `mean` for all points without the masses; the masses' own taps
    // overwrite the result.
    const double* unheard(const double* mean) noexcept {
        std::copy_n(mean, heard_.size(), heard_.begin());
        std::fill_n(heard_.begin() + first_, masses_.size(), 0.0);
        return heard_.data();
    }
    void write(const Block& out, int row, const double* mean) const noexcept {
        for (std::size_t t = 0; t < taps_.size(); ++t) {
            const auto [quantity, k] = taps_[t];
            if (k < 0) continue;
            const One& m = masses_[k];
            out.tap[t * out.stride + row] = quantity == Quantity::displacement ? m.z
                                            : quantity == Quantity::velocity   ? m.speed()
                                                                               : mean[first_ + k];
        }
    }

private:
    struct Heard {
        Quantity quantity;
        int mass;  // -1: the string
    };
    struct One {
        Mass of;
        double dt;
        ModeStep step;
        double J, yields, pull, loss, fall;
        // next: d without the contact; back: from d to the speed at the row, in three points
        double z = 0, d = 0, next = 0, back = 0;  // [m]

        One(const Mass& m, double dt)
            : of(m),
              dt(dt),
              step(exact_step(std::sqrt(m.spring / m.mass), 0.5 * m.damping / m.mass, dt)),
              J(levels == 1 ? 1 + step.A() + step.B() : 1),
              yields(0.5 * dt * dt / m.mass / J),
              pull(levels == 1 ? 4 * step.A() / J : step.num),
              loss(levels == 1 ? 2 * step.B() / J : step.loss),
              fall(m.spring > 0 ? 0 : yields * m.weight) {}
        double x() const { return z - of.rest(); }
        double inertia() const { return of.mass * J / (dt * dt); }  // [kg/s^2]
        double falls() const { return of.spring > 0 ? 0 : of.weight; }
        // d at t = 0; in three points the exact way in dt
        double first_way() const {
            if (levels == 1) return (dt * of.velocity - 2 * step.A() * x()) / J + fall;
            const ExactWay way =
                exact_way(std::sqrt(of.spring / of.mass), 0.5 * of.damping / of.mass, dt);
            return way.start * x() + way.drift() * of.velocity + fall;
        }
        double speed() const {
            return levels == 1 ? (J * (d - fall) + 2 * step.A() * x()) / dt : (d + back) / dt;
        }
        double stored() const {
            const double v = speed();
            return 0.5 * of.mass * v * v + 0.5 * inertia() * pull * x() * x() - falls() * z;
        }
        double stored_between() const {  // rows n and n + 1
            const double v = d / dt;
            return 0.5 * of.mass * v * v * (1 - 0.5 * loss) +
                   0.5 * inertia() * pull * x() * (x() + d) - falls() * (z + 0.5 * d);
        }
    };

    std::vector<One> masses_;
    std::vector<Heard> taps_;
    int first_;  // index of their first contact
    double dt_ = 0;
    std::vector<double> heard_;  // [N]
};

}  // namespace jvari

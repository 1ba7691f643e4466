// Steps the body's modes as oscillators, in the form of the scheme that steps the strings. The
// coefficients of modal_coefficients.hpp give exact frequency and decay, so that a free body sounds
// right at any rate.
#pragma once

#include <cmath>
#include <vector>

#include "schemes/body/body_step.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

// Throws Refusal: above half the rate the mode would alias.
void must_be_below_half_the_rate(const BodyMode&, double dt);

template <class Mode>
class BodyOf {
public:
    int modes() const { return static_cast<int>(modes_.size()); }
    void begin() noexcept {
        for (Mode& m : modes_) m.rest();
    }

protected:
    explicit BodyOf(double dt) : dt_(dt) {}
    template <class Make>  // called with angular frequency and decay rate
    void add(const std::vector<BodyMode>& modes, Make make) {
        for (const BodyMode& m : modes) {
            must_be_below_half_the_rate(m, dt_);
            modes_.push_back(make(m, std::sqrt(m.stiffness / m.mass), 0.5 * m.damping / m.mass));
        }
    }
    template <class Of>
    double sum(Of of) const {
        double all = 0;
        for (const Mode& m : modes_) all += of(m);
        return all;
    }
    double dt_;
    std::vector<Mode> modes_;
};

struct BodyMode2 {       // van Walstijn et al. 2016, eqs 38-43: zeta = dt/2 z'
    double A, B, J, xi;  // xi = dt^2/2M [s^2/kg]
    double z = 0, zeta = 0;
    double free() const { return 2 * (zeta - A * z) / J; }
    void rest() { z = zeta = 0; }
};
class TwoPointBody : public BodyOf<BodyMode2> {
public:
    static constexpr int levels = 1;  // from the older to the newer
    template <class Law>              // A, B for a mode: (omega0, sigma, dt)
    TwoPointBody(const std::vector<BodyMode>& modes, double dt, Law law) : BodyOf(dt) {
        add(modes, [&](const BodyMode& m, double omega0, double sigma) {
            const auto [A, B] = law(omega0, sigma, dt);
            return BodyMode2{A, B, 1 + A + B, 0.5 * dt * dt / m.mass};
        });
    }
    double beta() const {
        return sum([](const BodyMode2& m) { return m.xi / m.J; });
    }
    double kappa() const { return 0.5 * dt_ * dt_; }

    BodyMotion coming() const noexcept {
        BodyMotion b;
        for (const auto& m : modes_) {
            b.w += m.z;
            b.r += m.free();
            b.a -= 2 * (m.A * m.z + (m.A + m.B) * m.zeta) / m.J;  // free - 2 zeta
        }
        b.now = b.w;
        b.a /= kappa();
        return b;
    }
    BodyMoved pass(double f) noexcept {
        BodyMoved moved;
        for (auto& m : modes_) {
            const double s = m.free() + m.xi / m.J * f;
            m.z += s;
            m.zeta = s - m.zeta;
            moved.r += s;
            moved.lost += m.B * s * s / m.xi;
        }
        return moved;
    }
    double displacement(int) const noexcept {
        return sum([](const BodyMode2& m) { return m.z; });
    }
    double velocity() const noexcept {  // at the row's instant
        return 2 / dt_ * sum([](const BodyMode2& m) { return m.zeta; });
    }
    double velocity_stored() const noexcept { return velocity(); }  // at the energy's instant
    double stored() const noexcept {
        return sum([](const BodyMode2& m) { return (m.zeta * m.zeta + m.A * m.z * m.z) / m.xi; });
    }
};

// Issanchou et al. 2016, eq 14, in displacement and increments
struct BodyMode3 {
    double mass, loss, kappa;  // [kg]; 1 - C~, 1 + C~ - C
    // z^n, z^{n+1} - z^n, z^n - z^{n-1}
    double z = 0, d = 0, last = 0;
    double free() const { return (1 - loss) * d - kappa * (z + d); }  // the increment after d
    void rest() { z = d = last = 0; }
};
class ThreePointBody : public BodyOf<BodyMode3> {
public:
    static constexpr int levels = 2;
    ThreePointBody(const std::vector<BodyMode>& modes, double dt) : BodyOf(dt) {
        add(modes, [&](const BodyMode& m, double omega0, double sigma) {
            const ModeStep s = exact_step(omega0, sigma, dt);
            return BodyMode3{m.mass, s.loss, s.num};
        });
    }
    double beta() const {
        return sum([this](const BodyMode3& m) { return dt_ * dt_ / m.mass; });
    }
    double kappa() const { return dt_ * dt_; }
    double least_mass() const {  // mass that its energy shows against a velocity of w [kg]
        return 1 / sum([](const BodyMode3& m) {
                   return 1 / (m.mass * (1 - 0.5 * m.loss - 0.25 * m.kappa));
               });
    }
    void start(double f) noexcept {  // level 1 from rest: z^{-1} = z^1
        for (auto& m : modes_) {
            m.d = 0.5 * dt_ * dt_ / m.mass * f;
            m.last = -m.d;
        }
    }
    BodyMotion coming() const noexcept {  // for the step centred on the level after z^n
        BodyMotion b;
        for (const auto& m : modes_) {
            b.w += m.z;
            b.now += m.z + m.d;
            b.r += m.free() + m.d;
            b.a -= m.loss * m.d + m.kappa * (m.z + m.d);
        }
        b.a /= kappa();
        return b;
    }
    BodyMoved pass(double f) noexcept {
        BodyMoved moved;
        for (auto& m : modes_) {
            const double next = m.free() + dt_ * dt_ / m.mass * f;
            m.z += m.d;
            m.last = m.d;
            m.d = next;
            const double r = m.d + m.last;
            moved.r += r;
            moved.lost += 0.25 * m.mass * m.loss * r * r / (dt_ * dt_);
        }
        return moved;
    }
    double displacement(int level) const noexcept {  // 0: at the row; 1: after it
        return sum([level](const BodyMode3& m) { return m.z + (level == 1 ? m.d : 0); });
    }
    double velocity() const noexcept {
        return 0.5 * sum([](const BodyMode3& m) { return m.d + m.last; }) / dt_;
    }
    double velocity_stored() const noexcept {
        return sum([](const BodyMode3& m) { return m.d; }) / dt_;
    }
    double stored() const noexcept {
        return sum([](const BodyMode3& m) {
                   return 0.5 * m.mass *
                          (0.5 * (2 - m.loss) * m.d * m.d + m.kappa * m.z * (m.z + m.d));
               }) /
               (dt_ * dt_);
    }
};

}  // namespace jvari

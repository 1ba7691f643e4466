// String in its modes by three-point steps: Issanchou et al. 2016, eqs 14 and 20-21, in increments
// d^n = q^n - q^{n-1}:
//
//     d^{n+1} = C~ d^n - kappa q^n + sum_p e_p F_p,   q^{n+1} = q^n + d^{n+1},   e_p = gain g_p;
//     r_p = y_p^{n+1} - y_p^{n-1}
//
// which is q^{n+1} = C q^n - C~ q^{n-1} + ... without its cancellation at high rates, kappa = 1 +
// C~ - C. Theta_pq = g_p.e_q. gain = dt^2/m unless a scheme says otherwise; W, the inertia in its
// energy, is then the modal mass. Points are places on the string, read and pushed by weights on
// the modes. They can also be nodes on a grid with equally many interior nodes and modes; such
// nodes are orthogonal to each other.
//
// Stored energy is eq 21 with C1 = (1 + C~)/2, C2 = kappa/dt^2, C3 = loss/dt: sum W [(1 + C~)/2 d^2
// + kappa q (q + d)]/(2 dt^2), d = d^{n+1}; lost in a step: sum W loss (d^{n+1} + d^n)^2/(4 dt^2).
// Order: free motion is exact. Forced motion is second order without losses and first order with
// them. The reason is that eq 14 puts dt^2/m F on a mode, while a damped mode needs e^{-sigma dt}
// times this force (a factor per mode would couple the nodes, so the paper's form is kept). Start:
// the free motion from rest, and every force on the first half step with half its weight. Velocity
// comes from the free motion through levels n-1, n, n+1 corrected for F^n, for the modes that
// determine it, and from a centred difference for the rest (three_point.hpp).
//
// Form steps the modes: kernels/three_point_pass.hpp, or another class with the same members.
#pragma once

#include <cmath>
#include <numbers>

#include "scenes/excitation.hpp"
#include "scenes/start.hpp"
#include "schemes/body/body_modes.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/modal/kernels/three_point_pass.hpp"
#include "schemes/modal/modal_string.hpp"
#include "schemes/modal/three_point.hpp"

namespace jvari {

// Gain for a mode, over dt^2/m. nullptr: 1. A gain that differs from mode to mode balances with W =
// dt^2/gain in place of m.
using ModalGain = double (*)(double omega0, double sigma, double dt);

// One scene and setting, reduced to numbers before a form is chosen.
struct ThreePointProblem {
    Scene scene;  // with one string
    double dt = 0;
    Modes modes;
    ModalStart start;
    std::vector<double> first;  // y^1 - y^0 for each mode without contacts and pluck [m]
    ThreePoint three_point;
    std::vector<double> W;  // [kg]
    // ports: contacts, thread and moving body, which all are read, and the pluck
    LinearUpdate update;
    StringPoints points;
    std::vector<std::vector<double>> theta;  // from each port to every read [m/N]
    std::vector<Fact> facts;                 // in addition to the string's
    bool on_body = false;
    const String& string() const { return scene.strings.front(); }
    // H^{n+1/2} for y = y^n and d = y^{n+1} - y^n  (21) [J]
    double stored(const std::vector<double>& y, const std::vector<double>& d) const {
        double H = 0;
        for (int j = 0; j < modes.count(); ++j)
            H += W[j] *
                 (0.5 * (1 + update.Ct[j]) * d[j] * d[j] + update.kappa[j] * y[j] * (y[j] + d[j]));
        return 0.5 * H / (dt * dt);
    }
    std::vector<FreeMode> free_modes() const {
        std::vector<FreeMode> all;
        for (int j = 0; j < modes.count(); ++j)
            all.push_back(three_point_mode(three_point.kappa[j], three_point.loss[j], dt));
        return all;
    }
};
// Takes the modes unchanged, their points by footprint weights, a profile by separate points.
// Refuses modes above half the rate.
ThreePointProblem problem_of_modes(const Descriptor&, const Scene&, const Settings&,
                                   ModalGain = nullptr);
// Completes p, which has points and update.ports for its contacts: adds the remaining points and
// ports, and the members that follow from them.
void complete(ThreePointProblem& p, const Descriptor&, const Settings&, ModalGain = nullptr);

template <class Form>
class ThreePointModesBy {
public:
    static constexpr int levels = 2;
    // a step with many coupled points takes tens of microseconds
    static constexpr long steps_between_looks = 64;

    explicit ThreePointModesBy(ThreePointProblem problem)
        : p_(std::move(problem)), form_(p_.update) {
        for (const Tap& tap : p_.scene.taps) readings_.push_back(reading_of(tap));
        const std::size_t reads = p_.update.reads;
        for (auto* v : {&older_, &now_, &coming_, &read_, &free_}) v->assign(reads, 0.0);
        for (auto* v : {&force_, &earlier_force_}) v->assign(p_.update.ports.size(), 0.0);
        for (auto* v : {&modal_now_, &modal_last_, &modal_coming_})
            v->assign(p_.modes.count(), 0.0);
        if (p_.on_body)
            drift_of_body_ =
                p_.dt * modal_dot(p_.update.ports[p_.points.count()].weights, p_.start.velocity);
        pluck_port_ = p_.points.pluck ? static_cast<int>(reads) : -1;
        for (std::size_t z = 0; z < reads; ++z)
            for (std::size_t c = 0; c < reads; ++c)
                coupled_ = coupled_ || (z != c && p_.theta[c][z] != 0);
        reset();
    }

    const StringPoints& points() const { return p_.points; }
    ThreadStart thread_start() const {
        return p_.points.series ? ThreadStart::plain : ThreadStart::taut;
    }
    ReadingsBeforeStep readings() const { return {older_.data(), now_.data(), free_.data()}; }

    void reset() noexcept {
        modal_now_ = p_.start.displacement;
        modal_coming_ = p_.first;
        form_.start(modal_now_.data(), modal_coming_.data());
        form_.read(read_.data());
        for (int z = 0; z < p_.update.reads; ++z)
            now_[z] = older_[z] = modal_dot(p_.update.ports[z].weights, modal_now_);
        step_ = 0;
        std::fill(force_.begin(), force_.end(), 0.0);
        if (pluck_port_ >= 0) push_by_pluck();
        from(older_);
        inertia_ = p_.on_body ? 2 * (free_.back() - drift_of_body_) / (p_.dt * p_.dt) : 0;
    }
    void start(const double* force, double a) noexcept { put(force, a); }
    void approach(bool last_of_row) noexcept {
        if (last_of_row) keep();
        if (step_ == 0)
            for (double& f : force_) f *= applied();
        form_.advance(force_.data(), read_.data());
        older_.swap(now_);
        now_.swap(coming_);
        ++step_;
        if (pluck_port_ >= 0) push_by_pluck();
        from(older_);
        if (p_.on_body)
            inertia_ = (read_.back() - 2 * now_.back() + older_.back()) / (p_.dt * p_.dt);
    }
    Spent pass(const double* force, double a, bool probed) noexcept {
        put(force, a);
        return probed ? account() : Spent{};
    }
    bool failed() const { return failed_; }
    void reading(int level, double* out) const noexcept {
        std::copy_n((level == 0 ? now_ : coming_).begin(), p_.points.count(), out);
    }

    double stored() noexcept {  // H^{n+1/2}  (21)
        form_.to_modal(form_.levels.displacement, modal_now_.data());
        fill_coming();
        return p_.stored(modal_now_, modal_coming_);
    }
    double tap(int k, const double* mean) const noexcept {
        const TapReading& r = readings_[k];
        if (r.displacement.empty()) return heard_force(r.quantity, p_.points, mean);
        if (r.quantity != Quantity::velocity)
            return modal_dot(r.displacement, form_.levels.displacement);
        if (step_ == 0) return r.at_start;
        double v = modal_dot(r.displacement, form_.levels.displacement) +
                   modal_dot(r.increment, form_.levels.increment);
        if (differenced_) v += modal_dot(r.kept, form_.levels.kept);
        for (std::size_t z = 0; z < r.force.size(); ++z)
            v += r.force[z] * force_[z] + r.earlier_force[z] * earlier_force_[z];
        return v;
    }

    int dofs() const { return 2 * p_.update.modes(); }
    std::vector<Fact> facts() const { return p_.facts; }
    std::vector<FreeMode> free_modes() const { return p_.free_modes(); }

    // ---- On a body (schemes/body/instrument.hpp)

    double inertia() const { return inertia_; }
    double pluck() const { return pluck_port_ >= 0 ? force_[pluck_port_] : 0; }
    double share() const {
        const auto& mu = p_.update.ports[p_.points.count()].weights;
        double sum = 0;
        for (int j = 0; j < p_.modes.count(); ++j)  // for the mass in H, C1 - dt^2/4 C2 (22)
            sum += mu[j] * mu[j] /
                   (p_.modes.mass *
                    (1 - 0.5 * p_.three_point.loss[j] - 0.25 * p_.three_point.kappa[j]));
        return sum;
    }
    double momentum() noexcept {  // sum mu_j v_j at the half step
        fill_coming();
        return modal_dot(p_.update.ports[p_.points.count()].weights, modal_coming_) / p_.dt;
    }

private:
    struct TapReading {
        Quantity quantity;
        AlignedVector displacement, increment, kept;  // weights on the form's levels
        std::vector<double> force, earlier_force;     // velocity: weights on F^n and F^{n-1}
        double at_start = 0;                          // velocity at t = 0 [m/s]
    };
    // part of its force that a step applies: half in the first half step only
    double applied() const { return step_ == 0 ? 0.5 : 1; }

    void keep() noexcept {  // before the last step of a row
        if (!differenced_) return;
        form_.levels.keep();
        std::copy(force_.begin(), force_.end(), earlier_force_.begin());
        for (double& f : earlier_force_) f *= applied();
    }
    void push_by_pluck() noexcept {
        const double F_e = mean_about(*p_.points.pluck, static_cast<double>(step_) * p_.dt, p_.dt);
        force_[pluck_port_] = F_e;
        for (std::size_t z = 0; F_e != 0 && z < read_.size(); ++z)
            read_[z] += applied() * p_.theta[pluck_port_][z] * F_e;
    }
    void from(const std::vector<double>& older) noexcept {
        double all = 0;
        for (std::size_t z = 0; z < free_.size(); ++z) {
            free_[z] = read_[z] - older[z];
            all += read_[z];
        }
        failed_ = !(std::abs(all) < modal_overflow);
    }
    // applies the step's forces, and computes their effect on its newer level
    void put(const double* force, double a) noexcept {
        const double share = applied();
        const std::size_t points = p_.points.count(), reads = read_.size();
        std::copy_n(force, points, force_.begin());
        if (p_.on_body) force_[points] = -a;
        for (std::size_t z = 0; z < reads; ++z) {
            coming_[z] = read_[z] + share * p_.theta[z][z] * force_[z];
            for (std::size_t c = 0; coupled_ && c < reads; ++c)
                if (c != z) coming_[z] += share * p_.theta[c][z] * force_[c];
        }
    }

    void fill_coming() noexcept {  // y^{n+1} - y^n with the force in step n
        form_.to_modal(form_.levels.increment, modal_coming_.data());
        for (std::size_t z = 0; z < p_.update.ports.size(); ++z)
            if (force_[z] != 0)
                for (int j = 0; j < p_.modes.count(); ++j)
                    modal_coming_[j] += applied() * force_[z] * p_.update.gain_of(j) *
                                        p_.update.ports[z].weights[j];
    }
    Spent account() noexcept {  // energy that step n supplied and dissipated
        modal_last_.swap(modal_coming_);
        fill_coming();
        Spent spent;
        for (int j = 0; j < p_.modes.count(); ++j) {  // (20)
            const double r = modal_coming_[j] + modal_last_[j];
            spent.dissipated += p_.W[j] * p_.three_point.loss[j] * r * r;
        }
        spent.dissipated /= 4 * p_.dt * p_.dt;
        if (const double F_e = pluck(); F_e != 0) {
            const auto& g = p_.update.ports[pluck_port_].weights;
            for (int j = 0; j < p_.modes.count(); ++j)
                spent.supplied += g[j] * (modal_coming_[j] + modal_last_[j]);
            spent.supplied *= 0.5 * F_e;
        }
        return spent;
    }

    TapReading reading_of(const Tap& tap) {
        TapReading r{tap.quantity, {}, {}, {}, {}, {}, 0};
        const auto w = tap_weights(tap, p_.modes, p_.string());
        if (tap.quantity != Quantity::velocity) {
            if (!w.empty()) r.displacement = form_.reading(w);
            return r;
        }
        const int n = p_.modes.count();
        std::vector<double> y(n), d(n), kept(n), now(n), earlier(n);
        for (int j = 0; j < n; ++j) {
            const double G = p_.three_point.velocity[j], half = 0.5 * w[j] / p_.dt;
            y[j] = G > 0 ? w[j] * (G * (p_.three_point.kappa[j] + p_.three_point.loss[j]) -
                                   p_.modes.sigma[j])
                         : 0;
            d[j] = G > 0 ? 2 * G * w[j] : half;
            kept[j] = G > 0 ? 0 : half;
            now[j] = p_.update.gain_of(j) * (G > 0 ? G * w[j] : half);
            earlier[j] = p_.update.gain_of(j) * kept[j];
            differenced_ = differenced_ || G == 0;
        }
        r.at_start = modal_dot(w, p_.start.velocity);
        if (differenced_) form_.levels.listen();
        r.displacement = form_.reading(y);
        r.increment = form_.reading(d);
        r.kept = form_.reading(kept);
        for (const Port& port : p_.update.ports) {
            r.force.push_back(modal_dot(now, port.weights));
            r.earlier_force.push_back(modal_dot(earlier, port.weights));
        }
        return r;
    }

protected:
    ThreePointProblem p_;

private:
    Form form_;
    std::vector<TapReading> readings_;
    bool differenced_ = false;  // a velocity tap has modes near or above Nyquist
    bool coupled_ = false;      // reads by each other's forces: nodes are not
    bool failed_ = false;
    int pluck_port_ = -1;
    long step_ = 0;
    // levels n-1, n, n+1 at the reads [m]
    std::vector<double> older_, now_, coming_;
    // level n+1 without the points' forces, and from level n-1 to there
    std::vector<double> read_, free_;
    // F^n and, for velocity taps, F^{n-1} at each port [N]
    std::vector<double> force_, earlier_force_;
    double inertia_ = 0;        // sum mu v'' without forces [N]
    double drift_of_body_ = 0;  // dt sum mu v' at t = 0 [kg m]
    // y^n, y^n - y^{n-1}, y^{n+1} - y^n
    std::vector<double> modal_now_, modal_last_, modal_coming_;
};

extern template class ThreePointModesBy<ThreePointPass>;
using ThreePointModes = ThreePointModesBy<ThreePointPass>;
extern template class Driver<ThreePointModes>;

}  // namespace jvari

// The modal three-point recursion with one contact and one thread: Issanchou et al. 2016, eqs 14-21, in increments d^n = q^n - q^{n-1}:
//
//     d^{n+1} = C~ d^n - num q^n + sum_z e_z F_z^n,   q^{n+1} = q^n + d^{n+1},     e_z = gain g_z, gain = dt^2/m unless a scheme says else
//
// which is q^{n+1} = C q^n - C~ q^{n-1} + ... without its cancellation at high rates. The thread takes the mean of the two outer levels,
//     F_c = k_c [h_c - (y_c^{n+1} + y_c^{n-1})/2] - r_c (y_c^{n+1} - y_c^{n-1})/(2 dt),
// and is eliminated as in van Walstijn et al. 2016, eqs 45-47. How the contact force F_b follows is the Contact type's affair:
//
//     double first(eta, s0, theta)           F_b^0/2, where the mean increment of the first half step is s0 + theta F_b^0/2
//     double next(eta, eta_old, r0, theta)   F_b^n from eta^n, eta^{n-1} and y_b^{n+1} - y_b^{n-1} = r0 + theta F_b^n
//     void   settle(eta, eta_old)            the step is made: eta^{n+1}, eta^n
//     bool   solved()                        no step so far was left unsolved
//     double energy(eta, eta_old)            of the half step before, after `settle`;  energy_next(...) of the half step after, before it
//
// A Contact with `in_series` has the forces of barrier and thread at the instant instead (series_force.hpp), in place of the thread above.
//
// Start: the free motion that passes y0 at rest is also run back to t = -dt, and every force acts on the first half step with half its
// weight. (Without the thread's part of that a start from a bent thread is wrong to first order.)
// Rows: the energy of a row is the mean of its two half steps, contact forces and the ledger count row instants with half weight, so that
// stored[n] - stored[n-1] = supplied[n] - dissipated[n] holds to rounding where the scheme has a balance. Row 0 has the first half step's.
// The energy is eq 21 with the constants C1 = (1 + C~)/2, C2 = num/dt^2, C3 = loss/dt in a form that shows its sign,
//     sum W (den d^2 + num s^2)/(8 dt^2), s = q^{n+1} + q^n; W is the modal mass unless a scheme says else.
#pragma once

#include <cmath>
#include <utility>

#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/modal/kernels/modal_energies.hpp"
#include "schemes/modal/kernels/series_kernel.hpp"
#include "schemes/modal/modal_string.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

template <class Contact>
concept ActsInSeries = Contact::in_series;

template <class Contact>
class ModalThreePoint : public Scheme {
public:
    // gain: dt^2/m of each mode as the scheme has it; inertia: W.
    ModalThreePoint(ModalString string, const ModalArray& gain, ModalArray inertia, Contact contact)
        : m_(std::move(string)),
          contact_(contact),
          start_(contact),
          q_(m_.size),
          d_(m_.size),
          d0_(rest_increments(m_)),
          W_(std::move(inertia)) {
        W_.resize(m_.size);
        e_b_ = scaled(m_.g_b, gain);
        for (std::size_t i = 0; i < m_.g_b.size(); ++i)
            if (m_.num[i] > 0) compliance_ += m_.g_b[i] * e_b_[i] / m_.num[i];  // d = 0
        e_c_ = scaled(m_.g_c, gain);
        e_e_ = scaled(m_.g_e, gain);
        theta_.cc = modal_dot(m_.g_c, e_c_);
        theta_.bc = modal_dot(m_.g_b, e_c_);
        theta_.bb = modal_dot(m_.g_b, e_b_);
        theta_.be = modal_dot(m_.g_b, e_e_);
        theta_.ce = modal_dot(m_.g_c, e_e_);
        steady_ = couple(0.5 * m_.k_c + 0.5 * m_.r_c / m_.dt, m_.k_c);
        first_ = couple(0.5 * m_.k_c, 0.5 * m_.k_c);
        const bool barrier = !m_.g_b.empty(), thread = !m_.g_c.empty();
        const auto pass = ActsInSeries<Contact> ? three_point_pass_ahead : three_point_pass;
        rows_ = series_advance(barrier, thread);
        for (const ModalTap& tap : m_.taps) readable_ = readable_ && tap.quantity != Quantity::velocity;
        unplucked_ = pass(barrier, thread, false);
        plucked_ = pass(barrier, thread, true);
        pass_.size = m_.size;
        pass_.p = m_.loss.data();
        pass_.r = m_.num.data();
        pass_.g_b = m_.g_b.data();
        pass_.g_c = m_.g_c.data();
        pass_.e_b = e_b_.data();
        pass_.e_c = e_c_.data();
        pass_.e_e = e_e_.data();
        pass_.x = q_.data();
        pass_.v = d_.data();
        ModalThreePoint::reset();
    }

    void reset() noexcept override {
        q_ = m_.y0;
        d_ = d0_;
        now_.step = 0;
        contact_ = start_;
        status_ = {};
        now_.impulse_b = now_.impulse_c = supplied_ = dissipated_ = 0;
        now_.y_b = y_b_old_ = modal_dot(m_.g_b, q_);
        now_.y_c = y_c_old_ = modal_dot(m_.g_c, q_);
        r_b_ = r_c_ = 0;  // in the first step: the free increments of the first half, see solve()
        for (int i = 0; i < m_.size; ++i) {
            const double d = free_increment(i);
            if (!m_.g_b.empty()) r_b_ += m_.g_b[i] * d;
            if (!m_.g_c.empty()) r_c_ += m_.g_c[i] * d;
        }
        if constexpr (ActsInSeries<Contact>) {
            contact_.begin(now_.y_c);
            pass_.v_b = now_.y_b + r_b_;
            pass_.v_c = now_.y_c + r_c_;
        } else contact_.begin(m_.h_b - now_.y_b);
        solve();
    }

    Status advance(const Block& out) noexcept override {
        if (status_.outcome != Outcome::ok) return status_;
        if constexpr (ActsInSeries<Contact>) {
            contact_.probed = out.energy != nullptr;
            if (!contact_.probed && readable_) return advance_unprobed(out);
        }
        if (out.energy) probe();
        for (int row = 0; row < out.rows; ++row) {
            write(out, row);
            const double weight = now_.step == 0 ? 1 : 0.5;  // the forces of the first step have their half weight already
            now_.impulse_b = weight * now_.F_b;
            now_.impulse_c = weight * now_.F_c;
            supplied_ = dissipated_ = 0;
            if constexpr (ActsInSeries<Contact>) contact_.lost = 0;
            if (out.energy && now_.step > 0) ledger(0.5);
            for (int k = 0; k < m_.steps_per_row; ++k) {
                step();
                solve();
                if (out.energy) probe();
                if (out.stopped(k, steps_between_questions)) return {};
                if (k + 1 == m_.steps_per_row) break;
                now_.impulse_b += now_.F_b;
                now_.impulse_c += now_.F_c;
                if (out.energy) ledger(1);
            }
            now_.impulse_b += 0.5 * now_.F_b;
            now_.impulse_c += 0.5 * now_.F_c;
            if (out.energy) ledger(0.5);
            if constexpr (ActsInSeries<Contact>) dissipated_ += contact_.lost;
            if (!(std::abs(now_.y_b + now_.y_c) < modal_overflow)) return status_ = {Outcome::diverged, now_.step - 1};
            if (!contact_.solved()) return status_ = {Outcome::not_converged, now_.step - 1};
        }
        return {};
    }

    Status advance_unprobed(const Block& out) noexcept {
        SeriesRows rows{&m_, q_.data(), &contact_, &pass_, &theta_, &now_};
        status_ = rows_(rows, out);
        return status_;
    }

    int dofs() const override { return 2 * m_.count + (m_.g_b.empty() ? 0 : Contact::dofs); }
    std::vector<Fact> facts() const override {
        if (m_.g_b.empty()) return {};
        std::vector<Fact> f = contact_.facts();
        if constexpr (!ActsInSeries<Contact>) f.push_back({facts::static_compliance, compliance_ / m_.true_compliance});
        return f;
    }
    std::vector<FreeMode> free_modes() const override { return three_point_modes(m_); }

private:
    EliminatedThread couple(double phi, double k) const { return {k, phi, theta_.bb, theta_.bc, theta_.cc}; }
    static ModalArray scaled(const ModalArray& g, const ModalArray& gain) {
        ModalArray e = g;
        for (std::size_t i = 0; i < std::min(e.size(), gain.size()); ++i) e[i] *= gain[i];
        return e;
    }
    double free_increment(int i) const { return (1 - m_.loss[i]) * d_[i] - m_.num[i] * q_[i]; }
    double next_increment(int i) const {
        return free_increment(i) + (e_b_.empty() ? 0 : e_b_[i] * now_.F_b) + (e_c_.empty() ? 0 : e_c_[i] * now_.F_c) +
               (e_e_.empty() ? 0 : e_e_[i] * now_.F_e);
    }

    // The forces of step n from the dots that the last pass left.
    void solve() {
        if constexpr (ActsInSeries<Contact>) act();
        else solve_points();
    }
    void act() {
        const bool at_start = now_.step == 0;
        const double share = at_start ? 0.5 : 1, pluck = m_.pluck_at(now_.step);
        contact_.act(now_.y_b, now_.y_c, pluck, at_start);
        now_.F_e = share * pluck;
        now_.F_b = share * contact_.now.force.b;
        now_.F_c = share * contact_.now.force.c;
    }
    void solve_points() {
        const bool at_start = now_.step == 0;
        const EliminatedThread& c = at_start ? first_ : steady_;
        now_.F_e = (at_start ? 0.5 : 1) * m_.pluck_at(now_.step);
        const double rb = r_b_ + theta_.be * now_.F_e, rc = r_c_ + theta_.ce * now_.F_e;
        const double v_c = c.alone(m_.h_c - y_c_old_, rc);
        now_.F_b = 0;
        now_.F_c = v_c;
        increment_b_ = rb + theta_.bc * v_c;
        if (!m_.g_b.empty()) {
            now_.F_b = at_start ? contact_.first(m_.h_b - now_.y_b, increment_b_, c.theta)
                                : contact_.next(m_.h_b - now_.y_b, m_.h_b - y_b_old_, increment_b_, c.theta);
            now_.F_c -= c.beta * now_.F_b;
            increment_b_ += c.theta * now_.F_b;
        }
        increment_c_ = rc + theta_.bc * now_.F_b + theta_.cc * now_.F_c;
    }

    void push() {
        pass_.F_b = now_.F_b;
        pass_.F_c = now_.F_c;
        pass_.F_e = now_.F_e;
    }
    void probe() {  // the step in hand, for all that the energy columns ask of it
        push();
        energies_ = three_point_energies(pass_, W_.data(), m_.den.data(), now_.F_e != 0 ? m_.g_e.data() : nullptr);
    }
    void step() {
        push();
        if constexpr (ActsInSeries<Contact>) step_ahead();
        else step_and_settle();
        ++now_.step;
    }
    // The readings need the last pass and the forces alone: this pass runs beside the next forces.
    void step_ahead() {
        now_.y_b = pass_.v_b + theta_.bb * now_.F_b + theta_.bc * now_.F_c + theta_.be * now_.F_e;
        now_.y_c = pass_.v_c + theta_.bc * now_.F_b + theta_.cc * now_.F_c + theta_.ce * now_.F_e;
        (now_.F_e != 0 ? plucked_ : unplucked_)(pass_);
    }
    void step_and_settle() {
        (now_.F_e != 0 ? plucked_ : unplucked_)(pass_);
        if (!m_.g_b.empty()) {
            contact_.settle(m_.h_b - pass_.x_b, m_.h_b - now_.y_b);
            y_b_old_ = now_.y_b;
            now_.y_b = pass_.x_b;
            r_b_ = pass_.v_b;
        }
        y_c_old_ = now_.y_c;
        now_.y_c = pass_.x_c;
        r_c_ = pass_.v_c;
    }

    // Work and losses of the centred step n >= 1: F_e (y_e^{n+1} - y_e^{n-1})/2, W loss (d^{n+1} + d^n)^2/(4 dt^2), thread.
    void ledger(double weight) {
        const auto [loss, work] = energies_.spending;
        const double r_c = increment_c_;
        if constexpr (ActsInSeries<Contact>) dissipated_ += weight * loss / (4 * m_.dt * m_.dt);  // the thread's: at the row
        else dissipated_ += weight * (loss / (4 * m_.dt * m_.dt) + m_.r_c * r_c * r_c / (4 * m_.dt));
        supplied_ += weight * 0.5 * now_.F_e * work;
    }

    double half_step_energy(double yc, double yc_other, double contact, bool after) const {
        const double a = m_.h_c - yc, b = m_.h_c - yc_other;
        return modal_energy(after) + 0.25 * m_.k_c * (a * a + b * b) + contact;
    }
    double modal_energy(bool after) const { return (after ? energies_.after : energies_.before) / (8 * m_.dt * m_.dt); }

    double stored() const {
        if constexpr (ActsInSeries<Contact>)
            return contact_.energy() + (now_.step == 0 ? modal_energy(true) : 0.5 * (modal_energy(true) + modal_energy(false)));
        else return stored_at_half_steps();
    }
    double stored_at_half_steps() const {
        const bool at_start = now_.step == 0, barrier = !m_.g_b.empty();
        const double yb_next = (at_start ? now_.y_b : y_b_old_) + increment_b_, yc_next = (at_start ? now_.y_c : y_c_old_) + increment_c_;
        const double after =
            half_step_energy(now_.y_c, yc_next, barrier ? contact_.energy_next(m_.h_b - yb_next, m_.h_b - now_.y_b) : 0, true);
        if (at_start) return after;
        return 0.5 *
               (after + half_step_energy(now_.y_c, y_c_old_, barrier ? contact_.energy(m_.h_b - now_.y_b, m_.h_b - y_b_old_) : 0, false));
    }

    void write(const Block& out, int row) const {
        const double per_row = m_.steps_per_row;
        const auto velocity = [this](const ModalArray& weights) {  // centred; at rest in row 0
            double sum = 0;
            if (now_.step > 0)
                for (int i = 0; i < m_.size; ++i) sum += weights[i] * (next_increment(i) + d_[i]);
            return sum / (2 * m_.dt);
        };
        write_taps(out, row, m_.taps, q_, velocity, now_.impulse_b / per_row, now_.impulse_c / per_row);
        if constexpr (ActsInSeries<Contact>)
            for (int k = 0; k < out.taps; ++k)
                if (!m_.taps[k].weights.empty()) out.tap[k * out.stride + row] += contact_.on_tap(k);
        if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
    }

    ModalString m_;
    Contact contact_, start_;
    ModalArray q_, d_, d0_, W_, e_b_, e_c_, e_e_;
    double compliance_ = 0;  // under a steady force at the bridge [m/N]
    SeriesRows::Compliances theta_;
    EliminatedThread steady_, first_;
    ModalPass pass_;
    ThreePointEnergies energies_;
    ModalPassFunction unplucked_ = nullptr, plucked_ = nullptr;
    SeriesAdvance rows_ = nullptr;  // in series, where no energy is asked for
    bool readable_ = true;          // and all taps can be read without increments
    Status status_;
    SeriesRows::State now_;
    double y_b_old_ = 0, y_c_old_ = 0;          // at step n - 1 [m]
    double r_b_ = 0, r_c_ = 0;                  // force-free increments from n - 1 to n + 1 [m]
    double increment_b_ = 0, increment_c_ = 0;  // y^{n+1} - y^{n-1} with the forces; in the first step y^1 - y^0 [m]
    double supplied_ = 0, dissipated_ = 0;      // [J]
};

}  // namespace jvari

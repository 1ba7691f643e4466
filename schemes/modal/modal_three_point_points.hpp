// The three-point recursion of modal_three_point.hpp (Issanchou et al. 2016, eqs 14-21) with any number of points, coupled as they are:
//
//     d^{n+1} = C~ d^n - num q^n + sum_p e_p F_p,   e_p = gain g_p,   r_p = y_p^{n+1} - y_p^{n-1} = free_p + sum_q Theta_pq F_q,
//
// Theta_pq = g_p.e_q, the contacts first and then the thread. Points is what makes forces of readings: explicit_points.hpp, or
// obstacle_step.hpp over the span 2 dt. Start, rows and energy are those of modal_three_point.hpp: the energy of a row is the mean of its
// two half steps, contact forces and ledger count row instants with half weight.
#pragma once

#include <cmath>
#include <span>
#include <utility>

#include "schemes/contact/compliance.hpp"
#include "schemes/modal/modal_string.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

struct ContactsOfString {  // its lumped barriers, a profile's points among them
    std::vector<ContactLaw> laws;
    std::vector<double> heights, loss;  // [m], [s/m]
    std::vector<ModalArray> g;
};

template <class Points>
class ModalThreePointPoints final : public Scheme {
public:
    // string: without barriers. make_points(laws, heights, thread, theta, span, loss) is a Points.
    template <class MakePoints>
    ModalThreePointPoints(ModalString string, const std::optional<Thread>& thread, ContactsOfString at, const ModalArray& gain,
                          ModalArray inertia, MakePoints make_points)
        : m_(std::move(string)),
          g_(std::move(at.g)),
          contacts_(g_.size()),
          W_(std::move(inertia)),
          q_(m_.size),
          d_(m_.size),
          d0_(rest_increments(m_)),
          push_(m_.size) {
        W_.resize(m_.size);
        if (thread) g_.push_back(m_.g_c);
        const auto moved = [&](ModalArray g) {
            for (int i = 0; i < m_.count; ++i) g[i] *= gain[i];
            return g;
        };
        for (const ModalArray& g : g_) e_.push_back(moved(g));
        if (!m_.g_e.empty()) e_e_ = moved(m_.g_e);
        std::vector<double> theta;
        for (std::size_t a = 0; a < g_.size(); ++a)
            for (std::size_t b = 0; b < g_.size(); ++b) theta.push_back(modal_dot(g_[std::min(a, b)], e_[std::max(a, b)]));
        points_ = make_points(at.laws, at.heights, thread, theta, 2 * m_.dt, at.loss);
        for (auto* v : {&now_, &older_, &free_, &force_, &coming_}) v->assign(g_.size(), 0.0);
        ModalThreePointPoints::reset();
    }

    void reset() noexcept override {
        q_ = m_.y0;
        d_ = d0_;
        step_ = 0;
        status_ = {};
        outcome_ = Outcome::ok;
        bridge_ = thread_ = supplied_ = dissipated_ = 0;
        points_.clear();
        for (std::size_t p = 0; p < g_.size(); ++p) now_[p] = older_[p] = modal_dot_by_eights(g_[p], q_);
        solve();
    }

    Status advance(const Block& out) noexcept override {
        if (status_.outcome != Outcome::ok) return status_;
        for (int row = 0; row < out.rows; ++row) {
            write(out, row);
            bridge_ = thread_ = supplied_ = dissipated_ = 0;
            count(step_ == 0 ? 1 : 0.5, step_ == 0 ? 0 : 0.5, out.energy);  // the forces of the first step have their half weight already
            for (int k = 0; k < m_.steps_per_row; ++k) {
                step();
                solve();
                if (out.stopped(k, steps_between_looks)) return {};
                const double weight = k + 1 == m_.steps_per_row ? 0.5 : 1;
                count(weight, weight, out.energy);
            }
            if (outcome_ != Outcome::ok) return status_ = {outcome_, step_ - 1};  // the row that ends here is not written
        }
        return {};
    }

    int dofs() const override { return 2 * m_.count; }
    std::vector<Fact> facts() const override { return points_.facts(); }
    std::vector<FreeMode> free_modes() const override { return three_point_modes(m_); }

private:
    static constexpr long steps_between_looks = 64;

    // The forces of step n, and what they move: push_ = sum e F, coming_ the readings of level n+1.
    void solve() noexcept {
        const bool at_start = step_ == 0;
        F_e_ = (at_start ? 0.5 : 1) * m_.pluck_at(step_);
        for (int i = 0; i < m_.size; ++i) push_[i] = (1 - m_.loss[i]) * d_[i] - m_.num[i] * q_[i];
        if (F_e_ != 0) push(e_e_, F_e_);
        for (std::size_t p = 0; p < g_.size(); ++p) free_[p] = now_[p] - older_[p] + modal_dot_by_eights(g_[p], push_);
        const bool solved = at_start ? points_.first(now_.data(), free_.data(), force_.data())
                                     : points_.next(now_.data(), older_.data(), free_.data(), force_.data());
        if (!solved) outcome_ = Outcome::not_converged;
        for (std::size_t p = 0; p < g_.size(); ++p)
            if (force_[p] != 0) push(e_[p], force_[p]);
        for (std::size_t p = 0; p < g_.size(); ++p) {
            coming_[p] = now_[p] + modal_dot_by_eights(g_[p], push_);
            if (!(std::abs(coming_[p]) < modal_overflow)) outcome_ = Outcome::diverged;
        }
    }
    void push(const ModalArray& e, double F) noexcept {
        for (std::size_t i = 0; i < push_.size(); ++i) push_[i] += e[i] * F;
    }

    void step() noexcept {
        for (int i = 0; i < m_.size; ++i) q_[i] += push_[i];
        d_.swap(push_);
        std::swap(older_, now_);
        std::swap(now_, coming_);
        ++step_;
    }

    // The forces of the step in hand for the row, and its work and losses: F_e (y_e^{n+1} - y_e^{n-1})/2, W loss (d^{n+1} + d^n)^2/(4
    // dt^2).
    void count(double of_force, double of_ledger, bool probed) noexcept {
        for (std::size_t a = 0; a < contacts_; ++a) bridge_ += of_force * force_[a];
        if (contacts_ < g_.size()) thread_ += of_force * force_.back();
        if (!probed || of_ledger == 0) return;
        double loss = 0, work = 0;
        for (int i = 0; i < m_.size; ++i) {
            const double r = push_[i] + d_[i];
            loss += W_[i] * m_.loss[i] * r * r;
            if (F_e_ != 0) work += m_.g_e[i] * r;
        }
        const double r_c = contacts_ < g_.size() ? coming_.back() - older_.back() : 0;
        dissipated_ += of_ledger * (loss / (4 * m_.dt * m_.dt) + m_.dt * points_.loss(r_c));
        supplied_ += of_ledger * 0.5 * F_e_ * work;
    }

    double of_modes(const ModalArray& d, double side) const {  // side: 1 of the half step after, -1 before
        double sum = 0;
        for (int i = 0; i < m_.size; ++i) {
            const double s = 2 * q_[i] + side * d[i];
            sum += W_[i] * (m_.den[i] * d[i] * d[i] + m_.num[i] * s * s);
        }
        return sum / (8 * m_.dt * m_.dt);
    }
    double stored() const {
        const double here = points_.potential(now_.data());
        const double after = of_modes(push_, 1) + 0.5 * (here + points_.potential(coming_.data()));
        if (step_ == 0) return after;
        return 0.5 * (after + of_modes(d_, -1) + 0.5 * (here + points_.potential(older_.data())));
    }

    void write(const Block& out, int row) const {
        const double per_row = m_.steps_per_row;
        const auto velocity = [this](const ModalArray& weights) {  // centred; at rest in row 0
            double sum = 0;
            if (step_ > 0)
                for (int i = 0; i < m_.size; ++i) sum += weights[i] * (push_[i] + d_[i]);
            return sum / (2 * m_.dt);
        };
        write_taps(out, row, m_.taps, q_, velocity, bridge_ / per_row, thread_ / per_row);
        if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
    }

    ModalString m_;
    std::vector<ModalArray> g_, e_;  // of the points
    std::size_t contacts_;
    Points points_;
    ModalArray W_, e_e_, q_, d_, d0_, push_;                   // push_: d^{n+1}
    std::vector<double> now_, older_, coming_, free_, force_;  // of the points [m], [N]
    long step_ = 0;
    Status status_;
    Outcome outcome_ = Outcome::ok;  // of the steps so far
    double F_e_ = 0, bridge_ = 0, thread_ = 0, supplied_ = 0, dissipated_ = 0;
};

}  // namespace jvari

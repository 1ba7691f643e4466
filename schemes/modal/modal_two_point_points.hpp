// The two-point update of modal_two_point_kernel.hpp with any number of contact points. In modes scaled by sqrt(J/xi)
//
//     s = u + sum_p g_p F_p,   y <- y + s,   u <- s + sum_p g_p F_p - loss s - c y;   r_p = g_p.s, Theta_pq = g_p.g_q
//
// and the forces are an Obstacle's over the span dt. Those of obstacle_step.hpp: each contact's F is the two-point discrete gradient of its
// potential (van Walstijn et al. 2016, eq 30), the thread is eliminated (eqs 45-47), and what is left is the vector form of eq 48. The
// energy is eq 49 with a potential per point. A contact that loses energy (Hunt-Crossley) pulls by beta V'(eta^n) r/dt more, which takes
// beta V'(eta^n) r^2/dt. Those of quadratised_points.hpp have psi^2/2 for their potential. On a body that moves (schemes/body) the points
// of all strings are solved for together, and its acceleration is one more force.
// Leaves out: contact loss with compliance=matched; a moving body with compliance=matched.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/contact/obstacle_step.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_string.hpp"
#include "schemes/modal_coefficients.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

struct TwoPointCoefficients {  // of one mode (van Walstijn et al. 2016, eqs 32-33)
    double A, B;
};
using TwoPointLaw = TwoPointCoefficients (*)(double omega0, double sigma, double dt);
TwoPointCoefficients exact_two_point(double omega0, double sigma, double dt);  // eq 33

bool touches_once_without_loss(const String&);  // one lumped barrier at most: what the kernels of one contact take

// Profiles touch at points of their own (option `points`). Contact loss with compliance=own alone.
std::unique_ptr<Scheme> modal_two_point_points(const Descriptor&, const Scene&, const Settings&, TwoPointLaw);

// ---- The scheme, by what solves for its contacts.

template <class Obstacle>
concept TakesSeries = requires(Obstacle o, const MissingMatrix& m) {
    o.put_in_series(m, 1);
};

struct TapOfPoints {
    Quantity quantity;
    ModalArray on_y, on_u;  // on_u: velocity only
};

template <class Obstacle>
struct PointsOf {
    std::vector<ModalArray> g;  // scaled; the contacts in order, then the thread
    ModalArray g_e;             // the pluck's
    std::vector<double> theta_e;
    int contacts = 0;
    Obstacle obstacle;  // without points on a body: solved for outside
    std::optional<MissingMatrix> series;
};

// What a body that moves reads of the string, and pushes: empty without one.
struct AtBody {
    StringAtBody string;
    ModalArray mu, on_y, on_u;  // scaled; weights of sum mu_i (s_i - 2 q_i) without forces, in y and u
    double theta_e = 0;         // of the pluck [s^2]
};

// make_obstacle(laws, heights, thread, theta, span) is an Obstacle.
template <class Obstacle>
class ModalTwoPointPoints final : public Scheme {
public:
    template <class MakeObstacle>
    ModalTwoPointPoints(const Descriptor& descriptor, Scene scene, const Settings& settings, TwoPointLaw law, MakeObstacle make_obstacle) {
        const String s = scene.strings.front() = with_profile_points(scene.strings.front(), settings);
        steps_ = steps_per_row(settings);
        dt_ = 1 / settings.sample_rate;
        const Modes modes = modes_of(s, settings);
        refuse_above_nyquist(descriptor, modes, settings.sample_rate);
        count_ = modes.count();
        const std::size_t size = (count_ + modal_lanes - 1) / modal_lanes * modal_lanes;
        const double xi = dt_ * dt_ / (2 * modes.mass);
        std::vector<double> scale;  // sqrt(J/xi)
        for (ModalArray* a : {&A_, &c_, &loss_, &inverse_J_, &y0_, &u0_, &y_, &u_, &push_}) a->assign(size, 0.0);
        const auto shape = initial_displacement(modes, s);
        for (int i = 0; i < count_; ++i) {
            const auto [A, B] = law(modes.omega0[i], modes.sigma[i], dt_);
            const double J = 1 + A + B;
            A_[i] = A;
            c_[i] = 4 * A / J;
            loss_[i] = 2 * B / J;
            inverse_J_[i] = 1 / J;
            scale.push_back(std::sqrt(J / xi));
            y0_[i] = shape[i] * scale[i];
            u0_[i] = -2 * A / J * y0_[i];  // (42) with q = 0
            free_modes_.push_back(two_point_mode(A, B, dt_));
        }
        const auto scaled = [&](const std::vector<double>& weights) {
            ModalArray w(weights.begin(), weights.end());
            for (int i = 0; i < count_; ++i) w[i] /= scale[i];
            w.resize(size);
            return w;
        };
        place(s, modes, scaled, needed_by(scene).has(Feature::moving_body), make_obstacle);
        for (const Tap& tap : scene.taps) {
            TapOfPoints t{tap.quantity, {}, {}};
            if (tap.quantity == Quantity::displacement) t.on_y = scaled(displacement_weights(modes, tap.position));
            if (tap.quantity == Quantity::nut_force) t.on_y = scaled(nut_force_weights(modes, s));
            if (tap.quantity == Quantity::velocity) {  // p/m = 2q/dt, q = J u/2 + A y
                t.on_y = t.on_u = scaled(displacement_weights(modes, tap.position));
                for (int i = 0; i < count_; ++i) {
                    t.on_u[i] /= dt_ * inverse_J_[i];
                    t.on_y[i] *= 2 * A_[i] / dt_;
                }
            }
            taps_.push_back(std::move(t));
        }
        if constexpr (TakesSeries<Obstacle>)
            if (choice_option(settings, compliance_option) == "matched") put_in_series(descriptor, scene, modes);
        pluck_ = s.pluck;
        const std::size_t points = p_.g.size();
        for (auto* v : {&older_, &free_, &force_, &now_}) v->assign(points, 0.0);
        ModalTwoPointPoints::reset();
    }

    // ---- On a body (schemes/body/instrument.hpp)

    const StringAtBody& at_body() const { return body_.string; }
    const double* older() const { return older_.data(); }
    const double* free() const { return free_.data(); }
    double inertia() const {
        const double a = modal_dot_by_eights(body_.on_y, y_) + modal_dot_by_eights(body_.on_u, u_) + body_.theta_e * F_e_;
        return 2 / (dt_ * dt_) * a;
    }
    double pluck() const { return F_e_; }
    void begin() noexcept { reset(); }
    void pass(const double* force, double a, bool probed) noexcept {
        std::copy_n(force, force_.size(), force_.data());
        a_ = a;
        pass(probed);
    }
    void reading(int, double* out) noexcept {
        read(step_);
        std::copy(older_.begin(), older_.end(), out);
    }
    double momentum() const {  // sum mu_i v_i, v = 2q/dt, q = J u/2 + A y
        double sum = 0;
        for (int i = 0; i < count_; ++i) sum += body_.mu[i] * (0.5 * u_[i] / inverse_J_[i] + A_[i] * y_[i]);
        return 2 / dt_ * sum;
    }
    bool failed() const { return false; }

    // ----

    void reset() noexcept override {
        y_ = y0_;
        u_ = u0_;
        step_ = 0;
        status_ = {};
        bridge_ = thread_ = supplied_ = dissipated_ = 0;
        p_.obstacle.clear();
        read(0);
        p_.obstacle.begin(older_.data());
    }

    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows && status_.outcome == Outcome::ok; ++row) {
            write(out, row);
            for (int i = 0; i < steps_ && status_.outcome == Outcome::ok; ++i) {
                step(out.energy != nullptr);
                if (out.stopped(i, steps_between_looks)) return {};
            }
        }
        return status_;
    }

    int dofs() const override { return 2 * count_ + p_.obstacle.dofs(); }
    std::vector<FreeMode> free_modes() const override { return free_modes_; }
    std::vector<Fact> facts() const override {
        if (!body_.mu.empty()) return {};  // one set for the instrument
        std::vector<Fact> f = p_.obstacle.facts();
        if (p_.series) {
            f.push_back({facts::series_compliance, p_.series->C[0]});
            f.push_back({facts::compliance_excess, p_.series->excess});
        }
        return f;
    }

private:
    static constexpr long steps_between_looks = 64;  // a step of many coupled points takes tens of microseconds

    template <class Scaled, class MakeObstacle>
    void place(const String& s, const Modes& modes, Scaled scaled, bool on_body, MakeObstacle make_obstacle) {
        std::vector<ContactLaw> laws;
        std::vector<double> heights, loss;
        for (const Barrier& barrier : s.barriers) {
            const auto& b = std::get<LumpedBarrier>(barrier);
            p_.g.push_back(scaled(footprint_weights(modes, b.position, b.width)));
            laws.push_back({b.stiffness.k, b.exponent});
            heights.push_back(b.height);
            loss.push_back(b.contact_loss);
        }
        p_.contacts = static_cast<int>(laws.size());
        if (s.thread) p_.g.push_back(scaled(footprint_weights(modes, s.thread->position, s.thread->width)));
        std::vector<double> theta;
        for (std::size_t a = 0; a < p_.g.size(); ++a)
            for (std::size_t b = 0; b < p_.g.size(); ++b) theta.push_back(modal_dot(p_.g[std::min(a, b)], p_.g[std::max(a, b)]));
        if (s.pluck) {
            p_.g_e = scaled(footprint_weights(modes, s.pluck->position, s.pluck->width));
            for (const ModalArray& g : p_.g) p_.theta_e.push_back(modal_dot(g, p_.g_e));
        }
        if (on_body) return put_on_body(s, scaled(end_inertia(modes, s)), laws, heights, loss);
        p_.obstacle = make_obstacle(laws, heights, s.thread, theta, dt_);
        p_.obstacle.lose(loss);
    }

    void put_on_body(const String& s, const ModalArray& mu, const std::vector<ContactLaw>& laws, const std::vector<double>& heights,
                     const std::vector<double>& loss) {
        body_ = {jvari::at_body(s), mu, mu, mu, s.pluck ? modal_dot(mu, p_.g_e) : 0};
        for (int i = 0; i < count_; ++i) {  // s - 2q = (1 - J) u - 2 A y, J - 1 = A + B
            body_.on_y[i] *= -2 * A_[i];
            body_.on_u[i] *= 1 - 1 / inverse_J_[i];
        }
        StringAtBody& at = body_.string;
        at.laws = laws;
        at.heights = heights;
        at.loss = loss;
        for (const Barrier& b : s.barriers) at.positions.push_back(std::get<LumpedBarrier>(b).position);
        if (s.thread) at.positions.push_back(s.thread->position);
        std::vector<const ModalArray*> all;
        for (const ModalArray& g : p_.g) all.push_back(&g);
        all.push_back(&body_.mu);
        for (std::size_t a = 0; a < all.size(); ++a)
            for (std::size_t b = 0; b < all.size(); ++b) at.theta.push_back(modal_dot(*all[std::min(a, b)], *all[std::max(a, b)]));
    }

    void put_in_series(const Descriptor& descriptor, const Scene& scene, const Modes& modes) {
        const String& s = scene.strings.front();
        const Sites sites = sites_of(scene, footprints_of(s));
        std::vector<std::vector<double>> w, g;
        for (const Footprint& f : sites.forces) g.push_back(footprint_weights(modes, f.position, f.width));
        for (const Reading& r : sites.readings)
            w.push_back(r.nut_force ? nut_force_weights(modes, s) : footprint_weights(modes, r.at.position, r.at.width));
        p_.series = missing_matrix(descriptor.name, s, sites, scene.taps.size(), count_, [&](int r, int f) {
            double sum = 0;
            for (int i = 0; i < count_; ++i) sum += w[r][i] * g[f][i] * dt_ * dt_ / (4 * modes.mass * A_[i]);  // (42) with s = 0
            return sum;
        });
        p_.obstacle.put_in_series(*p_.series, 1);
    }

    double pluck_at(long n) const { return pluck_ ? force(*pluck_, static_cast<double>(n) * dt_) : 0; }
    bool by_pluck() const { return p_.series && !p_.series->pluck.empty(); }  // it moves the points by way of what is in series

    void read(long n) noexcept {  // older_: the points at the instant n
        const double F_e = by_pluck() ? pluck_at(n) : 0;
        for (std::size_t a = 0; a < p_.g.size(); ++a)
            older_[a] = modal_dot_by_eights(p_.g[a], y_) + (F_e != 0 ? p_.series->pluck[a] * F_e : 0);
    }

    void step(bool probed) noexcept {
        approach();
        if (!p_.g.empty() && !p_.obstacle.solve(older_.data(), free_.data(), force_.data())) status_ = {Outcome::not_converged, step_};
        pass(probed);
    }

public:
    void approach(bool = false) noexcept {
        const double from = pluck_at(step_), to = pluck_at(step_ + 1);
        F_e_ = 0.5 * (from + to);
        change_ = by_pluck() ? to - from : 0;
        read(step_);
        for (std::size_t a = 0; a < p_.g.size(); ++a) {
            free_[a] = modal_dot_by_eights(p_.g[a], u_);
            if (F_e_ != 0) free_[a] += p_.theta_e[a] * F_e_;
            if (change_ != 0) free_[a] += p_.series->pluck[a] * change_;
        }
    }

private:
    void pass(bool probed) noexcept {
        const std::size_t points = p_.g.size();
        std::fill(push_.begin(), push_.end(), 0.0);
        const auto push = [this](const ModalArray& g, double F) {
            for (std::size_t i = 0; i < push_.size(); ++i) push_[i] += g[i] * F;
        };
        for (std::size_t a = 0; a < points; ++a)
            if (force_[a] != 0) push(p_.g[a], force_[a]);
        if (F_e_ != 0) push(p_.g_e, F_e_);
        if (!body_.mu.empty()) push(body_.mu, -a_);
        for (int a = 0; a < p_.contacts; ++a) bridge_ += force_[a];
        if (static_cast<int>(points) > p_.contacts) thread_ += force_.back();
        if (probed) ledger(F_e_, change_);
        for (std::size_t i = 0; i < y_.size(); ++i) {
            const double s = u_[i] + push_[i];  // (41)
            y_[i] += s;                         // (40)
            u_[i] = s + push_[i] - loss_[i] * s - c_[i] * y_[i];
        }
        ++step_;
    }

    // Supplied and dissipated energy of the step that is about to be made (51, 52).
    void ledger(double F_e, double change) noexcept {
        double lost = 0, given = 0, r_c = 0;
        const bool thread = static_cast<int>(p_.g.size()) > p_.contacts;
        for (std::size_t i = 0; i < y_.size(); ++i) {
            const double s = u_[i] + push_[i];
            lost += loss_[i] * s * s;
            if (F_e != 0) given += p_.g_e[i] * s;
            if (thread) r_c += p_.g.back()[i] * s;
        }
        dissipated_ += 0.5 * lost + dt_ * p_.obstacle.loss(r_c);
        supplied_ += F_e * given;
        for (std::size_t a = 0; change != 0 && a < p_.g.size(); ++a) supplied_ -= force_[a] * p_.series->pluck[a] * change;
    }

    double stored() noexcept {  // (49), q = J u/2 + A y, and the points' potential
        double H = 0;
        for (int i = 0; i < count_; ++i) {
            const double q = 0.5 * u_[i] / inverse_J_[i] + A_[i] * y_[i];
            H += (q * q + A_[i] * y_[i] * y_[i]) * inverse_J_[i];
        }
        read(step_);
        return H + p_.obstacle.potential(older_.data());
    }

public:
    void write(const Block& out, int row) noexcept {
        const double bridge = bridge_ / steps_, thread = thread_ / steps_;
        for (int k = 0; k < out.taps; ++k) {
            double& cell = out.tap[k * out.stride + row];
            const TapOfPoints& t = taps_[k];
            switch (t.quantity) {
                case Quantity::displacement:
                case Quantity::nut_force: cell = modal_dot(t.on_y, y_); break;
                case Quantity::velocity: cell = modal_dot(t.on_y, y_) + modal_dot(t.on_u, u_); break;
                case Quantity::bridge_force: cell = bridge; break;
                case Quantity::thread_force: cell = thread; break;
                case Quantity::driving_force: cell = -(bridge + thread); break;
            }
        }
        if constexpr (TakesSeries<Obstacle>)
            if (p_.series) {
                read(step_);
                p_.obstacle.forces(0, now_.data());
                for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] += p_.series->on_tap(k, now_.data(), pluck_at(step_));
            }
        if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
        bridge_ = thread_ = supplied_ = dissipated_ = 0;
    }

private:
    int count_ = 0, steps_ = 1;
    double dt_ = 0;
    ModalArray A_, c_, loss_, inverse_J_, y0_, u0_, y_, u_, push_;
    PointsOf<Obstacle> p_;
    AtBody body_;
    double F_e_ = 0, change_ = 0, a_ = 0;  // of the step: the pluck's force, its change [N], w'' [m/s^2]
    std::optional<Pluck> pluck_;
    std::vector<TapOfPoints> taps_;
    std::vector<FreeMode> free_modes_;
    std::vector<double> older_, free_, force_, now_;
    long step_ = 0;
    double bridge_ = 0, thread_ = 0, supplied_ = 0, dissipated_ = 0;  // since the last row
    Status status_;
};

}  // namespace jvari

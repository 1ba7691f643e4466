// Source: van Walstijn et al. 2016, eqs 31-43, 49-52.
#include "schemes/modal/two_point_modes.hpp"

#include <cmath>

#include "scenes/excitation.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

TwoPointCoefficients exact_two_point(double omega0, double sigma, double dt) {
    const ModeStep m = exact_step(omega0, sigma, dt);
    return {m.A(), m.B()};
}

TwoPointModes::TwoPointModes(const Descriptor& descriptor, const Scene& given, const Settings& settings, TwoPointLaw law)
    : dt_(1 / settings.sample_rate) {
    Scene scene = given;
    const String s = scene.strings.front() = with_profile_points(scene.strings.front(), settings);
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

    p_ = points_of(s, dt_);
    add_lumped(p_, s);
    for (const Footprint& f : sites_of(scene).forces)
        if (g_.size() < p_.positions.size()) g_.push_back(scaled(footprint_weights(modes, f.position, f.width)));
    if (s.pluck) {
        g_e_ = scaled(footprint_weights(modes, s.pluck->position, s.pluck->width));
        for (const ModalArray& g : g_) theta_e_.push_back(modal_dot(g, g_e_));
        const PluckSteps steps = pluck_steps(*s.pluck, dt_);
        pluck_first_ = steps.first;
        for (long n = steps.first; n < steps.first + steps.count; ++n)
            pluck_.push_back(0.5 * (force(*s.pluck, n * dt_) + force(*s.pluck, (n + 1) * dt_)));
    }
    std::vector<const ModalArray*> all;
    for (const ModalArray& g : g_) all.push_back(&g);
    const bool on_body = needed_by(scene).has(Feature::moving_body);
    if (on_body) {
        const ModalArray mu = scaled(end_inertia(modes, s));
        body_ = {mu, mu, mu, s.pluck ? modal_dot(mu, g_e_) : 0};
        for (int i = 0; i < count_; ++i) {  // s - 2q = (1 - J) u - 2 A y, J - 1 = A + B
            body_.on_y[i] *= -2 * A_[i];
            body_.on_u[i] *= 1 - 1 / inverse_J_[i];
        }
        all.push_back(&body_.mu);
    }
    for (std::size_t a = 0; a < all.size(); ++a)
        for (std::size_t b = 0; b < all.size(); ++b) p_.theta.push_back(modal_dot(*all[std::min(a, b)], *all[std::max(a, b)]));

    for (const Tap& tap : scene.taps) {
        TapOfModes t{tap.quantity, {}, {}};
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
    std::vector<double> own;
    for (int i = 0; i < count_; ++i) own.push_back(dt_ * dt_ / (4 * modes.mass * A_[i]));  // (42) with s = 0
    if (choice_option(settings, compliance_option) == "matched") p_.series = modal_missing_matrix(descriptor, scene, modes, dt_, own);
    else if (p_.contacts.count() == 1 && !on_body) compliance_ = relative_compliance(modes, s, own);
    for (auto* v : {&older_, &free_}) v->assign(g_.size(), 0.0);
    if (p_.contacts.count() <= 1 && !on_body) {
        a_ = loss_;
        for (std::size_t i = 0; i < a_.size(); ++i) a_[i] = 2 - loss_[i] - c_[i];
        const bool barrier = p_.contacts.count() == 1, thread = !p_.threads.empty();
        const double *g_b = barrier ? g_.front().data() : nullptr, *g_c = thread ? g_.back().data() : nullptr;
        fused_ = {static_cast<int>(size), y_.data(), u_.data(), a_.data(), c_.data(), g_b, g_c, g_b, g_c, g_e_.data()};
        unplucked_ = two_point_pass(barrier, thread, false);
        plucked_ = two_point_pass(barrier, thread, true);
    }
    reset();
}

void TwoPointModes::reset() noexcept {
    std::copy(y0_.begin(), y0_.end(), y_.begin());
    std::copy(u0_.begin(), u0_.end(), u_.begin());
    step_ = 0;
    sum_ = 0;
    for (std::size_t p = 0; p < g_.size() && unplucked_; ++p) {
        older_[p] = modal_dot_by_eights(g_[p], y_);
        free_[p] = modal_dot_by_eights(g_[p], u_);
    }
}

void TwoPointModes::approach(bool) noexcept {
    const long k = step_ - pluck_first_;
    F_e_ = k < 0 || k >= static_cast<long>(pluck_.size()) ? 0 : pluck_[k];
    sum_ = 0;
    for (std::size_t a = 0; a < g_.size(); ++a) {
        if (!unplucked_) {
            older_[a] = modal_dot_by_eights(g_[a], y_);
            free_[a] = modal_dot_by_eights(g_[a], u_);
        }
        sum_ += older_[a];
        if (F_e_ != 0) free_[a] += theta_e_[a] * F_e_;
    }
}

void TwoPointModes::push(const double* force, double a) noexcept {  // sum of g F
    std::fill(push_.begin(), push_.end(), 0.0);
    const auto add = [this](const ModalArray& g, double F) {
        for (std::size_t i = 0; i < push_.size(); ++i) push_[i] += g[i] * F;
    };
    for (std::size_t p = 0; p < g_.size(); ++p)
        if (force[p] != 0) add(g_[p], force[p]);
    if (F_e_ != 0) add(g_e_, F_e_);
    if (!body_.mu.empty()) add(body_.mu, -a);
}

Spent TwoPointModes::pass(const double* force, double a, bool probed) noexcept {
    if (probed || !unplucked_) push(force, a);
    Spent spent;
    for (std::size_t i = 0; probed && i < y_.size(); ++i) {  // (51), (52)
        const double s = u_[i] + push_[i];
        spent.dissipated += 0.5 * loss_[i] * s * s;
        if (F_e_ != 0) spent.supplied += F_e_ * g_e_[i] * s;
    }
    ++step_;
    if (unplucked_) {
        const std::size_t c = p_.contacts.count();
        fused_.F_b = c == 1 ? force[0] : 0;
        fused_.F_c = p_.threads.empty() ? 0 : force[c];
        fused_.F_e = F_e_;
        (F_e_ != 0 ? plucked_ : unplucked_)(fused_);
        if (c == 1) older_[0] = fused_.x_b, free_[0] = fused_.v_b;
        if (!p_.threads.empty()) older_[c] = fused_.x_c, free_[c] = fused_.v_c;
        return spent;
    }
    for (std::size_t i = 0; i < y_.size(); ++i) {
        const double s = u_[i] + push_[i];  // (41)
        y_[i] += s;                         // (40)
        u_[i] = s + push_[i] - loss_[i] * s - c_[i] * y_[i];
    }
    return spent;
}

void TwoPointModes::reading(int, double* out) const noexcept {
    for (std::size_t p = 0; p < g_.size(); ++p) out[p] = modal_dot_by_eights(g_[p], y_);
}

double TwoPointModes::stored() const noexcept {  // q = J u/2 + A y
    double H = 0;
    for (int i = 0; i < count_; ++i) {
        const double q = 0.5 * u_[i] / inverse_J_[i] + A_[i] * y_[i];
        H += (q * q + A_[i] * y_[i] * y_[i]) * inverse_J_[i];
    }
    return H;
}

double TwoPointModes::inertia() const {
    const double a = modal_dot_by_eights(body_.on_y, y_) + modal_dot_by_eights(body_.on_u, u_) + body_.theta_e * F_e_;
    return 2 / (dt_ * dt_) * a;
}

double TwoPointModes::momentum() const {  // v = 2q/dt
    double sum = 0;
    for (int i = 0; i < count_; ++i) sum += body_.mu[i] * (0.5 * u_[i] / inverse_J_[i] + A_[i] * y_[i]);
    return 2 / dt_ * sum;
}

double TwoPointModes::tap(int k, const double* mean) const noexcept {
    const auto read = [](const ModalArray& w, const ModalArray& x) { return pass_dot(w.data(), x.data(), static_cast<int>(x.size())); };
    const TapOfModes& t = taps_[k];
    if (t.on_y.empty()) return heard_force(t.quantity, p_, mean);
    return t.on_u.empty() ? read(t.on_y, y_) : read(t.on_y, y_) + read(t.on_u, u_);
}

std::vector<Fact> TwoPointModes::facts() const {
    return compliance_ > 0 ? std::vector<Fact>{{facts::static_compliance, compliance_}} : std::vector<Fact>{};
}

}  // namespace jvari

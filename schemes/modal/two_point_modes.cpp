// Source: van Walstijn et al. 2016, eqs 31-43, 49-52.
#include "schemes/modal/two_point_modes.hpp"

#include <cmath>
#include <complex>

#include "scenes/excitation.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

template class Driver<TwoPointModes>;

namespace {
using Column = TwoPointColumn;

// Phase [rad] by which a mode released with q = 0 leads the true motion released at rest: q/y =
// tanh(s dt/2) on the discrete mode z = exp(s dt), where the true motion has s dt/2.
double lead_at_start(double omega0, double sigma, double A, double B) {
    if (omega0 <= sigma) return 0;
    // z of (35)
    const double J = 1 + A + B, real = (1 - A) / J, square = (1 + A - B) / J - real * real;
    if (square <= 0) return 0;
    const std::complex<double> z(real, std::sqrt(square)), t = (z - 1.0) / (z + 1.0),
                                                           s = std::log(z);
    return std::abs(std::atan2(t.real(), t.imag()) - std::atan2(s.real(), s.imag()));
}

// Rounded once: an error in Theta is one in the balance of every step of contact, and of one sign.
double gram(const AlignedVector& a, const AlignedVector& b) {
    long double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<long double>(a[i]) * b[i];
    return static_cast<double>(sum);
}
double mean_in_step(const Pluck& e, long n, double dt) {
    return mean_force(e, static_cast<double>(n) * dt, dt);
}
}  // namespace

TwoPointCoefficients exact_two_point(double omega0, double sigma, double dt) {  // (33)
    const ModeStep m = exact_step(omega0, sigma, dt);
    return {m.A(), m.B()};
}

TwoPointModes::TwoPointModes(const Descriptor& descriptor, const Scene& given,
                             const Settings& settings, TwoPointLaw law)
    : dt_(1 / settings.sample_rate) {
    Scene scene = given;
    const String s = scene.strings.front() = with_profile_points(scene.strings.front(), settings);
    const Modes modes = modes_of(s, settings);
    refuse_above_nyquist(descriptor, modes, settings.sample_rate);
    const int count = m_.modes = modes.count();
    m_.size = (count + modal_padding - 1) / modal_padding * modal_padding;
    const bool matched = choice_option(settings, compliance_option) == "matched";
    std::vector<double> A, B, own;
    std::vector<double>& scale = scale_;
    AlignedVector c(m_.size), loss(m_.size);
    for (AlignedVector* a : {&J_, &y0_, &u0_, &push_}) a->assign(m_.size, 0.0);
    for (int i = 0; i < count; ++i) {
        const auto [Ai, Bi] = law(modes.omega0[i], modes.sigma[i], dt_);
        const double J = J_[i] = 1 + Ai + Bi;
        A.push_back(Ai);
        B.push_back(Bi);
        c[i] = 4 * Ai / J;
        loss[i] = 2 * Bi / J;
        // Frequency and decay fix A and B, not the mass. Matched, sqrt(k m) of mass m and stiffness
        // 4 m A/dt^2 is the true mode's.
        const double mass =
            modes.mass * (matched ? 0.5 * dt_ * modes.omega0[i] / std::sqrt(Ai) : 1);
        scale.push_back(std::sqrt(J / (dt_ * dt_ / (2 * mass))));
        own.push_back(dt_ * dt_ / (4 * mass * Ai));  // (42) with s = 0
        free_modes_.push_back(two_point_mode(Ai, Bi, dt_));
        offset_ = std::max(offset_, lead_at_start(modes.omega0[i], modes.sigma[i], Ai, Bi));
    }
    stream_.assign(static_cast<std::size_t>(m_.size) * two_point_columns, 0.0);
    m_.stream = stream_.data();
    put(Column::c, c);
    put(Column::loss, loss);
    const auto scaled = [&](const std::vector<double>& weights) {
        AlignedVector w(weights.begin(), weights.end());
        for (int i = 0; i < count; ++i) w[i] /= scale[i];
        w.resize(m_.size);
        return w;
    };

    p_ = points_of(scene, dt_);
    add_lumped(p_, s);
    if (matched) p_.series = modal_missing_matrix(descriptor, scene, modes, dt_, own);
    const ModalStart start = start_of(modes, s, yield_of(own, p_.series));
    put_start(p_, s, modes, start);
    for (int i = 0; i < count; ++i) begin(i, start.displacement[i], start.velocity[i]);
    for (const Footprint& f : sites_of(scene).forces)
        if (g_.size() < p_.positions.size())
            g_.push_back(scaled(footprint_weights(modes, f.position, f.width)));
    if (s.pluck) {
        g_e_ = scaled(footprint_weights(modes, s.pluck->position, s.pluck->width));
        m_.g_e = g_e_.data();
        for (const AlignedVector& g : g_) pluck_.theta.push_back(gram(g, g_e_));
        const PluckSteps steps = pluck_steps(*s.pluck, dt_, scene.duration);
        pluck_.of = *s.pluck;
        pluck_.first = steps.first;
        pluck_.steps = steps.count;
        for (long n = steps.first; n < steps.first + steps.tabulated; ++n)
            pluck_.mean.push_back(mean_in_step(pluck_.of, n, dt_));
    }
    std::vector<const AlignedVector*> all;
    for (const AlignedVector& g : g_) all.push_back(&g);
    const bool on_body = needed_by(scene).has(Feature::moving_body);
    if (on_body) {
        const AlignedVector mu = scaled(end_inertia(modes, s));
        body_ = {mu, mu, mu, s.pluck ? gram(mu, g_e_) : 0};
        for (int i = 0; i < count; ++i) {  // s - 2q = -(A + B) u - 2 A y
            body_.on_y[i] *= -2 * A[i];
            body_.on_u[i] *= -(A[i] + B[i]);
        }
        all.push_back(&body_.mu);
    }
    for (const AlignedVector* a : all)  // theta of (43), (44)
        for (const AlignedVector* b : all) p_.theta.push_back(gram(*a, *b));

    for (const Tap& tap : scene.taps) {
        TapOfModes t;
        if (const auto w = tap_weights(tap, modes, s); !w.empty()) t.on_y = scaled(w);
        if (tap.quantity == Quantity::velocity) {  // p/m = 2q/dt, q = J u/2 + A y
            t.on_u = t.on_y;
            for (int i = 0; i < count; ++i) {
                t.on_u[i] *= J_[i] / dt_;
                t.on_y[i] *= 2 * A[i] / dt_;
            }
        }
        std::vector<double> one(p_.count());  // 1 N of each point
        for (int p = 0; t.on_y.empty() && p < p_.count(); one[p++] = 0) {
            one[p] = 1;
            t.on_mean.push_back(heard_force(tap.quantity, p_, one.data()));
        }
        taps_.push_back(std::move(t));
    }
    if (!matched && p_.contacts.count() == 1 && !on_body)
        compliance_ = relative_compliance(modes, s, own);
    for (auto* v : {&older_, &free_}) v->assign(g_.size(), 0.0);
    if (p_.contacts.count() <= 1 && !on_body) {
        const bool barrier = p_.contacts.count() == 1, thread = !p_.threads.empty();
        if (barrier) put(Column::g_b, g_.front());
        if (thread) put(Column::g_c, g_.back());
        const auto theta = [&](std::size_t a, std::size_t b) {
            return p_.theta[a * g_.size() + b];
        };
        const auto of_pluck = [&](std::size_t a) { return s.pluck ? pluck_.theta[a] : 0; };
        const std::size_t last = g_.size() - 1;
        if (barrier) m_.theta_bb = theta(0, 0), m_.theta_be = of_pluck(0);
        if (thread) m_.theta_cc = theta(last, last), m_.theta_ce = of_pluck(last);
        if (barrier && thread) m_.theta_bc = theta(0, last);
        unplucked_ = two_point_pass(barrier, thread, false);
        plucked_ = two_point_pass(barrier, thread, true);
    }
    reset();
}

ModalState TwoPointModes::state() const {
    ModalState state;
    for (int i = 0; i < m_.modes; ++i) {
        state.displacement.push_back(displacement(i));
        state.velocity.push_back(velocity(i));
    }
    return state;
}

bool TwoPointModes::start_from(const TwoPointModes& before) noexcept {
    if (before.m_.modes != m_.modes) return false;
    for (int i = 0; i < m_.modes; ++i) begin(i, before.displacement(i), before.velocity(i));
    return true;
}

void TwoPointModes::put(Column column, const AlignedVector& values) {
    for (int i = 0; i < m_.size; ++i) stream_[two_point_at(column, i)] = values[i];
}

void TwoPointModes::reset() noexcept {
    put(Column::y, y0_);
    put(Column::u, u0_);
    m_.step = 0;
    sum_ = 0;
    m_.y_b = m_.u_b = m_.y_c = m_.u_c = 0;
    if (!unplucked_) return;
    if (p_.contacts.count() == 1)
        m_.y_b = modal_dot(g_.front(), y0_), m_.u_b = modal_dot(g_.front(), u0_);
    if (!p_.threads.empty()) m_.y_c = modal_dot(g_.back(), y0_), m_.u_c = modal_dot(g_.back(), u0_);
}

void TwoPointModes::approach(bool) noexcept {
    const long k = m_.step - pluck_.first;
    F_e_ = k < 0 || k >= pluck_.steps    ? 0
           : k < std::ssize(pluck_.mean) ? pluck_.mean[k]
                                         : mean_in_step(pluck_.of, m_.step, dt_);
    sum_ = 0;
    const std::size_t contacts = p_.contacts.laws.size();
    for (std::size_t a = 0; a < g_.size(); ++a) {
        if (unplucked_) {
            older_[a] = a < contacts ? m_.y_b : m_.y_c;
            free_[a] = a < contacts ? m_.u_b : m_.u_c;
        } else {
            older_[a] = dot_(g_[a].data(), m_, Column::y);
            free_[a] = dot_(g_[a].data(), m_, Column::u);
        }
        sum_ += older_[a];
        if (F_e_ != 0) free_[a] += pluck_.theta[a] * F_e_;
    }
}

void TwoPointModes::push(const double* force, double a) noexcept {  // sum of g F
    std::fill(push_.begin(), push_.end(), 0.0);
    const auto add = [this](const AlignedVector& g, double F) {
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
    for (int i = 0; probed && i < m_.modes; ++i) {  // (51), (52)
        const double s = at(Column::u, i) + push_[i];
        spent.dissipated += 0.5 * at(Column::loss, i) * s * s;
        if (F_e_ != 0) spent.supplied += F_e_ * g_e_[i] * s;
    }
    if (unplucked_) {
        const std::size_t c = p_.contacts.laws.size();
        (F_e_ != 0 ? plucked_ : unplucked_)(m_, c == 1 ? force[0] : 0,
                                            p_.threads.empty() ? 0 : force[c], F_e_);
        return spent;
    }
    ++m_.step;
    for (int from = 0; from < m_.modes; from += two_point_line) {
        double *y = m_.stream + two_point_at(Column::y, from),
               *u = m_.stream + two_point_at(Column::u, from);
        const double *c = m_.stream + two_point_at(Column::c, from),
                     *loss = m_.stream + two_point_at(Column::loss, from);
        const double* f = push_.data() + from;
        for (int k = 0; k < two_point_line; ++k) {
            const double s = u[k] + f[k];                 // (41)
            y[k] += s;                                    // (40)
            u[k] = s + f[k] - loss[k] * s - c[k] * y[k];  // (42) of the next step
        }
    }
    return spent;
}

void TwoPointModes::fuse(Obstacle& obstacle, int steps_per_row) {
    ContactAndThread* touching = obstacle.one();
    Residual* series = obstacle.series();
    if (!unplucked_ || !touching) return;
    fused_ = two_point_kernel(touching->contact, touching->thread, series && p_.count() > 0);
    touching_ = touching;
    in_series_ = series;
    steps_per_row_ = steps_per_row;
    m_.summed_again = two_point_summed_again;
    for (std::size_t k = 0; k < taps_.size(); ++k) {
        const TapOfModes& of = taps_[k];
        TwoPointTap t{of.on_y.empty() ? nullptr : of.on_y.data(),
                      of.on_u.empty() ? nullptr : of.on_u.data()};
        std::copy(of.on_mean.begin(), of.on_mean.end(), t.on_mean);
        if (p_.series && !p_.series->taps[k].empty())
            std::copy_n(p_.series->taps[k].begin(), p_.count(), t.on_P);
        fused_taps_.push_back(t);
    }
}

FusedRows TwoPointModes::fused_rows(const Block& out, int row, double* sum) noexcept {
    const long k = m_.step - pluck_.first;  // the pluck's steps are 0 .. steps - 1
    long rows = out.rows - row;
    if (pluck_.steps > 0 && k < pluck_.steps)
        rows = std::min(rows, std::max(-k, 0L) / steps_per_row_);
    if (!fused_ || rows == 0) return {};
    TwoPointRows r{fused_taps_.data(), row, row + static_cast<int>(rows), steps_per_row_, sum};
    const bool stopped = !fused_(m_, *touching_, in_series_, out, r);
    sum_ = m_.y_b + m_.y_c;
    return {r.end - row, r.steps, r.converged, stopped};
}

void TwoPointModes::reading(int, double* out) const noexcept {
    for (std::size_t p = 0; p < g_.size(); ++p) out[p] = dot_(g_[p].data(), m_, Column::y);
}

double TwoPointModes::stored() const noexcept {
    double H = 0;
    for (int i = 0; i < m_.modes; ++i) {  // (49)
        const double q = momentum_of(i), y = at(Column::y, i);
        H += J_[i] * q * q + 0.25 * at(Column::c, i) * y * y;
    }
    return H;
}

double TwoPointModes::inertia() const {
    const double a =
        dot_(body_.on_y.data(), m_, Column::y) + dot_(body_.on_u.data(), m_, Column::u);
    return 2 / (dt_ * dt_) * (a + body_.theta_e * F_e_);
}

double TwoPointModes::momentum() const {  // v = 2q/dt
    double sum = 0;
    for (int i = 0; i < m_.modes; ++i) sum += body_.mu[i] * J_[i] * momentum_of(i);
    return 2 / dt_ * sum;
}

std::vector<Fact> TwoPointModes::facts() const {
    std::vector<Fact> f = {{facts::start_phase_offset, offset_}};
    if (compliance_ > 0) f.push_back({facts::static_compliance, compliance_});
    return f;
}

}  // namespace jvari

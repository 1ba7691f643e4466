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
// tanh(s dt/2) on the discrete mode z = exp(s dt), while the true motion has s dt/2.
double lead_at_start(double omega0, double sigma, double A, double B) {
    if (omega0 <= sigma) return 0;
    // z in (35)
    const double J = 1 + A + B, real = (1 - A) / J, square = (1 + A - B) / J - real * real;
    if (square <= 0) return 0;
    const std::complex<double> z(real, std::sqrt(square)), t = (z - 1.0) / (z + 1.0),
                                                           s = std::log(z);
    return std::abs(std::atan2(t.real(), t.imag()) - std::atan2(s.real(), s.imag()));
}

// Rounds only once: a rounding error in Theta would enter the balance in every step with contact,
// with the same sign.
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

AlignedVector TwoPointModes::scaled(const std::vector<double>& weights) const {
    AlignedVector w(weights.begin(), weights.end());
    for (int i = 0; i < m_.modes; ++i) w[i] /= scale_[i];
    w.resize(m_.size);
    return w;
}

void TwoPointModes::put_pluck(const Pluck& pluck, const Modes& modes, double duration) {
    g_e_ = scaled(footprint_weights(modes, pluck.position, pluck.width));
    for (const AlignedVector& g : g_) pluck_.theta.push_back(gram(g, g_e_));
    const PluckSteps steps = pluck_steps(pluck, dt_, duration);
    pluck_.of = pluck;
    pluck_.first = steps.first;
    pluck_.steps = steps.count;
    for (long n = steps.first; n < steps.first + steps.tabulated; ++n)
        pluck_.mean.push_back(mean_in_step(pluck_.of, n, dt_));
}

void TwoPointModes::put_body(const Modes& modes, const String& s, std::span<const double> A,
                             std::span<const double> B) {
    const AlignedVector mu = scaled(end_inertia(modes, s));
    body_ = {mu, mu, mu};
    for (int i = 0; i < m_.modes; ++i) {  // s - 2q = -(A + B) u - 2 A y
        body_.on_y[i] *= -2 * A[i];
        body_.on_u[i] *= -(A[i] + B[i]);
    }
    g_.push_back(mu);
}

void TwoPointModes::put_tap(const Tap& tap, const Modes& modes, const String& s,
                            std::span<const double> A) {
    TapOfModes t;
    if (const auto w = tap_weights(tap, modes, s); !w.empty()) t.on_y = scaled(w);
    if (tap.quantity == Quantity::velocity) {  // p/m = 2q/dt, q = J u/2 + A y
        t.on_u = t.on_y;
        for (int i = 0; i < m_.modes; ++i) {
            t.on_u[i] *= J_[i] / dt_;
            t.on_y[i] *= 2 * A[i] / dt_;
        }
    }
    std::vector<double> one(p_.count());  // 1 N at each point
    for (int p = 0; t.on_y.empty() && p < p_.count(); one[p++] = 0) {
        one[p] = 1;
        t.on_mean.push_back(heard_force(tap.quantity, p_, one.data()));
    }
    taps_.push_back(std::move(t));
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
    AlignedVector c(m_.size), loss(m_.size);
    for (AlignedVector* a : {&J_, &y0_, &u0_}) a->assign(m_.size, 0.0);
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
        scale_.push_back(std::sqrt(J / (dt_ * dt_ / (2 * mass))));
        own.push_back(dt_ * dt_ / (4 * mass * Ai));  // (42) with s = 0
        free_modes_.push_back(two_point_mode(Ai, Bi, dt_));
        offset_ = std::max(offset_, lead_at_start(modes.omega0[i], modes.sigma[i], Ai, Bi));
    }

    p_ = points_of(scene, dt_);
    add_lumped(p_, s);
    if (matched) p_.series = modal_missing_matrix(descriptor, scene, modes, dt_, own);
    const ModalStart start = start_of(modes, s, yield_of(own, p_.series));
    put_start(p_, s, modes, start);
    for (const Footprint& f : sites_of(scene).forces)
        if (g_.size() < p_.positions.size()) g_.push_back(scaled(footprint_weights(modes, f)));
    const bool on_body = needed_by(scene).has(Feature::moving_body);
    if (on_body) put_body(modes, s, A, B);
    const int points = m_.points = static_cast<int>(g_.size());
    stream_.assign(static_cast<std::size_t>(m_.size) * m_.columns(), 0.0);
    m_.stream = stream_.data();
    put(Column::c, c);
    put(Column::loss, loss);
    for (int p = 0; p < points; ++p) put(Column::g, g_[p], p);
    for (int i = 0; i < count; ++i) begin(i, start.displacement[i], start.velocity[i]);
    if (s.pluck) put_pluck(*s.pluck, modes, scene.duration);
    for (const AlignedVector& g : g_)  // theta in (43), (44)
        for (const AlignedVector& h : g_) p_.theta.push_back(gram(g, h));

    for (const Tap& tap : scene.taps) put_tap(tap, modes, s, A);
    if (!matched && p_.contacts.count() == 1 && !on_body)
        compliance_ = relative_compliance(modes, s, own);
    for (auto* v : {&y_, &u_, &free_, &force_}) v->assign(2 * g_.size(), 0.0);
    sums_.assign(2 * g_.size() * TwoPointStream::line, 0.0);
    m_.y = y_.data(), m_.u = u_.data(), m_.theta = p_.theta.data(), m_.sums = sums_.data();
    pass_ = two_point_pass(points);
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

void TwoPointModes::put(Column column, const AlignedVector& values, int point) {
    for (int i = 0; i < m_.size; ++i) stream_[m_.at(column, i, point)] = values[i];
}

void TwoPointModes::reset() noexcept {
    put(Column::y, y0_);
    put(Column::u, u0_);
    m_.step = 0;
    sum_ = 0;
    for (std::size_t p = 0; p < g_.size(); ++p)
        y_[p] = modal_dot(g_[p], y0_), u_[p] = modal_dot(g_[p], u0_);
}

void TwoPointModes::approach(bool) noexcept {
    const long k = m_.step - pluck_.first;
    F_e_ = k < 0 || k >= pluck_.steps    ? 0
           : k < std::ssize(pluck_.mean) ? pluck_.mean[k]
                                         : mean_in_step(pluck_.of, m_.step, dt_);
    sum_ = 0;
    for (std::size_t p = 0; p < g_.size(); ++p) {
        free_[p] = u_[p];
        sum_ += y_[p];
        if (F_e_ != 0) free_[p] += pluck_.theta[p] * F_e_;
    }
}

void TwoPointModes::pluck_modes() noexcept {
    add_to_column<TwoPointStream::line>(m_.stream + m_.at(Column::u, 0),
                                        m_.columns() * TwoPointStream::line, g_e_, F_e_);
    for (std::size_t p = 0; p < g_.size(); ++p) u_[p] += pluck_.theta[p] * F_e_;
}

// The pluck adds to u before and after the pass, as f does in s = u + f and u <- s + f - ...
Spent TwoPointModes::pass(const double* force, double a, bool probed) noexcept {
    const double* F = force;
    if (!body_.mu.empty()) {
        std::copy_n(force, g_.size() - 1, force_.begin());
        force_[g_.size() - 1] = -a;
        F = force_.data();
    }
    Spent spent;
    for (int i = 0; probed && i < m_.modes; ++i) {  // (51), (52)
        double s = at(Column::u, i) + (F_e_ != 0 ? g_e_[i] * F_e_ : 0);
        for (std::size_t p = 0; p < g_.size(); ++p) s += g_[p][i] * F[p];
        spent.dissipated += 0.5 * at(Column::loss, i) * s * s;
        if (F_e_ != 0) spent.supplied += F_e_ * g_e_[i] * s;
    }
    if (F_e_ != 0) pluck_modes();
    pass_(m_, F);
    if (F_e_ != 0) pluck_modes();
    return spent;
}

void TwoPointModes::fuse(Obstacle& obstacle, int steps_per_row) {
    if (!body_.mu.empty()) return;
    rows_ = two_point_kernel(m_.points, obstacle);
    obstacle_ = &obstacle;
    steps_per_row_ = steps_per_row;
    m_.summed_again = two_point_summed_again;
    for (std::size_t k = 0; k < taps_.size(); ++k) {
        const TapOfModes& of = taps_[k];
        const bool series = p_.series && m_.points > 0 && !p_.series->taps[k].empty();
        fused_taps_.push_back({of.on_y.empty() ? nullptr : of.on_y.data(),
                               of.on_u.empty() ? nullptr : of.on_u.data(),
                               of.on_mean.empty() ? nullptr : of.on_mean.data(),
                               series ? p_.series->taps[k].data() : nullptr});
    }
}

FusedRows TwoPointModes::fused_rows(const Block& out, int row, double* sum) noexcept {
    const long rows =
        rows_without_pluck(out.rows - row, m_.step - pluck_.first, pluck_.steps, steps_per_row_);
    if (!rows_ || rows == 0) return {};
    RowsInHand r{fused_taps_.data(), row, row + static_cast<int>(rows),
                 steps_per_row_,     sum, force_.data() + m_.points,
                 force_.data()};
    const bool stopped = !rows_(m_, *obstacle_, out, r);
    sum_ = 0;
    for (int p = 0; p < m_.points; ++p) sum_ += y_[p];
    return {r.end - row, r.steps, r.converged, stopped};
}

void TwoPointModes::reading(int, double* out) const noexcept {
    for (int p = 0; p < p_.count(); ++p) out[p] = dot_(g_[p].data(), m_, Column::y);
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
    return 2 / (dt_ * dt_) * (a + (F_e_ != 0 ? pluck_.theta.back() * F_e_ : 0));
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

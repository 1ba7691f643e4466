#include "reference/macro_window.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>

#include "reference/pluck_series.hpp"

namespace jvari {

const std::vector<double> inverse_factorial = [] {
    std::vector<double> f{1.0};
    for (int n = 1; n <= 2 * longest_series; ++n) f.push_back(f.back() / n);
    return f;
}();

namespace {
constexpr double unit_rounding = 16 * 2.3e-16;  // of a gap, relative to sum |g_i| (|y_i| + |u_i|)

const std::vector<double> inverse = [] {
    std::vector<double> f{0.0};
    for (int n = 1; n <= 2 * longest_series; ++n) f.push_back(1.0 / n);
    return f;
}();

double tail(double z, int terms) {  // sum_{n >= terms} z^n/n!
    double term = 1;
    for (int n = 1; n <= terms; ++n) term *= z / n;
    return z < terms ? term / (1 - z / (terms + 1)) : HUGE_VAL;
}
}  // namespace

void powers(double u, int count, double* e) noexcept {
    e[0] = 1;
    for (int n = 1; n < count; ++n) e[n] = e[n - 1] * (u * inverse[n]);
}

WindowChoice choose_window(double tolerance, double reach) {
    WindowChoice c;
    c.per_row = std::max(1L, static_cast<long>(std::ceil(std::min(1e18, reach / longest_reach))));
    const double z = reach / c.per_row;
    c.terms = 6;
    while (c.terms < most_terms && tail(z, c.terms) > 0.1 * tolerance) ++c.terms;
    return c;
}

MacroWindow::MacroWindow(const Modes& modes, const String& s, double interval, double tolerance)
    : MacroWindow(modes, s, interval, tolerance, 0, 0) {}

MacroWindow::MacroWindow(const Modes& modes, const String& s, double interval, double tolerance, int windows, int kept)
    : osc(modes), springs(modes, osc, s), contacts(springs.contacts), sweep_(&sweep_functions()), mass_(modes.mass) {
    if (s.pluck) pluck_.push_back(*s.pluck);
    none_.assign(contacts + 1, 0);
    const double growth = largest_eigenvalue();
    const auto choice = choose_window(tolerance, growth * osc.rate * interval);
    per_row = windows > 0 ? windows : choice.per_row;
    terms = kept > 0 ? kept : choice.terms;
    size = std::max(16, (terms + lanes - 1) / lanes * lanes);  // 16: a collocated path is of degree 9
    stride = 2 * size + lanes;
    length = osc.rate * interval / per_row;
    reach = growth * length;
    tail_ = tail(reach, terms);
    modal_tail_ = 10 * std::exp(reach) * tail(length, terms) / std::min(1.0, length);

    a_ = osc.a, b_ = osc.b, gains_ = springs.gains;
    for (double& x : a_) x *= length;
    for (double& x : b_) x *= length * length;
    for (double& x : gains_) x *= length * length;
    for (int i = 0; i < modes.count(); ++i) loss_.push_back(2 * modes.mass * modes.sigma[i]);
    loss_ = osc.pad(loss_);
    for (int i = 0; i < osc.padded; i += sweep_lanes) {
        double fastest = 0;  // root of x^2 - a x + b, or its size
        for (int j = i; j < std::min(i + sweep_lanes, osc.padded); ++j)
            fastest = std::max(fastest, a_[j] * a_[j] > 4 * b_[j] ? a_[j] : std::sqrt(b_[j]));
        int n = 4;
        while (n < terms && n * n * tail(fastest, n) > 1e-6 * tolerance) ++n;
        sweep_terms_.push_back(n);
    }
    const std::size_t points = springs.points + 1, forces = springs.forces + 1;
    for (auto* v : {&p_, &free_}) v->assign(points * stride, 0.0);
    for (auto* v : {&force_, &moments_}) v->assign(forces * stride, 0.0);
    reach_.assign(points, 0.0);
    acting_.resize(forces);
    acting_moments_.resize(forces);
    scratch_.resize((points * (stride + 1) + 4 * size) * lanes);
    y_node_.assign(osc.padded, 0.0);
    u_node_ = zeros_ = y_node_;
    ones_.assign(osc.padded, 1.0);
    node_moments_.assign(points * stride, 0.0);
    flow_.assign(4 * osc.padded, 0.0);
    flow_at_ = flow_;
    free_flow(1, flow_);
    gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(nodes);
    for (int q = 0; q < nodes; ++q) gsl_integration_glfixed_point(0, 1, q, &node_[q], &weight_[q], table);
    gsl_integration_glfixed_table_free(table);
    make_kernel();
}

// Of the string with its thread [rate]: what the derivatives of impulse responses grow by in the end.
double MacroWindow::largest_eigenvalue() {
    double largest = 1;
    if (!threaded()) return largest;
    const double majorant = springs.growth(none_.data());
    const std::size_t rows = static_cast<std::size_t>(springs.forces + 1) * longest_series;
    std::vector<double> p(rows), y(rows), F(rows);
    Springs level = springs;
    std::fill(level.height.begin(), level.height.end(), 0.0);
    for (int b = 0; b < springs.points; ++b) {
        double power = 1 / majorant;
        for (int n = 0; n < longest_series; ++n, power /= majorant)
            for (int a = 0; a < springs.points; ++a) p[a * longest_series + n] = springs.h(a, b)[n] * power;
        level.solve(none_.data(), 1 / majorant, p.data(), longest_series, longest_series, y.data(), F.data());
        for (int a = 0; a < springs.points; ++a) {
            const auto largest_from = [&](int from) {
                double most = 0;
                for (int n = from; n < from + 6; ++n) most = std::max(most, std::abs(y[a * longest_series + n]));
                return most;
            };
            constexpr int early = longest_series / 2, late = longest_series - 6;
            if (largest_from(early) > 0)
                largest = std::max(largest, majorant * std::pow(largest_from(late) / largest_from(early), 1.0 / (late - early)));
        }
    }
    return std::min(largest, majorant);
}

// What a unit impulse at b does: to the points through the modes and the thread, and to the thread's force.
void MacroWindow::make_kernel() {
    kernel_.assign(static_cast<std::size_t>(contacts) * contacts * (stride + size) + size, 0.0);
    answer_.assign(static_cast<std::size_t>(contacts) * stride + 1, 0.0);
    by_thread_.assign(static_cast<std::size_t>(contacts + 1) * stride, 0.0);
    reply_.assign(2 * stride, 0.0);
    const std::size_t rows = static_cast<std::size_t>(springs.forces + 1) * longest_series;
    std::vector<double> p(rows), y(rows), F(rows);
    Springs level = springs;
    std::fill(level.height.begin(), level.height.end(), 0.0);
    for (int b = 0; b < contacts; ++b) {
        double power = length;  // h^(n) length^(n+1)
        for (int n = 0; n < terms; ++n, power *= length)
            for (int a = 0; a < springs.points; ++a) p[a * longest_series + n] = springs.h(a, b)[n] * power;
        level.solve(none_.data(), length, p.data(), terms, terms, y.data(), F.data());
        double scale = 1;
        for (int n = 0; n < terms; ++n, scale *= reach) {
            for (int a = 0; a < contacts; ++a) {
                const double h = y[a * longest_series + n];
                kernel_[(static_cast<std::size_t>(a) * contacts + b) * (stride + size) + size + n] = h;
                kernel_truncation_ = std::max(kernel_truncation_, std::abs(h) / scale * tail_);
            }
            if (threaded()) answer_[b * stride + n] = F[contacts * longest_series + n];
        }
    }
    if (!threaded()) return;
    // F_c = -(k + r d/dt) y_c and y_c = p_c + h_cc * F_c: F_c^(n) = -sum_m reply_m (k p_c^(n-m) + r p_c^(n-m+1)), reply the reciprocal of
    // the series 1 + sum_m (k h^(m-1) + r h^(m)) s^-m. Zeros before it: a convolution reads them.
    double* const g = reply_.data() + stride;
    std::vector<double> h(terms + 1);
    double scale = length;
    for (int n = 0; n <= terms; ++n, scale *= length) h[n] = springs.h(contacts, contacts)[n] * scale;
    g[0] = -1;
    for (int n = 1; n < terms; ++n)
        for (int m = 1; m <= n; ++m) g[n] -= (springs.k[contacts] * h[m - 1] + springs.r[contacts] / length * h[m]) * g[n - m];
    double power = length;
    for (int n = 0; n < terms; ++n, power *= length)
        for (int a = 0; a < contacts; ++a) by_thread_[a * stride + size + n] = springs.h(a, contacts)[n] * power;
}

// y = e11 y + e12 u, u = e21 y + e22 u: a mode's own motion over `at`, one after another in e.
void MacroWindow::free_flow(double at, std::vector<double>& e) const noexcept {
    const double t = at * length;
    const int n = terms_for(t, 1e-19, longest_series), M = osc.padded;
    double *e11 = e.data(), *e12 = e11 + M, *e21 = e12 + M, *e22 = e21 + M;
    fly(osc, ones_.data(), zeros_.data(), t, n, nullptr, nullptr, 0, 0, e11, e21);
    fly(osc, zeros_.data(), ones_.data(), t, n, nullptr, nullptr, 0, 0, e12, e22);
    for (int i = 0; i < M; ++i) e12[i] /= length, e21[i] *= length;
}

void MacroWindow::open(const double* y, const double* u, bool plucked, double since_pluck) noexcept {
    const Springs& s = springs;
    plucked_ = plucked;
    ModalSweep m;
    m.modes = osc.padded;
    m.outputs = s.points;
    m.count = size;
    m.stride = stride;
    m.terms = sweep_terms_.data();
    m.y = y, m.u = u, m.a = a_.data(), m.b = b_.data(), m.weights = s.weights.data();
    m.p = p_.data(), m.reach = reach_.data(), m.scratch = scratch_.data();
    sweep_->read(m);
    std::copy_n(p_.begin(), contacts * stride, free_.begin());
    if (plucked) {
        double* f = force_.data() + s.points * stride;
        std::fill_n(f, stride, 0.0);
        pluck_series(pluck_[0], since_pluck, seconds(), terms, f);
        for (int n = 0; n < terms; ++n) f[n] /= inverse_factorial[n];
        for (int a = 0; a < s.points; ++a) {
            double power = length;
            double* out = (a < contacts ? free_.data() : p_.data()) + a * stride;
            for (int j = 0; j < terms; ++j, power *= length)
                for (int n = j + 1; n < terms; ++n) out[n] += s.h(a, s.points)[j] * power * f[n - 1 - j];
        }
    }
    if (threaded()) {
        double *F = force_.data() + contacts * stride, *p = p_.data() + contacts * stride;
        p[0] -= s.height[contacts];
        std::fill_n(F, size, 0.0);
        for (int n = 0; n + 1 < terms; ++n) p[n] = s.k[contacts] * p[n] + s.r[contacts] / length * p[n + 1];
        sweep_->combine(F, size, p, terms - 1, reply_.data() + stride, -1);
        std::fill(F + terms - 1, F + size, 0.0);
        for (int a = 0; a < contacts; ++a)
            sweep_->combine(free_.data() + a * stride, size, F, terms - 1, by_thread_.data() + a * stride + size - 1, -1);
    }
    double largest = 0, most = s.pluck_reach;
    for (int b = 0; b < contacts; ++b) {
        double* f = free_.data() + b * stride;
        std::fill(f + terms, f + size, 0.0);
        f[0] -= s.height[b];
        double scale = 1;
        for (int n = 0; n < terms; ++n, scale /= reach) largest = std::max(largest, std::abs(f[n]) * scale);
        most = std::max(most, reach_[b] + std::abs(s.height[b]) + s.pluck_reach);
    }
    truncation_ = largest * tail_ + modal_tail_ * most;
    rounding_ = unit_rounding * most;
}

void MacroWindow::state_at(double at, const double* M, const double* y, const double* u, double* y_out, double* u_out) noexcept {
    const Springs& s = springs;
    double e[3 * most_terms];
    powers(at, 2 * size + 1, e);
    int acting = 0;
    const auto act = [&](int force, const double* m) {
        acting_moments_[acting] = m;
        acting_[acting++] = gains_.data() + static_cast<long>(force) * osc.padded;
    };
    for (int b = 0; b < contacts; ++b)
        if (M[b * stride] != 0) act(b, M + b * stride);
    thread_impulse_ = 0;
    if (threaded()) {  // its own motion, and its answer kappa_b * F_b to each contact
        double* m = moments_.data() + contacts * stride;
        std::fill_n(m, size, 0.0);
        sweep_->combine(m, size, force_.data() + contacts * stride, terms - 1, e + 1, 1);
        for (int b = 0; b < contacts; ++b)
            if (M[b * stride] != 0) sweep_->combine(m, size, answer_.data() + b * stride, terms - 1, M + b * stride + 1, 1);
        thread_impulse_ = m[0] * seconds();
        act(contacts, m);
    }
    if (plucked_) {
        double* m = moments_.data() + s.points * stride;
        std::fill_n(m, size, 0.0);
        sweep_->combine(m, size, force_.data() + s.points * stride, terms, e + 1, 1);
        act(s.points, m);
    }
    const double* flow = flow_.data();
    if (at != 1) {
        free_flow(at, flow_at_);
        flow = flow_at_.data();
    }
    ModalSweep m;
    m.modes = osc.padded;
    m.forces = acting;
    m.terms = sweep_terms_.data();
    m.y = y, m.u = u, m.a = a_.data(), m.b = b_.data();
    m.e11 = flow, m.e12 = flow + osc.padded, m.e21 = flow + 2 * osc.padded, m.e22 = flow + 3 * osc.padded;
    m.gains = acting_.data(), m.moments = acting_moments_.data();
    m.y_out = y_out, m.u_out = u_out;
    sweep_->move(m);
}

void MacroWindow::spend_at(double at, double weight, const double* y, const double* u, Energies& e) noexcept {
    const Springs& s = springs;
    state_at(at, node_moments_.data(), y, u, y_node_.data(), u_node_.data());
    const auto reading = [&](const double* g) {
        double v = 0;
        for (int i = 0; i < osc.padded; ++i) v += g[i] * u_node_[i];
        return v;
    };
    double loss = 0;
    for (int i = 0; i < osc.padded; ++i) loss += loss_[i] * u_node_[i] * u_node_[i];
    if (threaded()) {
        const double v = reading(s.weights.data() + static_cast<long>(contacts) * osc.padded);
        loss += s.r[contacts] / osc.rate * v * v;
    }
    e.dissipated += weight * loss / seconds();  // v = u/seconds, dt = seconds
    if (!plucked_) return;
    const double* F = force_.data() + s.points * stride;
    double Fe = 0;
    for (int n = terms - 1; n >= 0; --n) Fe = Fe * at + F[n] * inverse_factorial[n];
    e.supplied += weight * Fe * reading(s.gains.data() + static_cast<long>(s.points) * osc.padded) * mass_ * osc.rate * osc.rate;
}

}  // namespace jvari

#include "reference/exact/macro_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/exact/pluck_series.hpp"
#include "reference/masses.hpp"
#include "reference/readout.hpp"

namespace jvari {

const std::vector<double> inverse_factorial = [] {
    std::vector<double> f{1.0};
    for (int n = 1; n <= 2 * longest_series; ++n) f.push_back(f.back() / n);
    return f;
}();

namespace {
constexpr double unit_rounding = 16 * 2.3e-16;  // for a gap, relative to sum |g_i| (|y_i| + |u_i|)

double tail(double z, int terms) {  // sum_{n >= terms} z^n/n!
    double term = 1;
    for (int n = 1; n <= terms; ++n) term *= z / n;
    return z < terms ? term / (1 - z / (terms + 1)) : HUGE_VAL;
}
}  // namespace

void powers(double u, int count, double* e) noexcept {
    sweep_functions().powers(u, count, inverse_factorial.data(), e);
}

WindowChoice choose_window(double tolerance, double reach, bool split) {
    const auto of_windows = [&](double longest, int most) {
        WindowChoice c;
        c.per_row = std::max(
            1L,
            static_cast<long>(std::ceil(std::min(
                0.5 * static_cast<double>(std::numeric_limits<long>::max()), reach / longest))));
        c.terms = 6;
        while (c.terms < most && tail(reach / c.per_row, c.terms) > 0.1 * tolerance) ++c.terms;
        return c;
    };
    const auto c = of_windows(longest_reach, most_split_terms);
    if (split) return c;
    const auto longer = of_windows(longest_unsplit, most_terms);
    return tail(reach / longer.per_row, longer.terms) > 0.1 * tolerance ? c : longer;
}

MacroWindow::MacroWindow(const Modes& modes, const String& s, double interval, double tolerance,
                         const std::optional<InSeries>& series, int windows, int kept)
    : osc(modes),
      springs(modes, osc, s, series),
      contacts(springs.contacts),
      sweep_(&sweep_functions()),
      series_(series) {
    if (s.pluck) pluck_.push_back(*s.pluck);
    none_.assign(contacts + 1, 0);
    const double growth = largest_eigenvalue();
    const bool split = contacts > 0;
    const auto choice = choose_window(tolerance, growth * osc.rate * interval, split);
    per_row = windows > 0 ? windows : choice.per_row;
    terms = kept > 0 ? kept : choice.terms;
    // 16: a collocated path has degree 9
    size = std::max(16, (terms + lanes - 1) / lanes * lanes);
    stride = 2 * size + lanes;
    known_ = std::min(terms, size - 1);
    length = osc.rate * interval / per_row;
    reach = growth * length;
    for (int n = 0; n < terms; ++n) slower_.push_back(std::pow(reach, -n));
    if (s.pluck) push_growth_ = 0.5 * std::numbers::pi * seconds() / pluck_window(*s.pluck);
    tail_ = tail(reach, terms);
    modal_tail_ = 10 * std::exp(reach) * tail(length, terms) / std::min(1.0, length);

    a_ = osc.a, b_ = osc.b;
    for (double& x : a_) x *= length;
    for (double& x : b_) x *= length * length;
    make_base(modes);
    for (int i = 0; i < osc.padded; i += sweep_lanes) {
        double fastest = 0;  // root of x^2 - a x + b, or its size
        for (int j = i; j < std::min(i + sweep_lanes, osc.padded); ++j)
            fastest = std::max(fastest, a_[j] * a_[j] > 4 * b_[j] ? a_[j] : std::sqrt(b_[j]));
        int n = 4;
        while (n < terms && n * n * tail(fastest, n) > (split ? 1e-6 : 1e-4) * tolerance) ++n;
        sweep_terms_.push_back(n);
    }
    const std::size_t points = springs.points + 1, forces = springs.forces + 1;
    for (auto* v : {&p_, &free_}) v->assign(points * stride, 0.0);
    for (auto* v : {&force_, &moments_}) v->assign(forces * stride, 0.0);
    reach_.assign(points, 0.0);
    acting_.resize(forces + 2);  // plus the state at the window's start, in the form of impulses
    acting_moments_.resize(forces + 2);
    scratch_.resize((points * (stride + 1) + 4 * size) * lanes);
    zeros_.assign(4 * osc.padded, 0.0);
    ones_.assign(osc.padded, 1.0);
    impulse_.assign(osc.padded, 0.0);
    offset_ = impulse_;
    base_moments_.assign(stride, 0.0);
    flow_ = flow_at_ = zeros_;
    if (series_) {
        in_window_.emplace_back(*series_, seconds(), size, terms);
        z_.assign(series_->states, 0.0);
        z_now_ = z_;
        moments_of_.assign(springs.points, nullptr);
    }
    free_flow(1, flow_);
    make_kernel();
    put_weight(modes, s);
}

void MacroWindow::put_weight(const Modes& modes, const String& s) {
    const std::vector<double> force = falling(modes, s);
    for (int i = 0; i < modes.count(); ++i)
        if (force[i] != 0) falls_.emplace_back(i, force[i] / modes.mass * seconds() * seconds());
}

void MacroWindow::fall(double at, double* y_out, double* u_out) const noexcept {
    for (const auto& [mode, a] : falls_) {
        y_out[mode] += 0.5 * a * at * at;
        u_out[mode] += a * at;
    }
}

void MacroWindow::make_base(const Modes& modes) {
    const int M = osc.padded, last = springs.points - 1;
    const double gain = length * length / (modes.mass * osc.rate * osc.rate);
    base_.assign(M, 0.0);
    over_base_ = base_;
    for (int i = 0; i < modes.count(); ++i) {
        double most = 0;
        for (int a = 0; a < springs.points; ++a)
            most = std::max(most, std::abs(springs.weights[a * M + i]));
        for (int f = 0; f < springs.forces; ++f)
            most = std::max(most, std::abs(springs.gains[f * M + i]) * length * length / gain);
        const double own = last >= 0 ? springs.weights[last * M + i] : 1;
        base_[i] = std::abs(own) > 1e-100 * most ? own : most > 0 ? 1e-100 * most : 1;
        over_base_[i] = 1 / base_[i];
    }
    base_gain_ = gain;
    weights_ = springs.weights, gains_ = springs.gains;
    for (std::size_t i = 0; i < weights_.size(); ++i) weights_[i] *= over_base_[i % M];
    for (std::size_t i = 0; i < gains_.size(); ++i)
        gains_[i] *= length * length * over_base_[i % M];
}

// The thread's force follows from its point's motion without the force: F_c = k (h - y_c) - r y_c',
// y_c = p_c + h_cc * F_c, so
//     F_c (1 + (r s + k) h_cc) = -(k + r d/dt)(p_c - h)
// in Laplace transforms. Returns the reciprocal series of the bracket, with its sign turned. (With
// series compliance h_cc(0) is not zero.)
std::vector<double> MacroWindow::reply_series(double window, int count) const {
    const double k = springs.k[contacts], r = springs.r[contacts] / window;
    std::vector<double> h(count), bracket(count, 0.0), g(count);
    double scale = window;
    for (int n = 0; n < count; ++n, scale *= window)
        h[n] = springs.h(contacts, contacts)[n] * scale;
    bracket[0] = 1 + r * h[0];
    for (int m = 1; m < count; ++m) bracket[m] = k * h[m - 1] + r * h[m];
    g[0] = -1 / bracket[0];
    for (int n = 1; n < count; ++n) {
        for (int m = 1; m <= n; ++m) g[n] -= bracket[m] * g[n - m];
        g[n] /= bracket[0];
    }
    return g;
}

// F_c for a motion of the thread's point.
void MacroWindow::answer(const double* reply, const double* motion, double window, int count,
                         double* F) const {
    const double k = springs.k[contacts], r = springs.r[contacts] / window;
    std::vector<double> x(count, 0.0);
    for (int n = 0; n + 1 < count; ++n) x[n] = k * motion[n] + r * motion[n + 1];
    for (int n = 0; n < count; ++n) {
        F[n] = 0;
        for (int m = 0; m <= n; ++m) F[n] += reply[m] * x[n - m];
    }
}

// Response of every point and of F_c to a unit impulse at a point, y[point][count] and F[count],
// per derivative.
void MacroWindow::impulse_response(int force, double window, int count, const double* reply,
                                   double* y, double* F) const {
    double power = window;
    for (int n = 0; n < count; ++n, power *= window)
        for (int a = 0; a < springs.points; ++a) y[a * count + n] = springs.h(a, force)[n] * power;
    std::fill_n(F, count, 0.0);
    if (!threaded()) return;
    const std::vector<double> p(y + contacts * count, y + (contacts + 1) * count);
    answer(reply, p.data(), window, count, F);
    for (int a = 0; a < springs.points; ++a)
        for (int n = 0; n < count; ++n) {
            double power_j = window;
            for (int j = 0; j < n; ++j, power_j *= window)
                y[a * count + n] += springs.h(a, contacts)[j] * power_j * F[n - 1 - j];
        }
}

// Largest eigenvalue for the string with its thread and series compliance [rate]: the final growth
// ratio between derivatives of impulse responses.
double MacroWindow::largest_eigenvalue() const {
    double largest = 1;
    if (!threaded() && !series_) return largest;
    constexpr int count = longest_series;
    const double majorant = springs.growth(none_.data());
    const auto reply = threaded() ? reply_series(1 / majorant, count) : std::vector<double>();
    std::vector<double> y(static_cast<std::size_t>(springs.points) * count), F(count);
    for (int b = 0; b < springs.points; ++b) {
        impulse_response(b, 1 / majorant, count, reply.data(), y.data(), F.data());
        for (int a = 0; a < springs.points; ++a) {
            const auto largest_from = [&](int from) {
                double most = 0;
                for (int n = from; n < from + 6; ++n)
                    most = std::max(most, std::abs(y[a * count + n]));
                return most;
            };
            constexpr int early = count / 2, late = count - 6;
            if (largest_from(early) > 0)
                largest =
                    std::max(largest, majorant * std::pow(largest_from(late) / largest_from(early),
                                                          1.0 / (late - early)));
        }
    }
    // forces drive the series state, like the modes
    const double alone = series_ ? series_rate(*series_) / osc.rate : 0;
    return std::max(alone, std::min(largest, majorant));
}

// Response to a unit impulse at b: of the points, through the modes and the thread, and of the
// thread's force.
void MacroWindow::make_kernel() {
    kernel_.assign(static_cast<std::size_t>(contacts) * contacts * (stride + size) + size, 0.0);
    answer_.assign(static_cast<std::size_t>(contacts) * stride + 1, 0.0);
    by_thread_.assign(static_cast<std::size_t>(contacts + 1) * stride, 0.0);
    reply_.assign(2 * stride, 0.0);
    if (threaded()) {  // zeros before it: a convolution reads them
        const auto g = reply_series(length, known_ + 1);
        std::copy(g.begin(), g.end(), reply_.data() + stride);
    }
    const int count = known_ + 1;
    std::vector<double> y(static_cast<std::size_t>(springs.points) * count), F(count);
    for (int b = 0; b < contacts; ++b) {
        impulse_response(b, length, count, reply_.data() + stride, y.data(), F.data());
        double scale = 1;
        for (int n = 0; n < terms; ++n, scale *= reach) {
            for (int a = 0; a < contacts; ++a) {
                const double h = y[a * count + n];
                kernel_[(static_cast<std::size_t>(a) * contacts + b) * (stride + size) + size + n] =
                    h;
                kernel_truncation_ = std::max(kernel_truncation_, std::abs(h) / scale * tail_);
            }
        }
        if (threaded()) std::copy_n(F.begin(), known_, answer_.begin() + b * stride);
    }
    if (!threaded()) return;
    double power = length;
    for (int n = 0; n < terms; ++n, power *= length)
        for (int a = 0; a < contacts; ++a)
            by_thread_[a * stride + size + n] = springs.h(a, contacts)[n] * power;
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

void MacroWindow::open(const double* y, const double* u, bool plucked, double since_pluck,
                       const double* z) noexcept {
    const Springs& s = springs;
    plucked_ = plucked;
    ModalSweep m;
    m.modes = osc.padded;
    m.outputs = s.points;
    m.count = size;
    m.stride = stride;
    m.terms = sweep_terms_.data();
    m.y = y, m.u = u, m.a = a_.data(), m.b = b_.data(), m.base = base_.data(),
    m.weights = weights_.data();
    m.p = p_.data(), m.reach = reach_.data(), m.scratch = scratch_.data();
    sweep_->read(m);
    if (series_) std::copy_n(z, series_->states, z_.begin());
    for (int a = 0; series_ && a < s.points; ++a) {
        in_window_.front().add_free(a, z, p_.data() + a * stride);
        reach_[a] += std::abs(z[a]);
    }
    std::copy_n(p_.begin(), contacts * stride, free_.begin());
    if (plucked) {
        double* f = force_.data() + s.points * stride;
        std::fill_n(f, stride, 0.0);
        pluck_series(pluck_[0], since_pluck, seconds(), known_ + 1, f);
        for (int n = 0; n <= known_; ++n) f[n] /= inverse_factorial[n];
        for (int a = 0; a < s.points; ++a) {
            double power = length;
            double* out = (a < contacts ? free_.data() : p_.data()) + a * stride;
            for (int j = 0; j < known_; ++j, power *= length)
                for (int n = j + 1; n <= known_; ++n)
                    out[n] += s.h(a, s.points)[j] * power * f[n - 1 - j];
            for (int n = 0; series_ && n <= known_; ++n) out[n] += series_->plucked(a) * f[n];
        }
    }
    if (threaded()) {
        double *F = force_.data() + contacts * stride, *p = p_.data() + contacts * stride;
        p[0] -= s.height[contacts];
        const double k = s.k[contacts], r = s.r[contacts] / length;
        for (int n = 0; n < known_; ++n) p[n] = k * p[n] + r * p[n + 1];
        sweep_->combined(F, size, p, known_, reply_.data() + stride, -1);
        std::fill(F + known_, F + size, 0.0);
        for (int a = 0; a < contacts; ++a) {
            double* f = free_.data() + a * stride;
            sweep_->combine(f, size, F, known_, by_thread_.data() + a * stride + size - 1, -1);
        }
    }
    double largest = 0, most = s.pluck_reach;
    for (int b = 0; b < contacts; ++b) {
        double* f = free_.data() + b * stride;
        std::fill(f + terms, f + size, 0.0);
        for (const auto& [mode, a] : falls_) f[2] += s.weights[b * osc.padded + mode] * a;
        f[0] -= s.height[b];
        for (int n = 0; n < terms; ++n) largest = std::max(largest, std::abs(f[n]) * slower_[n]);
        most = std::max(most, reach_[b] + std::abs(s.height[b]) + s.pluck_reach);
    }
    truncation_ = largest * tail_ + modal_tail_ * most;
    // the thread passes on the rounding at its point
    rounding_ = unit_rounding * (most + (threaded() ? reach_[contacts] : 0));
}

// Collects the forces acting on the modes until `at`, with powers e; returns their number, and
// computes their effect on the thread.
int MacroWindow::act(double at, const double* e, const double* M) noexcept {
    const Springs& s = springs;
    int acting = 0;
    std::fill_n(base_moments_.begin(), size, 0.0);
    const auto push = [&](int force, const double* m) {
        if (force == s.points - 1) {
            for (int n = 0; n < size; ++n) base_moments_[n] = base_gain_ * m[n];
            return;
        }
        acting_moments_[acting] = m;
        acting_[acting++] = gains_.data() + static_cast<long>(force) * osc.padded;
    };
    for (int b = 0; b < contacts; ++b)
        if (M[b * stride] != 0) push(b, M + b * stride);
    thread_impulse_ = 0;
    if (threaded()) {  // the thread's own motion, and its answer kappa_b * F_b to each contact
        double* m = moments_.data() + contacts * stride;
        sweep_->combined(m, size, force_.data() + contacts * stride, known_, e + 1, 1);
        for (int b = 0; b < contacts; ++b)
            if (M[b * stride] != 0)
                // kappa^(n) with M_(n+1)
                sweep_->combine(m, size, answer_.data() + b * stride, known_, M + b * stride + 1,
                                1);
        thread_impulse_ = m[0] * seconds();
        if (series_) {  // no other code needs this
            double now[3];
            sweep_->evaluate(force_.data() + contacts * stride, size, at, now);
            thread_force_ = now[0];
            for (int b = 0; b < contacts; ++b)
                if (M[b * stride] != 0)
                    thread_force_ +=
                        weighted_sum(answer_.data() + b * stride, M + b * stride, terms);
        }
        push(contacts, m);
    }
    if (plucked_) {
        double* m = moments_.data() + s.points * stride;
        sweep_->combined(m, size, force_.data() + s.points * stride, terms, e + 1, 1);
        push(s.points, m);
    }
    if (series_) {
        for (int b = 0; b < contacts; ++b)
            moments_of_[b] = M[b * stride] != 0 ? M + b * stride : nullptr;
        if (threaded()) moments_of_[contacts] = moments_.data() + contacts * stride;
        in_window_.front().move(at, z_.data(), moments_of_.data(), z_now_.data());
    }
    return acting;
}

void MacroWindow::move(int forces, const double* flow, const double* y, const double* u,
                       double* y_out, double* u_out) noexcept {
    ModalSweep m;
    m.modes = osc.padded;
    m.forces = forces;
    m.terms = sweep_terms_.data();
    m.y = y, m.u = u, m.a = a_.data(), m.b = b_.data();
    m.e11 = flow, m.e12 = flow + osc.padded, m.e21 = flow + 2 * osc.padded,
    m.e22 = flow + 3 * osc.padded;
    m.base = base_.data(), m.base_moments = base_moments_.data();
    m.gains = acting_.data(), m.moments = acting_moments_.data();
    m.y_out = y_out, m.u_out = u_out;
    sweep_->move(m);
}

void MacroWindow::state_at(double at, const double* M, const double* y, const double* u,
                           double* y_out, double* u_out) noexcept {
    double until[3 * most_terms];
    const double *e = inverse_factorial.data(), *flow = flow_.data();  // at^n/n!
    if (at != 1) {
        powers(at, 2 * size + 1, until), e = until;
        free_flow(at, flow_at_);
        flow = flow_at_.data();
    }
    move(act(at, e, M), flow, y, u, y_out, u_out);
    fall(at, y_out, u_out);
}

void MacroWindow::state_near(double at, const double* M, const double* y, const double* u,
                             double* y_out, double* u_out) noexcept {
    double until[3 * most_terms] = {0};
    const double* e = until + 1;
    powers(at, 2 * size + 1, until + 1);
    int acting = act(at, e, M);
    for (int i = 0; i < osc.padded; ++i) {
        impulse_[i] = (u[i] + a_[i] * y[i]) * over_base_[i];
        offset_[i] = y[i] * over_base_[i];
    }
    acting_[acting] = impulse_.data(), acting_moments_[acting++] = e;
    acting_[acting] = offset_.data(), acting_moments_[acting++] = e - 1;
    move(acting, zeros_.data(), y, u, y_out, u_out);
    fall(at, y_out, u_out);
}

MacroWindow::Push MacroWindow::push_at(double at) const noexcept {
    Push p;
    const double* F = force_.data() + springs.points * stride;
    for (int n = terms - 1; plucked_ && n >= 0; --n) {
        p.change = n + 1 < terms ? p.change * at + F[n + 1] * inverse_factorial[n] : 0;
        p.force = p.force * at + F[n] * inverse_factorial[n];
    }
    return p;
}

}  // namespace jvari

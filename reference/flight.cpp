#include "reference/flight.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>

#include "reference/pluck_series.hpp"

namespace jvari {

namespace {
constexpr double reach_of_window = 4.5;    // window x growth rate; 30 terms
constexpr double truncation = 1e-18;       // of every series, relative
constexpr double rounding = 16 * 2.3e-16;  // of a gap, relative to sum |g_i| (|y_i| + |v_i|/rate)

const std::vector<double> inverse_factorial = [] {
    std::vector<double> f{1.0};
    for (int n = 1; n <= 2 * longest_series; ++n) f.push_back(f.back() / n);
    return f;
}();
}  // namespace

Flight::Flight(const Modes& modes, const String& s) : osc(modes), springs(modes, osc, s), mass_(modes.mass) {
    if (s.pluck) pluck_.push_back(*s.pluck);
    none_.assign(springs.contacts + 1, 0);
    growth_ = springs.growth(none_.data());
    for (int i = 0; i < modes.count(); ++i) loss_.push_back(2 * modes.mass * modes.sigma[i] * osc.rate);  // x u^2 d(rate t)
    loss_ = osc.pad(loss_);
    for (auto* v : {&p_, &displacement_, &gap_}) v->assign(static_cast<std::size_t>(springs.points + 1) * longest_series, 0.0);
    for (auto* v : {&force_, &moments_}) v->assign(static_cast<std::size_t>(springs.forces + 1) * longest_series, 0.0);
    reach_.assign(springs.points + 1, 0.0);
    impulse_.assign(springs.forces + 1, 0.0);
    acting_.resize(springs.forces + 1);
    scratch_.resize(static_cast<std::size_t>(springs.points + 1) * (longest_series + 1) * lanes);
    y_node_.assign(osc.padded, 0.0);
    u_node_ = y_node_;
    gsl_integration_glfixed_table* table = gsl_integration_glfixed_table_alloc(nodes);
    for (int q = 0; q < nodes; ++q) gsl_integration_glfixed_point(0, 1, q, &node_[q], &weight_[q], table);
    gsl_integration_glfixed_table_free(table);
}

Flight::Landing Flight::fly(double left, bool plucked, double since_pluck, int leaving, double* y, double* u, Sums& sums,
                            bool probe) noexcept {
    const Springs& s = springs;
    double z = reach_of_window / growth_;
    if (plucked) z = std::min(z, pluck_window(pluck_[0]) * osc.rate);
    z = left / std::ceil(left / z);
    const int p_terms = terms_for(z, truncation, longest_series);
    series(osc, y, u, s.weights.data(), s.points, p_terms, p_.data(), longest_series, reach_.data(), scratch_.data());
    terms_ = terms_for(growth_ * z, truncation, longest_series);
    double power = 1;
    for (int n = 0; n < p_terms; ++n, power *= z)
        for (int a = 0; a < s.points; ++a) p_[a * longest_series + n] *= power;
    if (leaving >= 0) p_[leaving * longest_series] = s.height[leaving];
    if (!pluck_.empty()) {
        double* f = force_.data() + s.points * longest_series;
        std::fill_n(f, longest_series, 0.0);
        if (plucked) {
            pluck_series(pluck_[0], since_pluck, z / osc.rate, terms_, f);
            for (int n = 0; n < terms_; ++n) f[n] /= inverse_factorial[n];
        }
    }
    s.solve(none_.data(), z, p_.data(), p_terms, terms_, displacement_.data(), force_.data());

    Landing landing{1, -1};
    for (int a = 0; a < s.contacts; ++a) {
        double* gap = gap_.data() + a * longest_series;
        const double* at = displacement_.data() + a * longest_series;
        for (int n = 0; n < terms_; ++n) gap[n] = (at[n] - (n == 0 ? s.height[a] : 0)) * inverse_factorial[n];
        const double* leading = std::find_if(gap, gap + terms_, [](double c) { return c != 0; });
        if (leading != gap + terms_ && *leading < 0) return {0, a};  // it touches already
        if (leading != gap + terms_ && !(*leading > 0)) return {-1, -1};
        const double tolerance = bound(a, z, p_terms, growth_);
        tolerance_ = std::max(tolerance_, 2 * tolerance);
        const double contact = first_negative(gap, terms_, tolerance);
        if (contact <= landing.length) landing = {contact, a};
    }
    if (probe) spend(landing.length, z, p_terms, plucked, y, u, sums);
    to(landing.length, z, p_terms, plucked, y, u, y, u);
    if (s.points > s.contacts) sums.thread += impulse_[s.contacts];
    landing.length = landing.length == 1 && z == left ? left : landing.length * z;
    return landing;
}

// How far a gap may be from its series: modes and kernel cut after p_terms, the points' own series after terms_, rounding.
double Flight::bound(int a, double z, int p_terms, double growth) const noexcept {
    const Springs& s = springs;
    double largest = 0, reach = reach_[a] + std::abs(s.height[a]) + s.pluck_reach;
    for (int b = 0; b < s.points; ++b) {
        const double* y = displacement_.data() + b * longest_series;
        double scale = 1, force = 0;
        for (int n = 0; n < terms_; ++n, scale *= growth * z) {
            largest = std::max(largest, std::abs(y[n] - (n == 0 ? s.height[b] : 0)) / scale);  // C of springs.hpp
            force += std::abs(force_[b * longest_series + n]) * inverse_factorial[n];
        }
        reach = std::max(reach, reach_[b] + s.pluck_reach);
        if (b >= s.contacts) reach += std::abs(s.h(a, b)[1]) * force * z;
    }
    const double beyond = series_tail(growth * z, terms_) / terms_;
    return largest * beyond + 10 * std::exp(growth * z) * series_tail(z, p_terms) * reach + rounding * reach;
}

void Flight::to(double fraction, double z, int p_terms, bool plucked, const double* y, const double* u, double* y_out,
                double* u_out) noexcept {
    const double t = fraction * z;
    const int terms = std::min(p_terms, terms_for(t, truncation, longest_series));
    int acting = 0;
    for (int b = springs.contacts; b < springs.forces; ++b) {
        impulse_[b] = 0;
        if (b >= springs.points && !plucked) continue;
        const double* F = force_.data() + b * longest_series;
        double* m = moments_.data() + acting * longest_series;
        std::fill_n(m, terms, 0.0);
        double power = 1;
        for (int j = 0; j < terms_ - 1; ++j, power *= fraction) {
            const double f = F[j] * power;
            const double* later = inverse_factorial.data() + j + 1;
            for (int n = 0; n < terms; ++n) m[n] += f * later[n];
        }
        power = t;
        for (int n = 0; n < terms; ++n, power *= t) m[n] *= power;  // int_0^t (t-s)^n/n! F(s) ds
        impulse_[b] = m[0] / osc.rate;
        acting_[acting++] = springs.gains.data() + static_cast<long>(b) * osc.padded;
    }
    jvari::fly(osc, y, u, t, terms, acting_.data(), moments_.data(), acting, longest_series, y_out, u_out);
}

void Flight::spend(double fraction, double z, int p_terms, bool plucked, const double* y, const double* u, Sums& sums) noexcept {
    const Springs& s = springs;
    for (int q = 0; q < nodes; ++q) {
        to(fraction * node_[q], z, p_terms, plucked, y, u, y_node_.data(), u_node_.data());
        double loss = 0;
        for (int i = 0; i < osc.padded; ++i) loss += loss_[i] * u_node_[i] * u_node_[i];
        if (s.points > s.contacts) {
            const double* g = s.weights.data() + static_cast<long>(s.contacts) * osc.padded;
            double v = 0;
            for (int i = 0; i < osc.padded; ++i) v += g[i] * u_node_[i];
            loss += s.r[s.contacts] * v * v;  // r_c v^2 dt = r_c rate u^2 d(rate t)
        }
        sums.dissipated += weight_[q] * fraction * z * loss;
        if (!plucked) continue;
        const double* F = force_.data() + s.points * longest_series;
        const double* gain = s.gains.data() + static_cast<long>(s.points) * osc.padded;
        double Fe = 0, v = 0;
        for (int n = terms_ - 2; n >= 0; --n) Fe = Fe * fraction * node_[q] + F[n] * inverse_factorial[n];
        for (int i = 0; i < osc.padded; ++i) v += gain[i] * u_node_[i];
        sums.supplied += weight_[q] * fraction * z * Fe * v * mass_ * osc.rate * osc.rate;
    }
}

}  // namespace jvari

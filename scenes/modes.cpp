// Source: van Walstijn et al. 2016, eqs 16-22; Issanchou et al. 2016, section 3.1. Both strings are
// the same stiff string: omega0^2 = (EI beta^4 + T beta^2)/mu.
#include "scenes/modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "scenes/damping.hpp"

namespace jvari {

using std::numbers::pi;

namespace {
double stiff_string_frequency(const String& s, double beta) {  // omega0 [rad/s]
    return beta * std::sqrt((s.tension + s.bending_stiffness * beta * beta) / s.linear_density);
}

struct DecayOf {
    const String& s;
    int mode;
    double beta, omega0;
    double operator()(const NoDamping&) const { return 0; }
    double operator()(const PolynomialDamping& law) const { return decay_rate(law, beta); }
    double operator()(const QualityFactorDamping& law) const {
        return decay_rate(law, s, omega0 / (2 * pi));
    }
    double operator()(const TableDamping& law) const { return law.decay_rate[mode - 1]; }
    double operator()(const PerPeriodDamping& law) const {
        return decay_rate(law, stiff_string_frequency(s, pi / s.length) / (2 * pi));
    }
};

struct OneMode {
    double beta, omega0, sigma;
};
double undamped_frequency(const String& s, int i) {  // omega0 of mode i [rad/s]
    const auto* table = std::get_if<TableDamping>(&s.damping);
    return table ? 2 * pi * table->frequency_hz[i - 1]
                 : stiff_string_frequency(s, i * pi / s.length);
}
OneMode mode_of(const String& s, int i) {
    const double beta = i * pi / s.length, omega0 = undamped_frequency(s, i);
    return {beta, omega0, std::visit(DecayOf{s, i, beta, omega0}, s.damping)};
}
}  // namespace

std::optional<int> modes_measured(const String& s) {
    const auto* table = std::get_if<TableDamping>(&s.damping);
    if (!table) return {};
    return static_cast<int>(std::min(table->frequency_hz.size(), table->decay_rate.size()));
}

double omega_squared_damped(double omega0, double sigma) {
    return (omega0 - sigma) * (omega0 + sigma);
}

Modes modes_of(const String& s, int count) {
    if (const auto measured = modes_measured(s); measured && count > *measured)
        throw BadScene("string.damping.file", std::to_string(*measured) + " measured modes",
                       "at least the " + std::to_string(count) + " modes asked for");
    if (count > most_modes)
        throw BadScene("modes", std::to_string(count) + " of them asked for",
                       "no more than " + std::to_string(most_modes));
    Modes modes;
    modes.mass = 0.5 * s.linear_density * s.length;
    for (int i = 1; i <= count; ++i) {
        const auto [beta, omega0, sigma] = mode_of(s, i);
        modes.beta.push_back(beta);
        modes.omega0.push_back(omega0);
        modes.sigma.push_back(sigma);
    }
    return modes;
}

int modes_below(const String& s, double hertz) {
    const double limit = 2 * pi * hertz;
    // frequencies ascend: mode `low` is below, mode `high` + 1 is not
    int low = 0, high = modes_measured(s).value_or(most_modes + 1);
    while (low < high) {
        const int middle = low + (high - low + 1) / 2;
        if (undamped_frequency(s, middle) < limit) low = middle;
        else high = middle - 1;
    }
    return low;
}

std::vector<double> displacement_weights(const Modes& modes, double position) {
    std::vector<double> w;
    for (double beta : modes.beta) w.push_back(std::sin(beta * position));
    return w;
}

std::vector<double> weights_below(double hertz, std::vector<double> weights, const Modes& modes) {
    for (int i = 0; i < modes.count(); ++i)
        if (!(modes.omega0[i] < 2 * pi * hertz)) weights[i] = 0;
    return weights;
}

std::vector<double> footprint_weights(const Modes& modes, double position, double width,
                                      double sign) {
    std::vector<double> w;
    for (double beta : modes.beta) {
        // cos(beta w/2) = sin(gap/2); the quotient tends to 1/2 as gap -> 0
        const double gap = pi - beta * width;
        const double window = std::abs(gap) < 1e-8
                                  ? pi / 4
                                  : pi * pi * std::sin(0.5 * gap) / (gap * (pi + beta * width));
        w.push_back(sign * window * std::sin(beta * position));  // (20)
    }
    return w;
}

std::vector<double> contact_weights(const Modes& modes, const LumpedBarrier& b) {
    return footprint_weights(modes, b.position, b.width, b.sign());
}

std::vector<double> nut_force_weights(const Modes& modes, const String& s) {
    std::vector<double> w;
    for (int i = 0; i < modes.count(); ++i) {
        // cos(i pi) for mode i + 1
        const double beta = modes.beta[i], sign = i % 2 == 0 ? -1 : 1;
        // v' = beta cos, v''' = -beta^3 cos  (22)
        w.push_back(-sign * beta * (s.tension + s.bending_stiffness * beta * beta));
    }
    return w;
}

std::vector<double> end_inertia(const Modes& modes, const String& s) {
    std::vector<double> mu;
    for (double beta : modes.beta) mu.push_back(s.linear_density / beta);
    return mu;
}

double static_compliance(const Modes& modes, const std::vector<double>& w) {
    double sum = 0;
    for (int i = 0; i < modes.count(); ++i)
        sum += w[i] * w[i] / (modes.mass * modes.omega0[i] * modes.omega0[i]);
    return sum;
}

}  // namespace jvari

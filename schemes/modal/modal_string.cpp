// Source: van Walstijn et al. 2016, eqs 16-22 and 33.
#include "schemes/modal/modal_string.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/excitation.hpp"
#include "schemes/making.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

using std::numbers::pi;

void refuse_above_nyquist(const Descriptor& d, const Modes& modes, double sample_rate) {
    for (int i = 0; i < modes.count(); ++i) {
        const double square = omega_squared_damped(modes.omega0[i], modes.sigma[i]);
        if (square >= pi * pi * sample_rate * sample_rate)
            throw Refusal(std::string(d.name) + ": mode " + std::to_string(i + 1) + " at " + std::to_string(std::sqrt(square) / (2 * pi)) +
                          " Hz is not below half the sample rate of " + std::to_string(sample_rate) +
                          " Hz, where it would alias; ask for fewer modes or a higher rate");
    }
}

PluckSteps pluck_steps(const Pluck& pluck, double dt) {
    const double first = std::floor(pluck.start / dt), last = std::ceil((pluck.start + pluck.duration) / dt);
    constexpr double longest = 1 << 28, latest = 0.5 * static_cast<double>(std::numeric_limits<long>::max());  // [steps]
    if (!(last < latest && last - first < longest))
        throw Refusal("the pluck, from " + std::to_string(pluck.start) + " s on, for " + std::to_string(pluck.duration) +
                      " s, is too long or too late at " + std::to_string(1 / dt) + " Hz: its force is kept for every step, of which " +
                      std::to_string(1 << 28) + " fit");
    return {static_cast<long>(first), static_cast<long>(last - first)};
}

double sine_over(double omega, double t) {
    return omega > 0 ? std::sin(omega * t) / omega : omega < 0 ? std::sinh(omega * t) / omega : t;
}

ModalArray impulse_gain(const ModalString& m) {
    ModalArray gain;
    for (int i = 0; i < m.count; ++i) gain.push_back(m.dt * std::exp(-m.sigma[i] * m.dt) * sine_over(m.omega[i], m.dt) / m.mass);
    return gain;
}

double modal_dot(const ModalArray& a, const ModalArray& b) {
    double sum = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum += a[i] * b[i];
    return sum;
}

double modal_dot_by_eights(const ModalArray& a, const ModalArray& b) {
    double sum[8] = {};
    const double *x = a.data(), *y = b.data();
    for (std::size_t i = 0; i + 8 <= a.size(); i += 8)
        for (int k = 0; k < 8; ++k) sum[k] += x[i + k] * y[i + k];
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

ModalArray rest_increments(const ModalString& m) {
    ModalArray d(m.size);
    for (int i = 0; i < m.count; ++i) {  // C~ d^0 = (q^1 - q^0) + num q^0
        const double h = m.omega[i] * m.dt, over_omega = m.omega[i] == 0 ? m.dt : m.sigma[i] / m.omega[i];
        const double R = std::exp(-m.sigma[i] * m.dt), E = std::expm1(-m.sigma[i] * m.dt);
        const double half = m.omega[i] >= 0 ? std::sin(h / 2) : std::sinh(-h / 2), whole = m.omega[i] >= 0 ? std::sin(h) : std::sinh(h);
        const double even = m.omega[i] >= 0 ? -2 * half * half : 2 * half * half;  // cos h - 1
        const double odd = m.omega[i] == 0 ? m.sigma[i] * m.dt : over_omega * whole;
        d[i] = (E + R * (even + odd) + m.num[i]) / (1 - m.loss[i]) * m.y0[i];
    }
    return d;
}

std::vector<FreeMode> three_point_modes(const ModalString& m) {
    std::vector<FreeMode> all;
    all.reserve(m.count);
    for (int i = 0; i < m.count; ++i) all.push_back(three_point_mode(m.num[i], m.loss[i], m.dt));
    return all;
}

ModalString modal_string(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    ModalString m;
    m.steps_per_row = steps_per_row(settings);
    m.dt = 1 / settings.sample_rate;
    const Modes modes = modes_of(s, settings);
    refuse_above_nyquist(descriptor, modes, settings.sample_rate);
    m.count = modes.count();
    m.size = (m.count + modal_lanes - 1) / modal_lanes * modal_lanes;
    m.mass = modes.mass;
    const auto padded = [&m](const auto& v) {
        ModalArray a(v.begin(), v.end());
        a.resize(m.size);
        return a;
    };
    for (int i = 0; i < m.count; ++i) {
        const ModeStep step = exact_step(modes.omega0[i], modes.sigma[i], m.dt);
        const double square = omega_squared_damped(modes.omega0[i], modes.sigma[i]);
        m.num.push_back(step.num);
        m.den.push_back(step.den);
        m.loss.push_back(step.loss);
        m.omega.push_back(square >= 0 ? std::sqrt(square) : -std::sqrt(-square));
        m.sigma.push_back(modes.sigma[i]);
    }
    for (ModalArray* a : {&m.num, &m.den, &m.loss, &m.omega, &m.sigma}) *a = padded(*a);
    m.y0 = padded(initial_displacement(modes, s));
    if (!s.barriers.empty()) {
        const auto& b = std::get<LumpedBarrier>(s.barriers.front());
        const auto g = footprint_weights(modes, b.position, b.width);
        m.true_compliance = static_compliance(modes, g);
        m.g_b = padded(g);
        m.barrier = {b.stiffness.k, b.exponent};
        m.h_b = b.height;
    }
    if (s.thread) {
        m.g_c = padded(footprint_weights(modes, s.thread->position, s.thread->width));
        m.k_c = s.thread->stiffness;
        m.r_c = s.thread->damping;
        m.h_c = s.thread->height;
    }
    if (s.pluck) {
        m.g_e = padded(footprint_weights(modes, s.pluck->position, s.pluck->width));
        const PluckSteps steps = pluck_steps(*s.pluck, m.dt);
        m.pluck_first = steps.first;
        for (long n = steps.first; n <= steps.first + steps.count; ++n) m.pluck.push_back(force(*s.pluck, n * m.dt));
    }
    for (const Tap& tap : scene.taps) {
        ModalTap t{tap.quantity, {}};
        if (tap.quantity == Quantity::displacement || tap.quantity == Quantity::velocity)
            t.weights = padded(displacement_weights(modes, tap.position));
        if (tap.quantity == Quantity::nut_force) t.weights = padded(nut_force_weights(modes, s));
        m.taps.push_back(std::move(t));
    }
    return m;
}

bool touches_once_without_loss(const String& s) {
    if (s.barriers.empty()) return true;
    const auto* lumped = std::get_if<LumpedBarrier>(&s.barriers.front());
    return s.barriers.size() == 1 && lumped && lumped->contact_loss == 0;
}

}  // namespace jvari

// Source: van Walstijn et al. 2016, eqs 14-15 (pluck). The smoothed triangle is the string's modal
// series times a Hann window's spectrum.
#include "scenes/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "scenes/barrier.hpp"
#include "scenes/modes.hpp"
#include "scenes/start.hpp"

namespace jvari {

using std::numbers::pi;

std::size_t line_at(const Pluck& e, double t) {
    const auto k = std::upper_bound(e.time.begin(), e.time.end(), t) - e.time.begin();
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k - 1, 0, std::ssize(e.time) - 2));
}

double next_knot(const Pluck& e, double t) {
    const double end = e.start + e.duration;
    if (t < e.start || t >= end) return t < end ? e.start : HUGE_VAL;
    return e.time.empty() ? end : std::min(e.time[line_at(e, t) + 1], end);
}

namespace {
// (14), (15) at the share x of the duration
double raised(const Pluck& e, double x) {
    // sinh(s x)/sinh(s) = exp(s(x-1)) (1 - exp(-2 s x))/(1 - exp(-2 s)): no overflow; the limit x
    // for s -> 0.
    const double warped = e.skew == 0 ? x
                                      : std::exp(e.skew * (x - 1)) * std::expm1(-2 * e.skew * x) /
                                            std::expm1(-2 * e.skew);
    const double h = 0.5 * (x + warped);  // h_e/tau_e  (15)
    const double sine = std::sin(pi * h);
    return e.amplitude * sine * sine;  // (14)
}

double on_line(const Pluck& e, std::size_t k, double t) {
    return e.amplitude * (e.share[k] + (e.share[k + 1] - e.share[k]) * (t - e.time[k]) /
                                           (e.time[k + 1] - e.time[k]));
}

// Integrals over F and F (2s - 1) for s = 0 .. 1 in the step
struct Moments {
    double mean = 0, first = 0;
    // a piece of the step about `middle` in which F is a line: its mean and its rise
    void add_line(double middle, double width, double force, double rise) {
        mean += width * force;
        first += width * (force * (2 * middle - 1) + rise * width / 6);
    }
};

Moments of_lines(const Pluck& e, double t, double dt) {
    Moments sum;
    const double end = std::min(t + dt, e.start + e.duration);
    for (std::size_t k = line_at(e, t); k + 1 < e.time.size() && e.time[k] < end; ++k) {
        const double a = std::max(t, e.time[k]), b = std::min(end, e.time[k + 1]);
        if (!(b > a)) continue;
        const double from = on_line(e, k, a), to = on_line(e, k, b);
        sum.add_line((0.5 * (a + b) - t) / dt, (b - a) / dt, 0.5 * (from + to), to - from);
    }
    return sum;
}

// Five-point Gauss on panels, from the end backwards: narrow enough for the skewed end, in the
// range in which exp(s(x-1)) counts.
Moments of_analytic(const Pluck& e, double t, double dt) {
    constexpr double widest = 0.1;
    constexpr std::pair<double, double> rule[] = {{-0.9061798459386640, 0.1184634425280945},
                                                  {-0.5384693101056831, 0.2393143352496832},
                                                  {0, 0.2844444444444444},
                                                  {0.5384693101056831, 0.2393143352496832},
                                                  {0.9061798459386640, 0.1184634425280945}};
    Moments sum;
    const double from = std::max(0.0, (t - e.start) / e.duration), step = dt / e.duration,
                 begin = (e.start - t) / dt;
    for (double end = std::min(1.0, (t + dt - e.start) / e.duration), panel = 0; end > from;
         end = panel < end - from ? end - panel : from) {
        const double narrowing = e.skew * (1 - end) < 40 ? 1 + e.skew : 1;
        panel = std::min(widest / narrowing, end - from);
        for (const auto& [node, weight] : rule) {
            const double x = end - 0.5 * panel * (1 - node),
                         F = weight * panel / step * raised(e, x);
            sum.mean += F;
            sum.first += F * (2 * (begin + x / step) - 1);
        }
    }
    return sum;
}

Moments moments(const Pluck& e, double t, double dt) {
    if (t + dt <= e.start || t >= e.start + e.duration) return {};
    return e.time.empty() ? of_analytic(e, t, dt) : of_lines(e, t, dt);
}
}  // namespace

double force(const Pluck& e, double t) {
    const double u = t - e.start;
    if (u < 0 || u > e.duration) return 0;
    return e.time.empty() ? raised(e, u / e.duration) : on_line(e, line_at(e, t), t);
}

double mean_force(const Pluck& e, double t, double dt) { return moments(e, t, dt).mean; }
double first_moment(const Pluck& e, double t, double dt) { return 3 * moments(e, t, dt).first; }

double mean_about(const Pluck& e, double t, double dt) {
    const Moments after = moments(e, t, dt);
    if (t <= 0) return after.mean - after.first;
    const Moments before = moments(e, t - dt, dt);
    return 0.5 * (before.mean + before.first + after.mean - after.first);
}

std::optional<double> steady_from(const Pluck& e, double until) {
    if (e.time.empty() || e.time.back() < until) return {};
    std::size_t k = line_at(e, until);
    if (k > 0 && e.time[k] >= until) --k;
    if (e.time[k] >= until || e.share[k] != e.share[k + 1]) return {};
    while (k > 0 && e.share[k - 1] == e.share[k]) --k;
    return e.time[k];
}

double free_from(const Scene& scene) {
    double from = 0;
    for (const String& s : scene.strings)
        if (const auto& p = s.pluck; p && p->amplitude != 0 && p->start < scene.duration) {
            const double end = steady_from(*p, scene.duration).value_or(p->start + p->duration);
            from = std::max(from, p->kind == PluckKind::blow ? p->start : end);
        }
    return from;
}

double hann_smoothing(double beta, double s) {
    const double z = 0.5 * beta * s;
    if (z == 0) return 1;
    const double gap = 1 - z / pi;
    // sin z/z/((1-z/pi)(1+z/pi)) about z = pi
    if (std::abs(gap) < 1e-6) return 0.5 * (1 + 1.5 * gap);
    return std::sin(z) / z / (gap * (1 + z / pi));
}

double coefficient(const TriangleShape& t, double length, int mode) {
    // the square would overflow an int
    const double beta = mode * pi / length, x0 = t.position, number = mode;
    return 2 * t.amplitude * length * length / (number * number * pi * pi * x0 * (length - x0)) *
           std::sin(beta * x0) * hann_smoothing(beta, t.smoothing);
}

namespace {
constexpr double unknown = std::numeric_limits<double>::infinity();

Modes carried(const String& s, int modes) {
    return modes_of(s, std::clamp(modes, 1, modes_measured(s).value_or(most_modes)));
}

double at_start(const std::vector<double>& weights, const std::vector<double>& y) {
    return std::inner_product(weights.begin(), weights.end(), y.begin(), 0.0);
}

double stored(const Modes& modes, const std::vector<double>& y, const LumpedBarrier& b) {
    const double eta = b.sign() * b.height - at_start(contact_weights(modes, b), y);
    return eta > 0 ? b.stiffness.k * std::pow(eta, b.exponent + 1) / (b.exponent + 1) : 0;
}

double stored(const Modes& modes, const std::vector<double>& y, const ProfileBarrier& b) {
    constexpr int parts = 256;
    double energy = 0;
    for (const LumpedBarrier& part : lumped(b, parts)) energy += stored(modes, y, part);
    return energy;
}

// max |F| plus the integral of |F'|, over the largest force
double rise_and_fall(const Pluck& e) {
    if (e.time.empty()) return 2;
    double sum = 1 + std::abs(e.share.front()) + std::abs(e.share.back());
    for (std::size_t k = 1; k < e.share.size(); ++k) sum += std::abs(e.share[k] - e.share[k - 1]);
    return sum;
}

double available_energy(const String& s, const Modes& modes) {
    const ModalStart start = start_of(modes, s);
    const std::vector<double>& y = start.displacement;
    double energy = 0, stretch = 0;  // stretch: integral over y'^2 [m]
    for (int i = 0; i < modes.count(); ++i) {
        const double v = start.velocity[i], w = modes.omega0[i] * y[i];
        energy += 0.5 * modes.mass * (v * v + w * w);
        stretch += 0.5 * s.length * modes.beta[i] * modes.beta[i] * y[i] * y[i];
    }
    energy += s.axial_stiffness * stretch * stretch / (8 * s.length);
    for (const Barrier& barrier : s.barriers)
        energy += std::visit([&](const auto& b) { return stored(modes, y, b); }, barrier);
    for (const Mass& m : s.masses) {
        if (m.weight > 0) return unknown;
        energy += 0.5 * m.mass * m.velocity * m.velocity;
        energy += stored(modes, y, {m.position, m.width, -m.gap, {m.stiffness}, m.exponent});
    }
    if (const auto& t = s.thread) {
        const double lag = t->height - at_start(footprint_weights(modes, t->position, t->width), y);
        energy += 0.5 * t->stiffness * lag * lag;
    }
    if (const auto& p = s.pluck) {
        const double most = rise_and_fall(*p) * p->amplitude;
        energy += 0.5 * most * most *
                  static_compliance(modes, footprint_weights(modes, p->position, p->width));
    }
    return energy;
}

double bound_squared(const Tap& tap, const String& s, const Modes& modes, double energy) {
    if (tap.mass)
        return tap.quantity == Quantity::velocity ? 2 * energy / s.masses[*tap.mass].mass : unknown;
    switch (tap.quantity) {
        case Quantity::displacement:
            return 2 * energy * static_compliance(modes, displacement_weights(modes, tap.position));
        case Quantity::nut_force:
            return 2 * energy * static_compliance(modes, nut_force_weights(modes, s));
        case Quantity::velocity: {
            const std::vector<double> w = displacement_weights(modes, tap.position);
            return 2 * energy * at_start(w, w) / modes.mass;
        }
        default: return unknown;
    }
}
}  // namespace

double available_energy(const Scene& scene, int modes) {
    if (scene.body && !scene.body->modes.empty()) return unknown;
    double energy = 0;
    for (const String& s : scene.strings) energy += available_energy(s, carried(s, modes));
    return energy;
}

std::vector<double> tap_bounds(const Scene& scene, int modes) {
    std::vector<double> squared(scene.taps.size(), 0.0);
    const double energy = available_energy(scene, modes);
    for (int a = 0; a < static_cast<int>(scene.strings.size()); ++a) {
        const String& s = scene.strings[a];
        const Modes m = carried(s, modes);
        for (std::size_t k = 0; k < squared.size(); ++k)
            if (hears(scene.taps[k], scene, a))
                squared[k] += bound_squared(scene.taps[k], s, m, energy);
    }
    for (std::size_t k = 0; k < squared.size(); ++k)
        if (std::isfinite(scene.taps[k].below)) squared[k] = unknown;  // the whole tap has a bound
    for (double& b : squared) b = std::isfinite(b) && b > 0 ? std::sqrt(b) : unknown;
    return squared;
}

}  // namespace jvari

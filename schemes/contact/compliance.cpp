// Static deflection of the stiff string, averaged over footprints. Footprints apart from each other
// have a closed form: averaging exp(l x) over a cosine with width w about c gives exp(l c) pi^2
// cosh(l w/2)/(pi^2 + l^2 w^2). Overlapping footprints are integrated by Gauss's rule on panels
// that grow geometrically from every kink of the integrand and every boundary layer, whose width is
// 1/l.
#include "schemes/contact/compliance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "scenes/barrier.hpp"
#include "scenes/modes.hpp"
#include "schemes/decompositions.hpp"
#include "schemes/making.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

using std::numbers::pi;

namespace {
double decay_of(const String& s) {  // l [1/m]; 0 if the string has no bending stiffness
    return s.bending_stiffness > 0 ? std::sqrt(s.tension / s.bending_stiffness) : 0;
}

// The bending part of G times T: sinh(l x) sinh(l (L - z))/(l sinh(l L)), without overflow.
double bent(double l, double L, double x, double z) {
    if (l == 0) return 0;
    return std::exp(-l * (z - x)) * std::expm1(-2 * l * x) * std::expm1(-2 * l * (L - z)) /
           (-2 * l * std::expm1(-2 * l * L));
}

double green(const String& s, double a, double b) {
    const double x = std::min(a, b), z = std::max(a, b), L = s.length;
    return (x * (L - z) / L - bent(decay_of(s), L, x, z)) / s.tension;
}

constexpr std::array<double, 8> node = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                        0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                        0.9445750230732326, 0.9894009349916499};
constexpr std::array<double, 8> share = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                         0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                         0.0622535239386479, 0.0271524594117541};

// Averages f over a footprint; `breaks` are the places at which f is not smooth, `layer` the width
// of the steep regions beside them.
template <class F>
double averaged(const Footprint& p, double layer, std::vector<double> breaks, const F& f) {
    if (p.width == 0) return f(p.position);
    const double from = p.position - 0.5 * p.width, to = p.position + 0.5 * p.width;
    std::erase_if(breaks, [&](double x) { return !(x > from && x < to); });
    breaks.insert(breaks.end(), {from, to});
    std::sort(breaks.begin(), breaks.end());
    double sum = 0;
    const auto panel = [&](double a, double b) {
        for (int i = 0; i < 16; ++i) {
            const double x = 0.5 * (a + b) + 0.5 * (b - a) * (i < 8 ? node[i] : -node[i - 8]);
            sum += 0.5 * (b - a) * share[i % 8] * 0.5 * pi / p.width *
                   std::cos(pi * (x - p.position) / p.width) * f(x);
        }
    };
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {  // from both ends of a segment inwards
        double a = breaks[k], b = breaks[k + 1], size = layer > 0 ? layer : p.width;
        for (; a < b; size = std::min(2 * size, 0.25 * p.width)) {
            size = std::min(size, 0.25 * p.width);
            if (2 * size >= b - a || a + size == a) {
                panel(a, b);
                break;
            }
            panel(a, a + size);
            panel(b - size, b);
            a += size;
            b -= size;
        }
    }
    return sum;
}

double over_modes(const String& s, int count, const Reading& r, const Footprint& force) {
    const Modes modes = modes_of(s, count);
    const auto w = reading_weights(r, modes, s), g = footprint_weights(modes, force);
    double sum = 0;
    for (int i = count - 1; i >= 0; --i)
        sum += w[i] * g[i] / (modes.mass * modes.omega0[i] * modes.omega0[i]);
    return sum;
}

const TableDamping* measured(const String& s) { return std::get_if<TableDamping>(&s.damping); }
}  // namespace

std::vector<double> footprint_weights(const Modes& modes, const Footprint& f) {
    return footprint_weights(modes, f.position, f.width, f.sign);
}

std::vector<double> reading_weights(const Reading& r, const Modes& modes, const String& s) {
    return weights_below(
        r.below, r.nut_force ? nut_force_weights(modes, s) : footprint_weights(modes, r.at), modes);
}

double static_deflection(const String& s, const Footprint& p, const Footprint& q) {
    if (const auto* table = measured(s))
        return over_modes(s, static_cast<int>(table->frequency_hz.size()), {p}, q);
    const double l = decay_of(s), L = s.length, layer = l > 0 ? 1 / l : 0;
    // a bar: the sum falls like 1/i^4, and G cancels
    if (s.bending_stiffness > 0 && l * L < 1) return over_modes(s, 20000, {p}, q);
    const double apart = std::abs(p.position - q.position) - 0.5 * (p.width + q.width),
                 widest = std::max(p.width, q.width);
    if (apart >= 0 && l * widest < 300) {
        const auto window = [&](double w) {
            return pi * pi * std::cosh(0.5 * l * w) / (pi * pi + l * l * w * w);
        };
        const double x = std::min(p.position, q.position), z = std::max(p.position, q.position);
        return p.sign * q.sign *
               (x * (L - z) / L - window(p.width) * window(q.width) * bent(l, L, x, z)) / s.tension;
    }
    const Footprint &inner = p.width < q.width ? q : p, &outer = p.width < q.width ? p : q;
    return p.sign * q.sign *
           averaged(outer, layer,
                    {inner.position - 0.5 * inner.width, inner.position + 0.5 * inner.width},
                    [&](double x) {
                        return averaged(inner, layer, {x},
                                        [&](double z) { return green(s, x, z); });
                    });
}

double static_nut_force(const String& s, const Footprint& force) {
    if (const auto* table = measured(s))
        return over_modes(s, static_cast<int>(table->frequency_hz.size()), {{}, true}, force);
    return force.sign * force.position / s.length;  // balance of moments about the other end
}

namespace {
// multiple of the kept modes; the modes beyond add 1/500 to E, and enter C by its closed form
constexpr int further_modes = 8;

// Response of the cut modes to a force on a point, or on a pattern of points.
struct Answer {
    const Modes& modes;
    int kept;
    std::vector<double> g;
    // response to a steady force, including the modes that are not summed, whose share falls like
    // 1/omega^2 [m/N]
    double C;

    double square(int i) const { return modes.omega0[i] * modes.omega0[i]; }
    double yield(int i) const { return g[i] * g[i] / (modes.mass * square(i)); }
    double last() const { return modes.omega0[kept - 1]; }
    // C - H at a real frequency s, for the summed modes; the other modes add a part that falls like
    // 1/i^3
    double slower(double s) const {
        double sum = 0;
        for (int i = modes.count() - 1; i >= kept; --i)
            sum += yield(i) * s * s / (square(i) + s * s);
        return sum;
    }
    double inertia(double nyquist) const {  // E for the modes below nyquist
        double sum = 0;
        for (int i = modes.count() - 1; i >= kept; --i)
            if (modes.omega0[i] < nyquist) sum += yield(i) / square(i);
        return sum;
    }

    // Finds R in C^-1 D + R (D' - v), E/C^2 v' = R (D' - v). Its admittance equals the cut modes'
    // admittance at one real frequency; the result is the least R over all frequencies. There both
    // curves touch. On an ideal string that frequency is infinite, and R is the wave resistance.
    // With stiffness and footprints R is larger, and hardly changes near three times the last kept
    // mode's frequency. `none`: value for a single cut mode, which has no resistance.
    double touching_resistance(double none) const {
        const double mass = inertia(HUGE_VAL) / (C * C);
        double beyond = C, least = std::numeric_limits<double>::infinity();
        for (int i = modes.count() - 1; i >= kept; --i) beyond -= yield(i);
        for (double s = last(); s < further_modes * last(); s *= 1.1) {
            const double x_end = s / modes.omega0.back(),
                         lag = beyond * (1 - std::atan(x_end) / x_end) + slower(s);
            const double x = mass * s * C * (C - lag) * s / lag - 1;  // M s^2/(1/H - 1/C) - 1
            if (lag < C && x > 1e-6) least = std::min(least, mass * s / x);
        }
        return std::isfinite(least) ? least : none;
    }

    // Mass that represents the inertia of the cut modes, (1/C - 1/H(i omega))/omega^2 at the kept
    // modes' frequencies. Each frequency has the weight g^2/omega, in proportion to its motion
    // after a blow. Only the share from modes below `nyquist` counts.
    double mass(double nyquist) const {
        double sum = 0, weights = 0;
        const int every = 1 + kept / 128;
        for (int k = kept - 1 - every / 2; k >= 0; k -= every) {
            double more = 0;  // (H - C)/omega^2
            for (int i = modes.count() - 1; i >= kept; --i)
                more += yield(i) / (square(i) - square(k));
            const double weight = g[k] * g[k] / modes.omega0[k];
            sum += weight * more / (C * (C + more * square(k)));
            weights += weight;
        }
        return weights > 0 ? sum / weights * inertia(nyquist) / inertia(HUGE_VAL) : 0;
    }
};
}  // namespace

double radiation_resistance(const String& s, const Footprint& at, int kept) {
    const double none = std::sqrt(s.tension * s.linear_density);
    const CutModes cut = cut_modes(s, {&at, 1}, kept, HUGE_VAL);
    if (cut.C.empty()) return none;
    const Answer answer{cut.modes, kept, cut.g.front(), cut.C.front()};
    const double frequency = answer.last() / 3, slower = answer.slower(frequency);
    return answer.C > slower && slower > 0 ? slower / (answer.C * (answer.C - slower) * frequency)
                                           : none;
}

CutModes cut_modes(const String& s, std::span<const Footprint> points, int kept, double nyquist) {
    const auto* table = measured(s);
    const int all = table ? static_cast<int>(table->frequency_hz.size()) : further_modes * kept;
    if (all <= kept) return {};
    CutModes cut;
    const Modes& modes = cut.modes = modes_of(s, all);
    const std::size_t n = points.size();
    for (const Footprint& p : points) cut.g.push_back(footprint_weights(modes, p));
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) {
            // below half the sample rate
            double C = table ? 0 : static_deflection(s, points[a], points[b]), E = 0, below = 0;
            for (int i = all - 1; i >= 0; --i) {
                const double square = modes.omega0[i] * modes.omega0[i],
                             own = cut.g[a][i] * cut.g[b][i] / (modes.mass * square);
                if (i < kept) C -= table ? 0 : own;
                else {
                    if (table) C += own;
                    if (modes.omega0[i] < nyquist) below += own, E += own / square;
                }
            }
            // Beyond `all`, the modes above half the rate contribute to C in proportion to 1/omega.
            const double part = table ? 1 : std::min(1.0, modes.omega0[all - 1] / nyquist);
            cut.C.push_back(C), cut.E.push_back(E), cut.folded.push_back((C - below) * part);
        }
    return cut;
}

Sites sites_of(const Scene& scene, std::span<const Footprint> contacts) {
    const String& s = scene.strings.front();
    Sites all;
    all.forces.assign(contacts.begin(), contacts.end());
    all.contacts = static_cast<int>(contacts.size());
    if (s.thread) all.forces.push_back({s.thread->position, s.thread->width});
    all.thread = s.thread.has_value();
    for (const Footprint& f : all.forces) all.readings.push_back({f});
    if (s.pluck) all.forces.push_back({s.pluck->position, s.pluck->width});
    all.pluck = s.pluck.has_value();
    for (std::size_t k = 0; k < scene.taps.size(); ++k) {
        const Tap& tap = scene.taps[k];
        const bool nut = tap.quantity == Quantity::nut_force;
        if (tap.mass || (!nut && tap.quantity != Quantity::displacement)) continue;
        all.readings.push_back({{tap.position, 0}, nut, tap.below});
        all.tap.push_back(k);
    }
    return all;
}

std::vector<Footprint> footprints_of(const String& s) {
    std::vector<Footprint> all;
    for (const Barrier& barrier : s.barriers)
        if (const auto* b = std::get_if<LumpedBarrier>(&barrier))
            all.push_back({b->position, b->width, b->sign()});
    for (const Mass& m : s.masses) all.push_back({m.position, m.width});
    return all;
}

Sites sites_of(const Scene& scene) { return sites_of(scene, footprints_of(scene.strings.front())); }

namespace {
[[noreturn]] void refuse_soft(const std::string& who, const std::string& where, double excess) {
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%.2g", excess * 1e6);
    throw Refusal(who + ": at the " + where + " its own string yields more than the true one, by " +
                  text.data() +
                  " um/N: there is nothing to add. compliance=own can run, another rate or number "
                  "of modes may");
}
void refuse_soft(const std::string& who, double bb, double bc, double cc) {
    if (!(bb >= 0)) refuse_soft(who, "barrier", -bb);
    if (!(cc >= 0)) refuse_soft(who, "thread", -cc);
    if (!(bb * cc >= bc * bc))
        refuse_soft(who, "barrier and the thread together", bc * bc / cc - bb);
}

// The ladder mass represents modes above the last kept one. If the step takes far more compliance
// from a point than the cut modes do, mass and spring would swing below that mode. No part of the
// string has a resonance at such a frequency there.
void refuse_swinging(const std::string& who, const MissingMatrix& m, const CutModes& cut,
                     int kept) {
    const int n = m.points();
    for (int p = 0; p < n && !cut.C.empty(); ++p) {
        const int at = p * n + p;
        const double last = cut.modes.omega0[kept - 1],
                     swings = std::abs(cut.C[at]) / std::sqrt(cut.E[at] * m.C[at]);
        if (swings < last)
            throw Refusal(
                who + ": at the " + (p < m.contacts ? "barrier" : "thread") +
                " nearly all that the string lacks is due to the step, not to modes that are cut "
                "off; what stands for those would swing at " +
                std::to_string(std::lround(swings / (2 * pi))) + " Hz, below the highest mode, " +
                std::to_string(std::lround(last / (2 * pi))) +
                " Hz. compliance=own can run, another rate or number of modes may");
    }
}

// Power of the part above rounding in a symmetric, positive matrix
std::vector<double> power_of(const std::vector<double>& m, int n, double power) {
    const SymmetricParts parts = symmetric_parts(m, n);
    std::vector<double> scaled(m.size());  // vectors in columns
    for (int k = 0; k < n; ++k) {
        if (!(parts.value[k] > 1e-9 * parts.value[n - 1])) continue;
        const double value = std::pow(parts.value[k], power);
        for (int a = 0; a < n; ++a) scaled[a * n + k] = parts.vector[k * n + a] * value;
    }
    return product_of(scaled, parts.vector, n);
}

// The patterns diagonalise both C and E of the cut modes. Modes above half the sample rate fold
// down to any frequency: sampled, they are a spring with a damper of dt/2 over their compliance,
// without inertia. In a step with constant velocity a mass takes up the exact share, 1 - exp(-R
// dt/M). dt 0: in continuous time.
Ladder ladder_of(const String& s, const std::vector<double>& C, const CutModes& cut, int n,
                 int kept, double dt) {
    Ladder l;
    for (auto* v : {&l.mass, &l.resistance}) v->assign(n, 0.0);
    for (auto* m : {&l.damper, &l.V}) m->assign(static_cast<std::size_t>(n) * n, 0.0);
    const double Z = std::sqrt(s.tension * s.linear_density);
    if (cut.C.empty()) {
        for (int a = 0; a < n; ++a) l.damper[a * n + a] = Z;
        return l;
    }
    const auto stiff = power_of(C, n, -1), white = power_of(cut.C, n, -0.5);
    auto damped = product_of(stiff, cut.folded, n);
    for (double& d : damped) d *= 0.5 * dt;
    l.damper = product_of(damped, stiff, n);
    const SymmetricParts parts =
        symmetric_parts(product_of(product_of(white, cut.E, n), white, n), n);
    const std::vector<double> V = product_of(parts.vector, white, n);
    for (int k = 0; k < n; ++k) {
        // a point alone moves with its mass
        const std::span<const double> moves(V.data() + k * n, n);
        const double square = std::inner_product(moves.begin(), moves.end(), moves.begin(), 0.0),
                     length = std::copysign(std::sqrt(square), moves[0]);
        if (!(length != 0 && parts.value[k] > 0)) continue;
        std::vector<double> g(cut.modes.count());
        for (int a = 0; a < n; ++a) {
            const double moved = l.V[k * n + a] = moves[a] / length;
            for (std::size_t i = 0; i < g.size(); ++i) g[i] += moved * cut.g[a][i];
        }
        const Answer answer{cut.modes, kept, std::move(g), 1 / (length * length)};
        const double mass = l.mass[k] =
                         answer.mass(dt > 0 ? pi / dt : std::numeric_limits<double>::infinity()),
                     resistance = mass > 0 ? answer.touching_resistance(2 * Z) : 2 * Z;
        if (dt == 0) l.resistance[k] = resistance;
        else if (mass > 0)
            l.resistance[k] = 2 * mass / dt * std::tanh(0.5 * dt * resistance / mass);
    }
    return l;
}

MissingMatrix difference(const String& s, const Sites& sites, std::size_t taps,
                         const OwnResponse& own) {
    MissingMatrix m;
    const int forces = static_cast<int>(sites.forces.size()), points = sites.points();
    m.contacts = sites.contacts;
    m.thread = sites.thread;
    m.taps.resize(taps);
    for (int r = 0; r < static_cast<int>(sites.readings.size()); ++r)
        for (int f = 0; f < forces; ++f) {
            const Reading& reading = sites.readings[r];
            const double truth =
                std::isfinite(reading.below)
                    ? over_modes(s, modes_below(s, reading.below), reading, sites.forces[f])
                : reading.nut_force ? static_nut_force(s, sites.forces[f])
                                    : static_deflection(s, reading.at, sites.forces[f]);
            const double missing = truth - own(r, f);
            if (r >= points) m.taps[sites.tap[r - points]].push_back(missing);
            else (f < points ? m.C : m.pluck).push_back(missing);
        }
    return m;
}
}  // namespace

MissingMatrix missing_matrix(const std::string& who, const String& s, const Sites& sites,
                             std::size_t taps, int kept, std::optional<double> step,
                             const OwnResponse& own) {
    MissingMatrix m = difference(s, sites, taps, own);
    const int n = sites.points();
    const auto put_ladder = [&] {
        if (!step || n == 0) return;
        const double nyquist = *step > 0 ? pi / *step : std::numeric_limits<double>::infinity();
        const CutModes cut = cut_modes(s, std::span(sites.forces).first(n), kept, nyquist);
        refuse_swinging(who, m, cut, kept);
        m.ladder = ladder_of(s, m.C, cut, n, kept, *step);
    };
    if (n <= 1 + (m.thread ? 1 : 0)) {
        refuse_soft(who, m.contacts > 0 ? m.C.front() : 0, n == 2 ? m.C[1] : 0,
                    m.thread ? m.C.back() : 0);
        put_ladder();
        return m;
    }
    std::vector<double> symmetric(m.C);
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) symmetric[a * n + b] = 0.5 * (m.C[a * n + b] + m.C[b * n + a]);
    const SymmetricParts parts = symmetric_parts(symmetric, n);
    m.excess = std::max(0.0, -parts.value[0]);
    if (m.excess > parts.value[n - 1]) refuse_soft(who, "contacts", m.excess);
    for (int a = 0; a < n; ++a)
        for (int b = 0; b <= a; ++b) {
            double sum = 0;
            for (int k = 0; k < n; ++k)
                sum += parts.vector[k * n + a] * std::max(parts.value[k], 0.0) *
                       parts.vector[k * n + b];
            m.C[a * n + b] = m.C[b * n + a] = sum;  // symmetric to the last bit
        }
    put_ladder();
    return m;
}

bool matched_without_loss(const Descriptor& descriptor, const Scene& scene,
                          const Settings& settings) {
    if (choice_option(settings, compliance_option) != "matched") return false;
    const Features needed = needed_by(scene);
    for (const auto& [feature, name] : {std::pair(Feature::contact_loss, "contact loss"),
                                        std::pair(Feature::moving_body, "a moving body")})
        if (needed.has(feature))
            throw Refusal(std::string(descriptor.name) + ": compliance=matched leaves out " + name);
    return true;
}

String with_profile_points(String s, const Settings& settings) {
    const double count = number_option(settings, profile_points_option);
    if (!(count >= 1 && count <= most_profile_points) || count != std::floor(count))
        throw Refusal("option points: found " + std::to_string(count) +
                      ", expected a whole number from 1 to " + std::to_string(most_profile_points));
    s.barriers = without_profiles(
        s, [=](const ProfileBarrier& b) { return lumped(b, static_cast<int>(count)); });
    return s;
}

}  // namespace jvari

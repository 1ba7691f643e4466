// Static deflection of the stiff string, averaged over footprints. Footprints apart from each other have a closed form: the average of
// exp(l x) over a cosine of width w about c is exp(l c) pi^2 cosh(l w/2)/(pi^2 + l^2 w^2). Overlapping ones are integrated by Gauss's rule
// on panels that grow geometrically from every place where the integrand has a kink or a boundary layer of width 1/l.
#include "schemes/contact/compliance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/barrier.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/scheme.hpp"
#include "schemes/symmetric.hpp"

namespace jvari {

using std::numbers::pi;

namespace {
double decay_of(const String& s) {  // l [1/m]; 0 where the string has no bending stiffness
    return s.bending_stiffness > 0 ? std::sqrt(s.tension / s.bending_stiffness) : 0;
}

// The bending part of G times T: sinh(l x) sinh(l (L - z))/(l sinh(l L)), without overflow.
double bent(double l, double L, double x, double z) {
    if (l == 0) return 0;
    return std::exp(-l * (z - x)) * std::expm1(-2 * l * x) * std::expm1(-2 * l * (L - z)) / (-2 * l * std::expm1(-2 * l * L));
}

double green(const String& s, double a, double b) {
    const double x = std::min(a, b), z = std::max(a, b), L = s.length;
    return (x * (L - z) / L - bent(decay_of(s), L, x, z)) / s.tension;
}

constexpr std::array<double, 8> node = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274, 0.6178762444026438,
                                        0.7554044083550030, 0.8656312023878318, 0.9445750230732326, 0.9894009349916499};
constexpr std::array<double, 8> share = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025, 0.1495959888165767,
                                         0.1246289712555339, 0.0951585116824928, 0.0622535239386479, 0.0271524594117541};

// The average of f over a footprint; `breaks` are the places where f is not smooth, `layer` the width of what is steep beside them.
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
            sum += 0.5 * (b - a) * share[i % 8] * 0.5 * pi / p.width * std::cos(pi * (x - p.position) / p.width) * f(x);
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
    const auto w = r.nut_force ? nut_force_weights(modes, s) : footprint_weights(modes, r.at.position, r.at.width);
    const auto g = footprint_weights(modes, force.position, force.width);
    double sum = 0;
    for (int i = count - 1; i >= 0; --i) sum += w[i] * g[i] / (modes.mass * modes.omega0[i] * modes.omega0[i]);
    return sum;
}

const TableDamping* measured(const String& s) {
    return std::get_if<TableDamping>(&s.damping);
}
}  // namespace

double static_deflection(const String& s, const Footprint& p, const Footprint& q) {
    if (const auto* table = measured(s)) return over_modes(s, static_cast<int>(table->frequency_hz.size()), {p}, q);
    const double l = decay_of(s), L = s.length, layer = l > 0 ? 1 / l : 0;
    if (s.bending_stiffness > 0 && l * L < 1) return over_modes(s, 20000, {p}, q);  // a bar: the sum falls as 1/i^4, and G cancels
    const double apart = std::abs(p.position - q.position) - 0.5 * (p.width + q.width), widest = std::max(p.width, q.width);
    if (apart >= 0 && l * widest < 300) {
        const auto window = [&](double w) { return pi * pi * std::cosh(0.5 * l * w) / (pi * pi + l * l * w * w); };
        const double x = std::min(p.position, q.position), z = std::max(p.position, q.position);
        return (x * (L - z) / L - window(p.width) * window(q.width) * bent(l, L, x, z)) / s.tension;
    }
    const Footprint &inner = p.width < q.width ? q : p, &outer = p.width < q.width ? p : q;
    return averaged(outer, layer, {inner.position - 0.5 * inner.width, inner.position + 0.5 * inner.width},
                    [&](double x) { return averaged(inner, layer, {x}, [&](double z) { return green(s, x, z); }); });
}

double static_nut_force(const String& s, const Footprint& force) {
    if (const auto* table = measured(s)) return over_modes(s, static_cast<int>(table->frequency_hz.size()), {{}, true}, force);
    return force.position / s.length;  // the balance of moments about the other end
}

double radiation_resistance(const String& s, const Footprint& at, int kept) {
    constexpr int further = 8;  // times as many modes: what they add to C_cut - H falls as 1/i^3
    const auto* table = measured(s);
    const int all = table ? static_cast<int>(table->frequency_hz.size()) : further * kept;
    const double none = std::sqrt(s.tension * s.linear_density);
    if (all <= kept) return none;
    const Modes modes = modes_of(s, all);
    const auto g = footprint_weights(modes, at.position, at.width);
    const double frequency = modes.omega0[kept - 1] / 3;
    double yield = table ? 0 : static_deflection(s, at, at), slower = 0;  // C_cut, and C_cut - H
    for (int i = 0; i < all; ++i) {
        const double square = modes.omega0[i] * modes.omega0[i], own = g[i] * g[i] / (modes.mass * square);
        if (i < kept) yield -= table ? 0 : own;
        else if (table) yield += own;
        if (i >= kept) slower += own * frequency * frequency / (square + frequency * frequency);
    }
    return yield > slower && slower > 0 ? slower / (yield * (yield - slower) * frequency) : none;
}

namespace {
constexpr int further_modes = 8;  // times as many as are kept: what is beyond adds 1/500 to E, and to C from its closed form

// R of C^-1 D + R (D' - v), mass v' = R (D' - v), where its admittance is that of the cut modes at one real frequency: the least over all.
// There both touch. On an ideal string that is at infinity, and R the wave resistance. With stiffness and footprints R is larger, and
// hardly changes near three times the frequency of the last mode kept. `none`: of a single cut mode, which has no resistance.
double touching_resistance(const Modes& modes, int kept, const std::vector<double>& g, double C, double E, double none) {
    const double mass = E / (C * C), last = modes.omega0[kept - 1];
    double least = std::numeric_limits<double>::infinity();
    double beyond = C;  // of the modes that are not summed, whose share in C falls as 1/omega^2
    for (int i = modes.count() - 1; i >= kept; --i) beyond -= g[i] * g[i] / (modes.mass * modes.omega0[i] * modes.omega0[i]);
    for (double s = last; s < further_modes * last; s *= 1.1) {
        const double x_end = s / modes.omega0.back();
        double slower = beyond * (1 - std::atan(x_end) / x_end);  // C - H
        for (int i = modes.count() - 1; i >= kept; --i) {
            const double square = modes.omega0[i] * modes.omega0[i];
            slower += g[i] * g[i] / (modes.mass * square) * s * s / (square + s * s);
        }
        const double x = mass * s * C * (C - slower) * s / slower - 1;  // M s^2/(1/H - 1/C) - 1
        if (slower < C && x > 1e-6) least = std::min(least, mass * s / x);
    }
    return std::isfinite(least) ? least : none;
}
}  // namespace

CutModes cut_modes(const String& s, std::span<const Footprint> points, int kept, double nyquist) {
    const auto* table = measured(s);
    const int all = table ? static_cast<int>(table->frequency_hz.size()) : further_modes * kept;
    if (all <= kept) return {};
    const Modes modes = modes_of(s, all);
    const std::size_t n = points.size();
    std::vector<std::vector<double>> g;
    for (const Footprint& p : points) g.push_back(footprint_weights(modes, p.position, p.width));
    CutModes cut;
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) {
            double C = table ? 0 : static_deflection(s, points[a], points[b]), E = 0, below = 0;  // below half the sample rate
            for (int i = all - 1; i >= 0; --i) {
                const double square = modes.omega0[i] * modes.omega0[i], own = g[a][i] * g[b][i] / (modes.mass * square);
                if (i < kept) C -= table ? 0 : own;
                else {
                    if (table) C += own;
                    E += own / square;
                    if (modes.omega0[i] < nyquist) below += own;
                }
            }
            // Of the modes beyond `all` those above the half rate have C as 1/omega.
            const double part = table ? 1 : std::min(1.0, modes.omega0[all - 1] / nyquist);
            cut.C.push_back(C), cut.E.push_back(E), cut.folded.push_back((C - below) * part);
        }
    for (std::size_t a = 0; a < n; ++a)
        cut.resistance.push_back(
            touching_resistance(modes, kept, g[a], cut.C[a * n + a], cut.E[a * n + a], 2 * std::sqrt(s.tension * s.linear_density)));
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
        if (!nut && tap.quantity != Quantity::displacement) continue;
        all.readings.push_back({{tap.position, 0}, nut});
        all.tap.push_back(k);
    }
    return all;
}

std::vector<Footprint> footprints_of(const String& s) {
    std::vector<Footprint> all;
    for (const Barrier& barrier : s.barriers)
        if (const auto* b = std::get_if<LumpedBarrier>(&barrier)) all.push_back({b->position, b->width});
    return all;
}

Sites sites_of(const Scene& scene) {
    return sites_of(scene, footprints_of(scene.strings.front()));
}

namespace {
[[noreturn]] void refuse_soft(const std::string& who, const std::string& where, double excess) {
    throw Refusal(who + ": at the " + where + " its own string yields more than the true one, by " + std::to_string(excess * 1e6) +
                  " um/N, so nothing can stand in series there; compliance=own always can run, another rate or number of modes may");
}
void refuse_soft(const std::string& who, double bb, double bc, double cc) {
    if (!(bb >= 0)) refuse_soft(who, "barrier", -bb);
    if (!(cc >= 0)) refuse_soft(who, "thread", -cc);
    if (!(bb * cc >= bc * bc)) refuse_soft(who, "barrier and the thread together", bc * bc / cc - bb);
}

// Of all points pressed alike: each has the row sums of C and E, so that neighbours share a mass and a damper. Modes above half the sample
// rate fold down to any frequency: sampled, they are a spring with a damper of dt/2 over their compliance. No mass follows its point faster
// than in a step, and in a step of constant velocity by what is exact, 1 - exp(-x).
std::vector<Ladder> ladders(const String& s, const std::vector<double>& C, const CutModes& cut, std::size_t n, double dt) {
    std::vector<Ladder> all(n);
    for (std::size_t a = 0; a < n; ++a) {
        if (cut.C.empty()) {
            all[a].damper = std::sqrt(s.tension * s.linear_density);
            continue;
        }
        const auto row = [&](const std::vector<double>& m) {
            double sum = 0;
            for (std::size_t b = 0; b < n; ++b) sum += std::abs(m[a * n + b]);
            return sum;
        };
        const double yields = row(C), yields_cut = row(cut.C);
        if (!(yields > 0 && yields_cut > 0)) continue;
        all[a].damper = 0.5 * dt * row(cut.folded) / (yields * yields);
        all[a].mass = row(cut.E) / (yields_cut * yields_cut);
        const double follows = dt > 0 ? std::min(cut.resistance[a] * dt / all[a].mass, 1.0) : 0;  // x
        all[a].resistance = dt > 0 ? 2 * all[a].mass / dt * std::tanh(0.5 * follows) : cut.resistance[a];
    }
    return all;
}

MissingMatrix difference(const String& s, const Sites& sites, std::size_t taps, const OwnResponse& own) {
    MissingMatrix m;
    const int forces = static_cast<int>(sites.forces.size()), points = sites.points();
    m.contacts = sites.contacts;
    m.thread = sites.thread;
    m.taps.resize(taps);
    for (int r = 0; r < static_cast<int>(sites.readings.size()); ++r)
        for (int f = 0; f < forces; ++f) {
            const Reading& reading = sites.readings[r];
            const double truth =
                reading.nut_force ? static_nut_force(s, sites.forces[f]) : static_deflection(s, reading.at, sites.forces[f]);
            const double missing = truth - own(r, f);
            if (r >= points) m.taps[sites.tap[r - points]].push_back(missing);
            else (f < points ? m.C : m.pluck).push_back(missing);
        }
    return m;
}
}  // namespace

MissingMatrix missing_matrix(const std::string& who, const String& s, const Sites& sites, std::size_t taps, int kept, double dt,
                             const OwnResponse& own) {
    MissingMatrix m = difference(s, sites, taps, own);
    const int n = sites.points();
    const CutModes cut = cut_modes(s, std::span(sites.forces).first(n), kept, dt > 0 ? std::numbers::pi / dt : HUGE_VAL);
    if (n <= 1 + (m.thread ? 1 : 0)) {
        m.ladder = ladders(s, m.C, cut, n, dt);
        refuse_soft(who, m.contacts > 0 ? m.C.front() : 0, n == 2 ? m.C[1] : 0, m.thread ? m.C.back() : 0);
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
            for (int k = 0; k < n; ++k) sum += parts.vector[k * n + a] * std::max(parts.value[k], 0.0) * parts.vector[k * n + b];
            m.C[a * n + b] = m.C[b * n + a] = sum;  // symmetric to the last bit
        }
    m.ladder = ladders(s, m.C, cut, n, dt);
    return m;
}

bool matched_without_loss(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    if (choice_option(settings, compliance_option) != "matched") return false;
    const Features needed = needed_by(scene);
    for (const auto& [feature, name] : {std::pair(Feature::contact_loss, "contact loss"), std::pair(Feature::moving_body, "a moving body")})
        if (needed.has(feature)) throw Refusal(std::string(descriptor.name) + ": compliance=matched leaves out " + name);
    return true;
}

String with_profile_points(String s, const Settings& settings) {
    const double count = number_option(settings, profile_points_option);
    if (!(count >= 1 && count <= most_profile_points) || count != std::floor(count))
        throw Refusal("option points: found " + std::to_string(count) + ", expected a whole number from 1 to " +
                      std::to_string(most_profile_points));
    std::vector<Barrier> barriers;
    for (const Barrier& barrier : s.barriers) {
        const auto* b = std::get_if<ProfileBarrier>(&barrier);
        if (!b) {
            barriers.push_back(barrier);
            continue;
        }
        for (const LumpedBarrier& point : lumped(*b, middles(*b, static_cast<int>(count)), (b->to - b->from) / count))
            barriers.push_back(point);
    }
    s.barriers = std::move(barriers);
    return s;
}

}  // namespace jvari

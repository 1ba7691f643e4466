// Two changes that preserve a scene's motion: other units, and a later beginning.
//
// Units of mass, length and time: every tap and every energy changes only by the factor for its
// unit. The schema for scene files has the unit of each number, so new keys are scaled too. Factors
// are powers of two, which cause no rounding; power laws do round. Stiff parts in the library
// become soft and soft parts stiff, which exposes schemes that compare with a fixed length, time or
// force.
//
// A later beginning: a string at rest that is plucked after a second moves like a string plucked at
// once. This exposes effects from a long run without needing a reference.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "bench/check/promise.hpp"
#include "scenes/schema.hpp"

namespace jvari::bench::check {

namespace {
// Relative to the largest value of a tap; a reference has its own tolerance.
constexpr double stepped_alike = 1e-7, continuous_alike = 1e-4;

struct Units {  // new units in one old unit
    double kilogram, metre, second;
    double newton() const { return kilogram * metre / (second * second); }
    double of(char symbol) const {
        switch (symbol) {
            case 'k': return kilogram;
            case 'm': return metre;
            case 's': return second;
            case 'N': return newton();
            default: return 1;  // 1, rad
        }
    }
};
// N/m becomes 2^28 times softer, or equally stiffer.
constexpr Units others[] = {{0x1p-20, 0x1p6, 0x1p4}, {0x1p20, 0x1p-6, 0x1p-4}};

// Conversion factor for a unit, for example "N/m^(exponent+1)" or "kg/(m s)".
double factor_of(std::string_view unit, const Units& in, double exponent) {
    double all = 1;
    for (bool over = false; !unit.empty();) {
        const std::size_t end = std::min(unit.find_first_of(" /^()"), unit.size());
        double one = in.of(end > 0 ? unit.front() : '1');
        over = over || (end == 0 && unit.front() == '/');
        unit.remove_prefix(std::max<std::size_t>(end, 1));
        if (!unit.empty() && unit.front() == '^') {
            const bool more = unit.starts_with("^(exponent+1)"), law = more || unit[1] == 'e';
            one = std::pow(one, law ? exponent + (more ? 1 : 0) : unit[1] - '0');
            unit.remove_prefix(more ? 13 : law ? 9 : 2);
        }
        all *= over ? 1 / one : one;
    }
    return all;
}

struct Rescale : Pass<Rescale> {
    const Units& in;
    double exponent = 1;  // exponent of the current contact

    explicit Rescale(const Units& units) : in(units) {}
    double factor(std::string_view unit) const { return factor_of(unit, in, exponent); }
    void number(const char*, double& x, const Range&, std::string_view unit, auto&&...) {
        const bool moves = path.ends_with("velocity");
        x *= factor(unit == "m or m/s" ? (moves ? "m/s" : "m") : unit);
    }
    void stiffness(const char*, double& k, const char* unit) {
        if (k != rigid) k *= factor(unit);
    }
    void tension(String& s) { s.tension *= in.newton(); }
    void column(std::string_view name, std::vector<double>& values) {
        const double by = factor(name.ends_with("_m") ? "m" : "1/s");  // else _hz or _per_s
        for (double& x : values) x *= by;
    }
    void columns(const char*, const std::string&, const Column& first, std::vector<double>& a,
                 const Column& second, std::vector<double>& b) {
        column(first.name, a);
        column(second.name, b);
    }
    void start_table(TableStart& t) {
        for (double& x : t.at) x *= t.of_modes ? 1 : in.metre;
        for (double& y : t.displacement) y *= in.metre;
        for (double& v : t.velocity) v *= in.metre / in.second;
    }
    void force(const char*, Pluck& p) {
        if (p.file.empty()) return;
        for (double& t : p.time) t *= in.second;
        p.start *= in.second, p.duration *= in.second, p.peak *= in.newton();
    }
    void one_of(const char*, auto& variant, auto&&...) {
        std::visit([this](auto& alternative) { this->enter(alternative); }, variant);
    }
    void enter(auto& part) {
        if constexpr (requires { part.exponent; }) exponent = part.exponent;
        fields(*this, part);
    }
    template <class Part>
    void part(const char* key, Part& p) {
        if constexpr (requires { p.exponent; }) exponent = p.exponent;
        Pass<Rescale>::part(key, p);
    }
    void parts(const char* key, auto& all) {
        for (std::size_t i = 0; i < all.size(); ++i)
            part((key + ("." + std::to_string(i))).c_str(), all[i]);
    }
};

Case rescaled(Case c, const Units& units) {
    Rescale pass(units);
    fields(pass, c.scene);
    c.settings.sample_rate /= units.second;
    c.settings.tap_rate /= units.second;
    return c;
}

double factor_of(Quantity q, const Units& in) {
    return q == Quantity::displacement ? in.metre
           : q == Quantity::velocity   ? in.metre / in.second
                                       : in.newton();
}

double largest(std::span<const double> x) {
    double most = 0;
    for (const double one : x) most = std::max(most, std::abs(one));
    return most;
}
// Largest value among all taps with this unit: a tap not yet reached by the motion contains only
// rounding errors.
double scale_of(const Trace& t, const Scene& scene, Quantity q) {
    double most = 0;
    for (int k = 0; k < t.taps(); ++k)
        if (unit_of(scene.taps[static_cast<std::size_t>(k)].quantity) ==
            std::string_view(unit_of(q)))
            most = std::max(most, largest(t.column(k)));
    return most;
}

// Describes the first row in which b is not `factor` times a; "" if there is none.
std::string first_apart(std::span<const double> a, std::span<const double> b, double factor,
                        double allowed) {
    for (std::size_t n = 0; n < a.size(); ++n)
        if (!(std::abs(b[n] / factor - a[n]) <= allowed))
            return fmt::format("is {:.6g} in row {} in place of {:.6g}", b[n], n, factor * a[n]);
    return "";
}
}  // namespace

Verdict is_one_motion_in_all_units(const Case& c) {
    // Approximations may use a fixed range of frequencies, for example losses on a grid. Nodes on a
    // profile have no unit.
    if ((needed_by(c.scene) - any_profile).any(approximated(c.scheme)))
        return not_asked("it approximates the scene");
    const bool energy = c.scheme.balance != Balance::none;
    const double allowed = c.scheme.clock == Clock::stepped ? stepped_alike : continuous_alike;
    const Trace own = fresh(c, {.energy = energy}).trace;
    for (const Units& units : others) {
        const Trace other = fresh(rescaled(c, units), {.energy = energy}).trace;
        const std::string where =
            fmt::format("with {:g} kg, {:g} m and {:g} s for units", 1 / units.kilogram,
                        1 / units.metre, 1 / units.second);
        if (other.rows != own.rows)
            return broken(fmt::format("{}: {} rows in place of {}", where, other.rows, own.rows));
        for (int k = 0; k < own.taps(); ++k) {
            const Quantity q = c.scene.taps[static_cast<std::size_t>(k)].quantity;
            if (const auto fault = first_apart(own.column(k), other.column(k), factor_of(q, units),
                                               allowed * scale_of(own, c.scene, q));
                !fault.empty())
                return broken(fmt::format("{}: tap {} {}", where, own.names[k], fault));
        }
        for (int k = 0; energy && k < 3; ++k)
            if (const auto fault = first_apart(own.energy_column(k), other.energy_column(k),
                                               units.newton() * units.metre,
                                               allowed * largest(own.energy_column(0)));
                !fault.empty())
                return broken(fmt::format("{}: its energy {}", where, fault));
    }
    return kept();
}

// ---- A later beginning

namespace {
constexpr long later_stepped = 44100, later_continuous = 4410 + 441;  // rows
constexpr double later_alike = 1e-6;

// String at rest until the pluck at `start` [s], above a soft bridge and on a soft thread if the
// scheme represents them.
Scene plucked_at(const Descriptor& d, double start) {
    const Features f = d.represents - approximated(d);
    Scene scene = string_at_rest();
    scene.name = "plucked";
    scene.duration = start + contract_rows / contract_tap_rate;
    String& s = scene.strings.front();
    if (!f.has(Feature::frequency_dependent_damping)) s.damping = NoDamping{};
    if (!f.has(Feature::bending_stiffness)) s.bending_stiffness = 0;
    s.pluck = Pluck{-0.4, 1e-3, 3.0, start, 0.4, 0.2};
    if (f.has(Feature::lumped_barrier)) {
        s.barriers = {LumpedBarrier{0.4, 0.2, -1e-4, {300}, 1, 0}};
        scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    }
    if (f.has(Feature::thread)) {
        s.thread = Thread{0.6, 0.2, 300, 0, 0};
        scene.taps.push_back({"thread", Quantity::thread_force, 0, 0});
    }
    return scene;
}
}  // namespace

Verdict plays_later_as_at_once(const Case& c) {
    const Descriptor& d = c.scheme;
    const bool steps = d.clock == Clock::stepped;
    const long later = steps ? later_stepped : later_continuous;
    constexpr double soon = 4 / contract_tap_rate;  // [s]: steps that end earlier are empty
    const Scene now = plucked_at(d, soon),
                then = plucked_at(d, soon + static_cast<double>(later) / contract_tap_rate);
    Settings settings = settings_for(d, now);
    settings.sample_rate = contract_tap_rate;
    if (!is_as_the_scene_says(d, now)) return not_asked("it represents no pluck");
    if (!takes(d, now, settings)) return not_asked("it refuses the plucked string");
    const Trace at_once = run(d, now, settings).trace, late = run(d, then, settings).trace;
    if (late.rows < later + at_once.rows)
        return broken(fmt::format("{} rows in place of {}", late.rows, later + at_once.rows));
    for (int k = 0; k < at_once.taps(); ++k) {
        const double allowed =
            (steps ? later_alike : continuous_alike) * largest(at_once.column(k));
        const auto rows = late.column(k).subspan(static_cast<std::size_t>(later));
        if (const auto fault = first_apart(at_once.column(k), rows, 1, allowed); !fault.empty())
            return broken(fmt::format("tap {} {}, counted from a pluck after {:.3g} s",
                                      at_once.names[k], fault,
                                      static_cast<double>(later) / contract_tap_rate));
    }
    return kept(fmt::format("after {} rows", later));
}

}  // namespace jvari::bench::check

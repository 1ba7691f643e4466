// Claims by a scheme alone, as a numerical method: the partials follow its own dispersion relation,
// and the scheme stays sound between settings. Claims against a reference are in
// against_references.cpp.
//
// Bounds and their reasons. Partials: the matrix pencil agrees with a recursion's partials to 2e-8
// cents (smoke suite); 1e-3 cents is far larger, and far below the effect of changing any equation.
// A map: no point on the sound side of the scheme's stability limit may be diverged, not_converged
// or energy_gaining (bench/study/judgement.hpp). Contacts that do not pull are a separate promise.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/check/promise.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/suite/maps.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::check {

// ---- Declarations by a scheme: refused scenes and represented features.

namespace {
// Settings under which a scheme may take a scene: the defaults, then each word for each option.
std::vector<Settings> ways(const Descriptor& d, const Scene& scene) {
    std::vector<Settings> all{settings_for(d, scene)};
    for (const Option& o : d.options)
        for (const char* word : o.words()) {
            all.push_back(all.front());
            all.back().options.emplace_back(o.name, word);
        }
    return all;
}

// Returns the features for which no scene and no settings pass `will_do`.
template <class Will>
Features without(Features asked_of, const Descriptor& d, Will will_do) {
    Features none;
    for (int k = 0; k < feature_count; ++k) {
        const auto feature = static_cast<Feature>(1u << k);
        if (!asked_of.has(feature)) continue;
        bool done = false;
        for (const Scene& scene : scenes_with(feature))
            for (const Settings& settings : ways(d, scene))
                done = done ||
                       (takes(d, scene, settings) && will_do(Case{d, scene, settings}, feature));
        if (!done) none = none | feature;
    }
    return none;
}
Features always_refused(const Descriptor& d) {
    return without(d.represents, d, [](const Case&, Feature) { return true; });
}

Trace trace_of(const Case& c, const Scene& scene) {
    try {
        return run(c.scheme, scene, c.settings).trace;
    } catch (const std::runtime_error&) {  // refusal or invalid scene
        return {};
    }
}

bool tells_apart(const Case& c, Feature feature, long rows) {
    Scene scene = c.scene;
    scene.duration = static_cast<double>(rows) / contract_tap_rate;
    const Trace one = trace_of(c, scene);
    for (const Scene& changed : otherwise(scene, feature)) {
        const Trace other = trace_of(c, changed);
        for (int k = 0; k < std::min(one.taps(), other.taps()); ++k) {
            double largest = 0, difference = 0;
            for (long n = 0; n < std::min(one.rows, other.rows); ++n) {
                largest = std::max(largest, std::abs(one.column(k)[n]));
                difference = std::max(difference, std::abs(one.column(k)[n] - other.column(k)[n]));
            }
            if (difference > 1e-9 * largest) return true;
        }
    }
    return false;
}
}  // namespace

Verdict refusals_name_what_is_missing(const Case& c) {
    try {
        make_scheme(c.scheme, c.scene, c.settings);
    } catch (const Refusal& refusal) {
        const std::string missing = names_of(needed_by(c.scene) - c.scheme.represents),
                          sentence = refusal.what();
        return sentence.find(missing) != std::string::npos
                   ? kept()
                   : broken(fmt::format("refuses without naming {}: {}", missing, sentence));
    }
    return broken("does not refuse it");
}

Verdict runs_a_scene(const Case& c) {
    const Features never = always_refused(c.scheme);
    const std::string refused = names_of(never);
    if (judge::is_external(c.scheme) && never != c.scheme.represents)
        return kept(refused.empty() ? "" : "refuses " + refused);
    return refused.empty() ? kept()
                           : broken(fmt::format(
                                 "declares {}, and refuses every scene that needs that", refused));
}

Verdict heeds_every_feature(const Case& c) {
    const Descriptor& d = c.scheme;
    // Features that are always refused belong to another promise.
    const Features claimed = d.represents - approximated(d) - always_refused(d);
    std::string deaf;
    for (int k = 0; k < feature_count; ++k) {
        const auto feature = static_cast<Feature>(1u << k);
        if (!claimed.has(feature)) continue;
        std::vector<std::string> tried;
        const auto tells = [&tried](const Case& one, Feature f) {
            if (std::ranges::find(tried, one.scene.name) == tried.end())
                tried.push_back(one.scene.name);
            return tells_apart(one, f, contract_rows) || tells_apart(one, f, 5 * contract_rows);
        };
        if (without(feature, d, tells).has(feature))
            deaf += fmt::format("{}{} (tried on {})", deaf.empty() ? "" : ", ", names_of(feature),
                                fmt::join(tried, ", "));
    }
    return deaf.empty() ? kept() : broken("its trace is the same whatever the values of " + deaf);
}

// ---- Numerical claims.

namespace {
constexpr double cents_allowed = 1e-3, decay_allowed = 1e-3;  // [1/s]
constexpr int points = 20;
constexpr double two_pi = 2 * std::numbers::pi;

// ---- Partials.

Scene ringing(bool stiff, bool damped) {
    Scene scene = string_at_rest();
    scene.duration = 0.2;
    String& s = scene.strings.front();
    s.start = TriangleShape{0.2, 1e-3, 0.02};
    if (!stiff) s.bending_stiffness = 0;
    if (!damped) s.damping = NoDamping{};
    return scene;
}

std::string worst_partial(const Descriptor& d, const Scene& scene, bool& any) {
    const Settings settings{contract_tap_rate, contract_tap_rate, contract_modes, {}};
    if (d.clock == Clock::continuous || !represents(d, scene) || !takes(d, scene, settings))
        return "";
    for (const HeardPartial& p : heard_partials(d, scene, settings, 1)) {
        any = true;
        const double off = std::abs(cents(p.heard.frequency, p.own.omega / two_pi)),
                     decay = std::abs(p.heard.decay - p.own.sigma);
        if (off > cents_allowed || decay > decay_allowed)
            return fmt::format(
                "partial {} sounds {:.3g} cents and {:.3g} per second from where its relation has "
                "it",
                p.mode, off, decay);
    }
    return "";
}

// ---- A map: five rates x four stiffnesses of a bridge, or of the string if the scheme has no
// bridge.

std::vector<std::pair<Scene, Settings>> map_of(const Descriptor& d) {
    const auto scene_at = [&d](int level) {
        Scene scene = ringing(true, true);
        scene.duration = 20e-3;
        String& s = scene.strings.front();
        s.start = ModeShape{1, 1.9e-3};
        if (d.represents.has(Feature::lumped_barrier)) {
            const double k[] = {1e4, 1e6, 1e8, 1e10};
            s.barriers = {LumpedBarrier{10e-3, 0, 0, {k[level]}, 1, 0}};
            return std::pair{scene, fmt::format("a bridge of {:g} N per m", k[level])};
        }
        const double stiffness[] = {0, 6.03e-5, 1e-3, 1e-2};
        s.bending_stiffness = d.represents.has(Feature::bending_stiffness) ? stiffness[level] : 0;
        if (!d.represents.has(Feature::frequency_dependent_damping)) s.damping = NoDamping{};
        return std::pair{scene,
                         fmt::format("a bending stiffness of {:g} N m^2", s.bending_stiffness)};
    };
    std::vector<std::pair<Scene, Settings>> all;
    for (const double rate : {22050.0, 29400.0, 44100.0, 66150.0, 96000.0})
        for (int level = 0; level < 4; ++level) {
            auto [scene, what] = scene_at(level);
            scene.name = fmt::format("{} at {:g} Hz", what, rate);
            all.push_back({suite::listened(scene),
                           {rate, suite::row_rate(rate), settings_for(d, scene).modes, {}}});
        }
    return all;
}
}  // namespace

std::vector<HeardPartial> heard_partials(const Descriptor& d, const Scene& scene,
                                         const Settings& settings, int tap) {
    constexpr int most = 30;
    constexpr double heard_below = 0.95;  // fraction of half the rate
    const String& s = scene.strings.front();
    const int count = std::min(
        {most, modes_for(s, settings), modes_below(s, 0.5 * heard_below * settings.sample_rate)});
    const std::vector<FreeMode> own = make_scheme(d, scene, settings)->free_modes();
    const Trace trace = run(d, scene, settings).trace;
    // smallest distance between two partials [rad/s]
    const double closest = modes_of(s, 1).omega0[0];
    std::vector<HeardPartial> all;
    for (int i = 0; i < std::min(count, static_cast<int>(own.size())); ++i) {
        if (!(own[i].omega > 0)) continue;
        const Partial heard = strongest_near(trace.column(tap), trace.tap_rate,
                                             own[i].omega / two_pi, 0.4 * closest / two_pi);
        if (!std::isnan(heard.frequency)) all.push_back({i + 1, own[i], heard});
    }
    return all;
}

Verdict partials_are_its_own_relations(const Case& c) {
    if (judge::is_external(c.scheme)) return not_asked(in_a_process);
    bool any = false;
    for (const bool stiff : {true, false})
        for (const bool damped : {true, false})
            if (const std::string fault = worst_partial(c.scheme, ringing(stiff, damped), any);
                !fault.empty())
                return broken(fault);
    return any ? kept()
               : not_asked("it has no relation in closed form, or no free string to hear it on");
}

// Checks the energy in one damped mode, known at any instant: initial energy and remaining energy.
Verdict stores_the_energy_of_the_scene(const Case& c) {
    constexpr double allowed = 0.02;  // fraction of the initial energy
    const Descriptor& d = c.scheme;
    if (d.balance == Balance::none) return not_asked("it promises no balance");
    const Features f = d.represents - approximated(d);
    Scene scene = string_at_rest();
    scene.duration = contract_rows / contract_tap_rate;
    String& s = scene.strings.front();
    if (!f.has(Feature::bending_stiffness)) s.bending_stiffness = 0;
    s.damping = NoDamping{};
    if (f.has(Feature::damping)) s.damping = PolynomialDamping{200, 0, 0};
    const double a = 1e-3, v = 0.5;
    if (f.has(Feature::initial_shape)) s.start = ModeShape{1, a};
    else s.velocity = ModeShape{1, v};
    const Settings settings = settings_for(d, scene);
    if (!takes(d, scene, settings)) return not_asked("it refuses a string in its first mode");
    const Modes one = modes_of(s, 1);
    const double omega0 = one.omega0[0], sigma = one.sigma[0],
                 omega = std::sqrt(omega_squared_damped(omega0, sigma));
    const Trace t = run(d, scene, settings, {.energy = true}).trace;
    const auto stored = t.energy_column(0);
    double start = 0;
    for (long n = 0; n < t.rows; ++n) {
        const double time = static_cast<double>(n) / contract_tap_rate, p = std::exp(-sigma * time),
                     cosine = p * std::cos(omega * time), sine = p * std::sin(omega * time) / omega;
        const double y = s.start ? a * (cosine + sigma * sine) : v * sine,
                     moves = s.start ? -a * omega0 * omega0 * sine : v * (cosine - sigma * sine);
        const double energy = 0.5 * one.mass * (moves * moves + omega0 * omega0 * y * y);
        if (n == 0) start = energy;
        if (!(std::abs(stored[static_cast<std::size_t>(n)] - energy) <= allowed * start))
            return broken(fmt::format("stores {:.4g} J in row {}, where the string has {:.4g} J",
                                      stored[static_cast<std::size_t>(n)], n, energy));
    }
    return kept(fmt::format("{:.3g} J", start));
}

Verdict stays_sound_over_a_map(const Case& c) {
    const Descriptor& d = c.scheme;
    if (d.balance == Balance::none) return not_asked("it promises no balance");
    int sound = 0;
    for (const auto& [scene, settings] : map_of(d)) {
        if (!takes(d, scene, settings)) continue;
        // Skips points that are unsound by the scheme's own limit.
        if (d.limit.margin && d.limit.margin(scene, settings) < 0) continue;
        study::Cell cell{&d, settings};
        try {
            study::run_cell(cell, scene, false, [](long, long) { store::throw_if_cancelled(); });
        } catch (const std::exception& e) { study::fail(cell, e); }
        const study::Judgement j = study::judge(cell, nan);
        if (j.verdict == study::Verdict::diverged || j.verdict == study::Verdict::not_converged ||
            j.verdict == study::Verdict::energy_gaining)
            return broken(fmt::format("{} with {}: {}", name_of(j.verdict), scene.name, j.detail));
        ++sound;
    }
    return sound > 0 ? kept(fmt::format("{} of {} points", sound, points))
                     : not_asked("it refuses all points");
}

}  // namespace jvari::bench::check

// What a scheme says of itself: which scenes it refuses, which features it has.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/check/promise.hpp"
#include "bench/check/scenes.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::check {

namespace {
// Settings at which a scheme may take a scene: as it is, then with each word of each of its
// options.
std::vector<Settings> ways(const Descriptor& d, const Scene& scene) {
    std::vector<Settings> all{settings_for(d, scene)};
    for (const Option& o : d.options)
        for (const char* word : o.words()) {
            all.push_back(all.front());
            all.back().options.emplace_back(o.name, word);
        }
    return all;
}

// Of these features those for which no scene and settings will do.
template <class Will>
Features without(Features asked_of, const Descriptor& d, Will will_do) {
    Features none;
    for (int k = 0; k < feature_count; ++k) {
        const auto feature = static_cast<Feature>(1u << k);
        if (!asked_of.has(feature)) continue;
        bool found = false;
        for (const Scene& scene : scenes_with(feature))
            for (const Settings& settings : ways(d, scene))
                found = found ||
                        (takes(d, scene, settings) && will_do(Case{d, scene, settings}, feature));
        if (!found) none = none | feature;
    }
    return none;
}
Features always_refused(const Descriptor& d) {
    return without(d.represents, d, [](const Case&, Feature) { return true; });
}

Trace trace_of(const Case& c, const Scene& scene) {
    try {
        return run(c.scheme, scene, c.settings).trace;
    } catch (const std::runtime_error&) {  // refused, or no scene
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
                          said = refusal.what();
        return said.find(missing) != std::string::npos
                   ? kept()
                   : broken(fmt::format("refuses without naming {}: {}", missing, said));
    }
    return broken("does not refuse it");
}

Verdict runs_a_scene(const Case& c) {
    const Features never = always_refused(c.scheme);
    const std::string refused = names_of(never);
    if (is_called(c.scheme) && never != c.scheme.represents)
        return kept(refused.empty() ? "" : "refuses " + refused);
    return refused.empty() ? kept()
                           : broken(fmt::format(
                                 "declares {}, and refuses every scene that needs that", refused));
}

Verdict heeds_every_feature(const Case& c) {
    const Descriptor& d = c.scheme;
    // what is always refused is another promise
    Features left = d.represents - approximated(d) - always_refused(d);
    left = without(left, d, [](const Case& one, Feature f) {
        return tells_apart(one, f, contract_rows) || tells_apart(one, f, 5 * contract_rows);
    });
    return left.empty() ? kept()
                        : broken(fmt::format("its trace is the same whatever the values of {}",
                                             names_of(left)));
}

}  // namespace jvari::bench::check

#include "bench/compare/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/store/records.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/store/usage.hpp"
#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::compare {

std::string identity_of(const CompareRequest& r) {
    std::string text =
        write_scene(load_scene(r)) +
        fmt::format("{}\n{}\n{}\n{}\n{}\n{} {} {} {}", r.reference, fmt::join(r.schemes, " "),
                    fmt::join(r.rates, " "), fmt::join(r.modes, " "), r.tap,
                    r.reference_modes.value_or(-1), r.search, r.controls, r.tap_rate.value_or(0));
    for (const SchemeOption& o : r.options)
        text += fmt::format("\n{}:{}={}", o.scheme, o.name, o.value);
    return text;
}

Catalogue::Catalogue(const std::vector<std::string>& plugins) {
    for (const Descriptor& d : jvari::schemes()) schemes.push_back(&d);
    for (const Descriptor& d : jvari::references()) references.push_back(&d);
    for (const Descriptor& d : schemes_of_pairings()) paired.push_back(&d);
    for (const std::string& path : plugins) {
        std::span<const Descriptor> brought;
        try {
            brought = load_plugin(path).schemes;
        } catch (const std::runtime_error& e) { throw store::UsageError(e.what()); }
        for (const Descriptor& d : brought) {
            const auto same = [&d](const Descriptor* other) {
                return std::string(other->name) == d.name;
            };
            if (std::any_of(schemes.begin(), schemes.end(), same) ||
                std::any_of(references.begin(), references.end(), same))
                throw store::UsageError("plugin " + path + ": there is a scheme of the name " +
                                        d.name + " already");
            schemes.push_back(&d);
        }
    }
}

const Descriptor& Catalogue::find(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto* list : {&schemes, &references, &paired})
        for (const Descriptor* d : *list) {
            if (name == d->name) return *d;
            names.emplace_back(d->name);
        }
    if (name == "all")
        throw store::UsageError("unknown scheme \"all\"; without --schemes all of them run");
    throw store::UsageError(store::unknown("scheme or reference", name, names));
}

void note_slow_plugins(const store::Listener& listener) {
    for (const Guest* g : guests())
        if (!g->optimised)
            listener.warn(
                "plugin " + g->path +
                " is compiled without optimisation: its times say nothing of its schemes");
}

Scene load_scene(const std::string& name, const std::vector<std::string>& overrides,
                 std::optional<double> duration) {
    Scene scene = read_scene(name, overrides);
    if (duration) scene.duration = *duration;
    return scene;
}

Scene load_scene(const CompareRequest& r) {
    Scene scene = load_scene(r.scene, r.set, r.duration);
    if (!r.tap.empty())
        scene.taps = {scene.taps[static_cast<std::size_t>(tap_named(scene, r.tap))]};
    return scene;
}

int tap_named(const Scene& scene, const std::string& name) {
    if (scene.taps.empty())
        throw store::UsageError(
            "scene " + scene.name +
            " has no tap: there is nothing to judge. A [[tap]] says what to hear");
    std::vector<std::string> names;
    for (const Tap& tap : scene.taps) {
        if (name.empty() || tap.name == name) return static_cast<int>(names.size());
        names.push_back(tap.name);
    }
    throw store::UsageError(store::unknown("tap", name, names));
}

bool whole_multiple(double rate, double of) {
    const double ratio = rate / of;
    return std::round(ratio) >= 1 && std::abs(ratio - std::round(ratio)) <= 1e-9 * ratio;
}

Settings settings_of_run(const Descriptor& d, double rate, std::optional<double> tap_rate,
                         int modes, const std::vector<SchemeOption>& options) {
    Settings s;
    const bool continuous = d.clock == Clock::continuous;
    s.sample_rate = continuous ? 0 : rate;
    s.tap_rate = tap_rate.value_or(continuous || whole_multiple(rate, 44100) ? 44100 : rate);
    s.modes = modes;
    if (!continuous && !whole_multiple(rate, s.tap_rate))
        throw store::UsageError(fmt::format(
            "tap rate {}: the sample rate of {} Hz is no whole multiple of it", s.tap_rate, rate));
    for (const SchemeOption& o : options) {
        if (!o.scheme.empty() && o.scheme != d.name)
            throw store::UsageError(
                fmt::format("option {}:{}: this run is of {}", o.scheme, o.name, d.name));
        s.options.emplace_back(o.name, o.value);
    }
    return s;
}

std::string arguments_of(const Descriptor& d, const Settings& s) {
    std::string text = fmt::format("--scheme {} --rate {}", d.name, s.sample_rate);
    if (s.modes > 0) text += fmt::format(" --modes {}", s.modes);
    if (s.tap_rate != 44100) text += fmt::format(" --tap-rate {}", s.tap_rate);
    for (const auto& [name, value] : s.options) text += fmt::format(" --option {}={}", name, value);
    return text;
}

std::string settings_text(const Descriptor& d, const Settings& s) {
    std::string text = store::variant_name(d.name, store::options_text(s.options));
    if (s.modes > 0) text += fmt::format(", {} modes", s.modes);
    return text + fmt::format(", {:g} Hz", s.sample_rate);
}

std::optional<int> dofs_with(int modes, const Descriptor& d, const Scene& scene,
                             Settings settings) {
    settings.modes = modes;
    try {
        return make_scheme(d, scene, settings)->dofs();
    } catch (const std::exception&) { return std::nullopt; }
}

std::vector<std::string> names_in(Features features) {
    std::vector<std::string> names;
    for (int i = 0; i < feature_count; ++i)
        if (const auto f = static_cast<Feature>(1u << i); features.has(f))
            names.emplace_back(name_of(f));
    return names;
}

Features features_of(const std::vector<std::string>& names) {
    const std::vector<std::string> known = names_in(Features((1u << feature_count) - 1));
    Features all;
    for (const std::string& name : names) {
        const auto found = std::ranges::find(known, name);
        if (found == known.end()) throw store::UsageError(store::unknown("feature", name, known));
        all = all | Features(1u << (found - known.begin()));
    }
    return all;
}

Balance balance_of(const std::string& name) {
    const std::vector<std::string> known{"exact", "to tolerance", "none"};
    const auto found = std::ranges::find(known, name);
    if (found == known.end()) throw store::UsageError(store::unknown("balance", name, known));
    return static_cast<Balance>(found - known.begin());
}

}  // namespace jvari::bench::compare

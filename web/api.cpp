// The core behind plain C calls, for a page's worker: texts and numbers in, a run's handle or 0
// out. After a 0 `jv_said` holds the program's sentence of refusal. A returned text stays valid
// until the next call.
#include <emscripten.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "analysis/alignment.hpp"
#include "analysis/cheapest.hpp"
#include "analysis/error.hpp"
#include "analysis/spectrum.hpp"
#include "reference/agreement.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "web/json.hpp"

#define JV extern "C" EMSCRIPTEN_KEEPALIVE

namespace jvari::web {
namespace {
constexpr double most_values = 3e7;  // a trace of a quarter of a gigabyte

std::string last_text;

template <class Do>
auto tried(Do act) -> decltype(act()) {
    try {
        return act();
    } catch (const std::bad_alloc&) {
        last_text =
            "The page has no more memory for this: ask for a shorter run or fewer modes, or use "
            "the program `jvari run`.";
    } catch (const std::exception& e) { last_text = e.what(); }
    return {};
}

const char* answer(auto text) {  // nullptr: refused
    return tried([&] { return (last_text = text()).c_str(); });
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> all;
    for (std::size_t begin = 0, end; begin < text.size(); begin = end + 1) {
        end = std::min(text.find('\n', begin), text.size());
        if (end > begin) all.push_back(text.substr(begin, end - begin));
    }
    return all;
}

const Descriptor& scheme_of(const std::string& name) {
    for (const auto& list : {schemes(), references()})
        for (const Descriptor& d : list)
            if (name == d.name) return d;
    throw Refusal(
        "unknown scheme " + quote(name) +
        (name == "sundials" ? ": it is not part of the page; use the program `jvari run`" : ""));
}

Settings settings_of(const Descriptor& d, double rate, double tap_rate, int modes,
                     const char* options) {
    Settings s{.sample_rate = d.clock == Clock::continuous ? 0 : rate,
               .tap_rate = tap_rate,
               .modes = modes,
               .options = {}};
    for (const std::string& o : lines_of(options)) {
        const auto at = o.find('=');
        if (at == std::string::npos) throw Refusal("option " + quote(o) + ": expected NAME=VALUE");
        s.options.emplace_back(o.substr(0, at), o.substr(at + 1));
    }
    return s;
}

// Adds taps for drawing: displacements of the first string at these fractions of the length, one a
// line.
void add_shape(Scene& scene, const char* places) {
    for (const std::string& place : lines_of(places))
        scene.taps.push_back({"at_" + place, Quantity::displacement, 0,
                              scene.strings[0].length * number_of(place).value_or(0.5)});
}
}  // namespace

struct Kept {
    Run run;
    Scene scene;
    Settings settings{};
    Balance promised = Balance::none;

    std::span<const double> free(int tap) const {
        return rows_from(run.trace.column(tap), free_from(scene), run.trace.tap_rate);
    }
    double power_above(double hertz, int tap) const {
        const PowerSpectrum s = power_spectrum(free(tap), run.trace.tap_rate);
        const auto first = static_cast<std::size_t>(std::ceil(hertz / s.bin_hz));
        return std::accumulate(s.power.begin() + static_cast<long>(std::min(first, s.power.size())),
                               s.power.end(), 0.0);
    }
};
}  // namespace jvari::web

using namespace jvari;
using namespace jvari::web;

JV const char* jv_said() { return last_text.c_str(); }

JV const char* jv_list() { return (last_text = list_text()).c_str(); }

// Scene as JSON, for drawing; nullptr: refused.
JV const char* jv_scene(const char* text, const char* overrides) {
    return answer([&] { return scene_text(parse_scene(text, "scene", lines_of(overrides))); });
}

// The problem as arrays, for a scheme typed into the page; nullptr: refused.
JV const char* jv_problem(const char* text, const char* overrides, double rate, int modes,
                          double duration) {
    return answer([&] {
        Scene scene = parse_scene(text, "scene", lines_of(overrides));
        scene.duration = duration;
        return problem_text(scene, {.sample_rate = rate, .modes = modes, .options = {}});
    });
}

// Runs a scene. `duration` 0: the scene's. `modes` 0: the scheme's default. `options`: a line
// NAME=VALUE each. `shape`: places on the first string, as fractions of the length, a line each;
// their displacements follow the scene's taps.
JV Kept* jv_run(const char* text, const char* overrides, const char* scheme, double rate,
                double tap_rate, int modes, const char* options, double duration, const char* shape,
                int energy) {
    return tried([&]() -> Kept* {
        auto kept = std::make_unique<Kept>();
        Scene& scene = kept->scene = parse_scene(text, "scene", lines_of(overrides));
        if (duration > 0) scene.duration = duration;
        add_shape(scene, shape);
        const Descriptor& d = scheme_of(scheme);
        const Settings settings = settings_of(d, rate, tap_rate, modes, options);
        if (static_cast<double>(rows_of(scene, settings)) *
                static_cast<double>(scene.taps.size() + 3) >
            most_values)
            throw Refusal("A run of " + number_text(scene.duration) +
                          " s is too long for the page: use the program, `jvari run " + scene.name +
                          " --scheme " + d.name + "`.");
        kept->settings = settings;
        kept->promised = d.balance;
        const auto stepper = make_scheme(d, scene, settings);
        kept->run = run(*stepper, scene, settings, {.energy = energy != 0});
        return kept.release();
    });
}

JV const char* jv_about(const Kept* k) {
    return (last_text = run_text(k->run, k->scene, modes_for(k->scene, k->settings), k->promised))
        .c_str();
}
JV const double* jv_tap(const Kept* k, int tap) { return k->run.trace.column(tap).data(); }
JV const double* jv_energy(const Kept* k, int column) {  // stored, supplied, dissipated
    return k->run.trace.energy.empty() ? nullptr : k->run.trace.energy_column(column).data();
}
JV void jv_free(Kept* k) { delete k; }

// Differences between two runs of one scene on a tap after the last pluck: ||a - b||/||b|| over the
// first `seconds` (0: all), the time of agreement within 10 %, third octaves within `range` [dB] of
// the loudest [dB], and the loudness of a over b above a frequency [dB].
JV double jv_error(const Kept* a, const Kept* b, int tap, double seconds) {
    const double left = b->scene.duration - free_from(b->scene);
    return relative_l2(a->free(tap), b->free(tap), b->run.trace.tap_rate,
                       {0, seconds > 0 ? std::min(seconds, left) : left});
}
JV double jv_horizon(const Kept* a, const Kept* b, int tap) {
    return horizon(a->free(tap), b->free(tap), b->run.trace.tap_rate);
}
JV double jv_third_octaves(const Kept* a, const Kept* b, int tap, double range) {
    return third_octave_difference(a->free(tap), b->free(tap), b->run.trace.tap_rate,
                                   {.range = range});
}
JV double jv_louder(const Kept* a, const Kept* b, int tap, double hertz) {
    return 10 * std::log10(a->power_above(hertz, tap) / b->power_above(hertz, tap));
}
// How a sounds beside b; nullptr: refused.
JV const char* jv_sounds(const Kept* a, const Kept* b, int tap) {
    return answer([&] { return sounds_text(a->free(tap), b->free(tap), b->run.trace.tap_rate); });
}
JV double jv_left_after(double last, double before, int matched) {
    const double changes[] = {before, last};
    return left_after(std::span(changes).last(std::isnan(before) ? 1 : 2), matched != 0);
}

// Choice among runs by these schemes, a line each; `figures`: error, uncertainty, cost and two
// quartiles per run.
JV const char* jv_cheapest(const char* schemes, const double* figures, double accuracy) {
    std::vector<Offer> offers;
    for (const std::string& name : lines_of(schemes)) {
        offers.push_back({name, at_most(figures[0], figures[1]), at_least(figures[0], figures[1]),
                          figures[2], figures[3], figures[4]});
        figures += 5;
    }
    return (last_text = choice_text(cheapest_within(accuracy, offers))).c_str();
}

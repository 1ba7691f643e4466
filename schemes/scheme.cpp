// What every scheme checks before it is made.
#include "schemes/scheme.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "scenes/modes.hpp"

namespace jvari {

const char* name_of(Outcome outcome) {
    switch (outcome) {
        case Outcome::ok: return "ok";
        case Outcome::diverged: return "diverged";
        case Outcome::not_converged: return "not_converged";
    }
    return "?";
}

void refuse_missing(const Descriptor& scheme, const Scene& scene) {
    const Features missing = needed_by(scene) - scheme.represents;
    if (!missing.empty())
        throw Refusal(std::string(scheme.name) + " cannot represent scene " + scene.name + ": it has no " + names_of(missing));
}

int steps_per_row(const Settings& s) {
    const double ratio = s.sample_rate / s.tap_rate, whole = std::round(ratio);
    if (!(whole >= 1) || std::abs(ratio - whole) > 1e-9 * whole)
        throw Refusal("the sample rate " + std::to_string(s.sample_rate) + " Hz is no whole multiple of the tap rate " +
                      std::to_string(s.tap_rate) + " Hz");
    if (whole > std::numeric_limits<int>::max())
        throw Refusal("the sample rate is " + std::to_string(whole) + " times the tap rate; no more than " +
                      std::to_string(std::numeric_limits<int>::max()) + " steps fit between two rows");
    return static_cast<int>(whole);
}

namespace {
double default_limit(const Settings& s) {  // of the modes that are carried unasked [Hz]
    return s.sample_rate > 0 ? std::min(20e3, 0.5 * s.sample_rate) : 20e3;
}
}  // namespace

int modes_for(const String& string, const Settings& s) {
    return s.modes > 0 ? s.modes : modes_below(string, default_limit(s));
}

Modes modes_of(const String& string, const Settings& s) {
    const int count = modes_for(string, s);
    if (count > 0 && count <= most_modes) return modes_of(string, count);
    const std::string limit = std::to_string(std::lround(default_limit(s))) + " Hz";
    if (count == 0) throw Refusal("the string has no mode below " + limit + ", where a scheme stops unasked: say how many it is to carry");
    throw Refusal("the string has " + (s.modes > 0 ? std::to_string(count) + " modes" : "too many modes below " + limit) +
                  "; no more than " + std::to_string(most_modes) + " are carried");
}

void refuse_unknown_options(const Settings& s, std::initializer_list<const char*> names) {
    for (const auto& [name, value] : s.options) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        std::string known;
        for (const char* n : names) known += (known.empty() ? "" : ", ") + std::string(n);
        throw UnknownOption("unknown option " + name + "; this scheme has " + (known.empty() ? "none" : known));
    }
}

std::string option(const Settings& s, const char* name, const char* fallback) {
    for (const auto& [key, value] : s.options)
        if (key == name) return value;
    return fallback;
}

double number_option(const Settings& s, const char* name, double fallback) {
    const std::string text = option(s, name, "");
    if (text.empty()) return fallback;
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw Refusal("option " + std::string(name) + ": found \"" + text + "\", expected a number");
    return value;
}

}  // namespace jvari

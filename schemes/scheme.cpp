// What every scheme checks before it is made.
#include "schemes/scheme.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

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
    return static_cast<int>(whole);
}

int modes_for(const String& string, const Settings& s) {
    if (s.modes > 0) return s.modes;
    return modes_below(string, s.sample_rate > 0 ? std::min(20e3, 0.5 * s.sample_rate) : 20e3);
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

// Checks every scheme before the scheme is made.
#include "schemes/scheme.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenes/modes.hpp"
#include "scenes/wording.hpp"
#include "schemes/making.hpp"
#include "schemes/several_strings.hpp"

namespace jvari {

const char* name_of(Outcome outcome) {
    switch (outcome) {
        case Outcome::ok: return "ok";
        case Outcome::diverged: return "diverged";
        case Outcome::not_converged: return "not_converged";
    }
    return "?";
}

std::span<const char* const> Option::words() const {
    std::size_t count = 0;
    while (count < std::size(choices) && choices[count]) ++count;
    return {choices, count};
}

namespace {
void refuse_missing(const Descriptor& scheme, const Scene& scene) {
    const Features missing = needed_by(scene) - scheme.represents;
    if (!missing.empty())
        throw Refusal(std::string(scheme.name) + " cannot represent scene " + scene.name +
                      ": it has no " + names_of(missing));
}

template <class Items, class Word>
std::string listed(const Items& items, Word word) {
    std::string text;
    for (const auto& item : items) text += (text.empty() ? "" : ", ") + std::string(word(item));
    return text;
}

void refuse_bad_options(const Descriptor& scheme, const Settings& settings) {
    for (const auto& [name, value] : settings.options) {
        if (!declares(scheme, name)) {
            const std::string known =
                listed(scheme.options, [](const Option& o) { return o.name; });
            throw BadOption("unknown option " + name + "; this scheme has " +
                            (known.empty() ? "none" : known));
        }
        const auto same = [&name = name](const auto& o) { return o.first == name; };
        if (std::count_if(settings.options.begin(), settings.options.end(), same) > 1)
            throw BadOption("option " + name + ": found more than once, expected one value");
    }
    for (const Option& o : scheme.options)
        if (!o.words().empty()) choice_option(settings, o);
}
}  // namespace

double fact_of(const std::vector<Fact>& facts, const std::string& name) {
    double worst = std::numeric_limits<double>::quiet_NaN();
    for (const Fact& f : facts) {
        if (f.name == name) return f.value;
        if (!f.name.starts_with("string.") || !f.name.ends_with("." + name)) continue;
        worst = name == facts::smallest_contact_force.name ? std::fmin(worst, f.value)
                                                           : std::fmax(worst, f.value);
    }
    return worst;
}

bool represents(const Descriptor& scheme, const Scene& scene) {
    return (needed_by(scene) - scheme.represents).empty();
}

bool declares(const Descriptor& scheme, const std::string& name) {
    return std::any_of(scheme.options.begin(), scheme.options.end(),
                       [&name](const Option& o) { return name == o.name; });
}

Features approximated(const Descriptor& scheme) {
    Features all;
    for (const Approximation& a : scheme.approximates) all = all | a.feature;
    return all;
}

std::unique_ptr<Scheme> make_scheme(const Descriptor& descriptor, const Scene& scene,
                                    const Settings& settings) {
    refuse_missing(descriptor, scene);
    refuse_bad_options(descriptor, settings);
    if (scene.strings.size() > 1 && !needed_by(scene).has(Feature::moving_body) &&
        !descriptor.all_strings)
        return several_strings(descriptor, scene, settings);
    auto scheme =
        with_context("is made", [&] { return descriptor.make(descriptor, scene, settings); });
    if (!scheme)
        throw BadScheme(std::string(descriptor.name) + " makes no scheme of scene " + scene.name +
                        ", and does not refuse it either");
    return scheme;
}

double margin_of(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    double least = std::numeric_limits<double>::quiet_NaN();
    for (int k = 0; descriptor.limit.margin && k < static_cast<int>(scene.strings.size()); ++k)
        // fmin of a number and NaN returns the number
        least = std::fmin(least, descriptor.limit.margin(alone(scene, k), settings));
    return least;
}

int steps_per_row(const Settings& s) {
    const double ratio = s.sample_rate / s.tap_rate, whole = std::round(ratio);
    if (!(whole >= 1) || std::abs(ratio - whole) > 1e-9 * whole)
        throw Refusal("the sample rate " + std::to_string(s.sample_rate) +
                      " Hz is no whole multiple of the tap rate " + std::to_string(s.tap_rate) +
                      " Hz");
    if (whole > std::numeric_limits<int>::max())
        throw Refusal(
            "the sample rate is " + std::to_string(whole) + " times the tap rate; no more than " +
            std::to_string(std::numeric_limits<int>::max()) + " steps fit between two rows");
    return static_cast<int>(whole);
}

namespace {
double default_limit(const Settings& s) {  // for the modes carried by default [Hz]
    return s.sample_rate > 0 ? std::min(20e3, 0.5 * s.sample_rate) : 20e3;
}
}  // namespace

int modes_for(const String& string, const Settings& s) {
    return s.modes > 0 ? s.modes : modes_below(string, default_limit(s));
}

int modes_for(const Scene& scene, const Settings& s) {
    int most = 0;
    for (const String& string : scene.strings) most = std::max(most, modes_for(string, s));
    for (const String& string : scene.strings)
        if (const auto measured = modes_measured(string); measured && s.modes == 0)
            most = std::min(most, *measured);
    return most;
}

Modes modes_of(const String& string, const Settings& s) {
    const int count = modes_for(string, s);
    if (count > 0 && count <= most_modes) return modes_of(string, count);
    const std::string limit = std::to_string(std::llround(default_limit(s))) + " Hz";
    if (count == 0)
        throw Refusal(
            "the string has no mode below " + limit +
            (s.sample_rate > 0 && s.sample_rate < 1000
                 ? ": is the sample rate of " + number_text(s.sample_rate) + " Hz meant in kHz?"
                 : ": say how many modes it is to carry"));
    throw Refusal(
        "the string has " +
        (s.modes > 0 ? std::to_string(count) + " modes" : "too many modes below " + limit) +
        "; no more than " + std::to_string(most_modes) + " are carried");
}

std::string option(const Settings& s, const Option& o) {
    for (const auto& [key, value] : s.options)
        if (key == o.name) return value;
    return o.fallback;
}

namespace {
std::string did_you_mean(const std::string& text, std::span<const char* const> words) {
    const std::string near = nearest(text, {words.begin(), words.end()});
    return near.empty() ? "" : "; did you mean " + quote(near) + "?";
}
}  // namespace

std::string choice_option(const Settings& s, const Option& o) {
    const std::string text = option(s, o);
    const auto words = o.words();
    if (std::find(words.begin(), words.end(), text) == words.end())
        throw Refusal(
            "option " + std::string(o.name) + ": found \"" + text + "\", expected one of " +
            listed(words, [](const char* word) { return word; }) + did_you_mean(text, words));
    return text;
}

double number_option(const Settings& s, const Option& o) {
    const std::string text = option(s, o);
    const auto value = number_of(text);
    if (!value || !std::isfinite(*value))
        throw Refusal("option " + std::string(o.name) + ": found \"" + text +
                      "\", expected a number");
    return *value;
}

double number_option(const Settings& s, const Option& o, double fallback) {
    return option(s, o).empty() ? fallback : number_option(s, o);
}

}  // namespace jvari

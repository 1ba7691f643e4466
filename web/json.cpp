#include "web/json.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "reference/references.hpp"
#include "scenes/barrier.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/pitch.hpp"
#include "scenes/wording.hpp"
#include "schemes/controls.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"
#include "schemes/vector_instructions.hpp"

namespace jvari::web {

namespace {
std::string text_of(double x) {  // JSON has no infinity: a number too large to be one reads as such
    return std::isnan(x) ? "null" : std::isinf(x) ? (x < 0 ? "-1e999" : "1e999") : number_text(x);
}
std::string text_of(const std::string& s) {
    return quote(s);
}
std::string text_of(const char* s) {
    return quote(s);
}
std::string text_of(bool b) {
    return b ? "true" : "false";
}

class Object {  // {"name": value, ...}
public:
    template <class T>
    Object& with(const char* name, const T& value) {
        return raw(name, text_of(value));
    }
    Object& raw(const char* name, const std::string& json) {
        inside_ += (inside_.empty() ? "" : ",") + quote(name) + ":" + json;
        return *this;
    }
    std::string text() const { return "{" + inside_ + "}"; }

private:
    std::string inside_;
};

template <class List, class Of>
std::string array(const List& list, Of of) {
    std::string inside;
    for (const auto& one : list) inside += (inside.empty() ? "" : ",") + of(one);
    return "[" + inside + "]";
}

std::string scheme_text(const Descriptor& d, bool reference) {
    const auto option = [](const Option& o) {
        return Object()
            .with("name", o.name)
            .with("fallback", o.fallback)
            .with("meaning", o.meaning)
            .raw("words", array(o.words(), [](const char* w) { return quote(w); }))
            .text();
    };
    return Object()
        .with("name", d.name)
        .with("source", d.source)
        .with("note", d.note)
        .with("reference", reference)
        .with("control", is_control(d))
        .with("stepped", d.clock == Clock::stepped)
        .raw("options", array(d.options, option))
        .text();
}

std::string barrier_text(const Barrier& b, double length) {
    Object o;
    if (const auto* point = std::get_if<LumpedBarrier>(&b))
        return o.with("shape", "lumped")
            .with("position", point->position)
            .with("width", point->width)
            .with("height", point->height)
            .with("stiffness", point->stiffness.k)
            .with("exponent", point->exponent)
            .text();
    const auto& profile = std::get<ProfileBarrier>(b);
    std::vector<double> x;
    for (int k = 0; k <= 64; ++k) x.push_back(profile.from + (std::min(profile.to, length) - profile.from) * k / 64);
    const std::vector<double> h = heights(profile.curve, x);
    return o.with("shape", "profile")
        .with("from", profile.from)
        .with("to", profile.to)
        .with("stiffness", profile.stiffness.K)
        .with("exponent", profile.exponent)
        .raw("x", array(x, [](double v) { return text_of(v); }))
        .raw("height", array(h, [](double v) { return text_of(v); }))
        .text();
}

std::string initial_text(const ModeInitial& m) {
    return Object().with("shape", "mode").with("number", static_cast<double>(m.number)).with("amplitude", m.amplitude).text();
}
std::string initial_text(const TriangleInitial& t) {
    return Object().with("shape", "triangle").with("position", t.position).with("amplitude", t.amplitude).text();
}

std::string string_text(const String& s) {
    Object o;
    o.with("length", s.length)
        .with("linear_density", s.linear_density)
        .with("tension", s.tension)
        .with("bending_stiffness", s.bending_stiffness);
    o.with("pitch", pitch_of(s)).with("note", note_of(pitch_of(s)));
    o.raw("barrier", array(s.barriers, [&s](const Barrier& b) { return barrier_text(b, s.length); }));
    if (s.thread) o.raw("thread", Object().with("position", s.thread->position).with("height", s.thread->height).text());
    if (s.initial) o.raw("initial", std::visit([](const auto& shape) { return initial_text(shape); }, *s.initial));
    if (s.pluck)
        o.raw("pluck", Object()
                           .with("position", s.pluck->position)
                           .with("amplitude", s.pluck->amplitude)
                           .with("start", s.pluck->start)
                           .with("duration", s.pluck->duration)
                           .text());
    return o.text();
}
}  // namespace

std::string list_text() {
    return Object()
        .with("instructions", vector_instructions())
        .raw("schemes", array(schemes(), [](const Descriptor& d) { return scheme_text(d, false); }))
        .raw("references", array(references(), [](const Descriptor& d) { return scheme_text(d, true); }))
        .text();
}

std::string scene_text(const Scene& scene) {
    const Descriptor* reference = best_reference(scene);
    const Features needed = needed_by(scene);
    const auto tap = [](const Tap& t) {
        return Object().with("name", t.name).with("quantity", name_of(t.quantity)).with("unit", unit_of(t.quantity)).text();
    };
    std::vector<std::string> able;
    for (const Descriptor& d : schemes())
        if ((needed - d.represents).empty()) able.emplace_back(d.name);
    return Object()
        .with("name", scene.name)
        .with("source", scene.source)
        .with("duration", scene.duration)
        .raw("string", array(scene.strings, string_text))
        .raw("tap", array(scene.taps, tap))
        .raw("able", array(able, quote))
        .with("reference", reference ? reference->name : "")
        .text();
}

// The string as arrays, for a scheme typed into the page: what a modal scheme with contacts of lumped barriers and a thread begins with.
std::string problem_text(const Scene& scene, const Settings& settings) {
    if (scene.strings.size() != 1) throw Refusal("the arrays are of one string; this scene has " + std::to_string(scene.strings.size()));
    const String& s = scene.strings[0];
    const Modes modes = modes_of(s, settings);
    const auto numbers = [](const std::vector<double>& v) { return array(v, [](double x) { return text_of(x); }); };
    std::vector<LumpedBarrier> contacts;
    for (const Barrier& b : s.barriers) {
        if (!std::holds_alternative<LumpedBarrier>(b)) throw Refusal("the arrays are of barriers that are points; this one is a profile");
        contacts.push_back(std::get<LumpedBarrier>(b));
    }
    const auto of = [&](auto value) { return array(contacts, [&](const LumpedBarrier& b) { return text_of(value(b)); }); };
    const auto weights = [&](double x, double width) { return numbers(footprint_weights(modes, x, width)); };
    const auto tap = [&](const Tap& t) {
        if (t.quantity == Quantity::nut_force) return numbers(nut_force_weights(modes, s));
        return numbers(lacks(s, t.quantity) || t.position > 0 ? displacement_weights(modes, t.position)
                                                              : std::vector<double>(modes.beta.size()));
    };
    const double steps = steps_per_row(settings), rows = static_cast<double>(rows_of(scene, settings));
    std::vector<double> pluck;
    if (s.pluck)
        for (double n = 0; n <= (rows - 1) * steps && n / settings.sample_rate <= s.pluck->start + s.pluck->duration; ++n)
            pluck.push_back(force(*s.pluck, n / settings.sample_rate));
    const Thread thread = s.thread.value_or(Thread{});
    const std::string none = numbers(std::vector<double>(modes.beta.size()));
    Object o;
    o.with("sample_rate", settings.sample_rate).with("tap_rate", settings.tap_rate).with("rows", rows).with("steps_per_row", steps);
    o.with("modes", static_cast<double>(modes.count())).with("contacts", static_cast<double>(contacts.size()));
    o.with("threads", s.thread ? 1.0 : 0.0).with("plucks", s.pluck ? 1.0 : 0.0).with("taps", static_cast<double>(scene.taps.size()));
    o.with("modal_mass", modes.mass).raw("omega0", numbers(modes.omega0)).raw("sigma", numbers(modes.sigma));
    o.raw("start", numbers(initial_displacement(modes, s)));
    o.raw("contact_weights", array(contacts, [&](const LumpedBarrier& b) { return weights(b.position, b.width); }));
    o.raw("contact_stiffness", of([](const LumpedBarrier& b) { return b.stiffness.k; }));
    o.raw("contact_exponent", of([](const LumpedBarrier& b) { return b.exponent; }));
    o.raw("contact_height", of([](const LumpedBarrier& b) { return b.height; }));
    o.raw("thread_weights", s.thread ? weights(thread.position, thread.width) : none);
    o.with("thread_stiffness", thread.stiffness).with("thread_damping", thread.damping).with("thread_height", thread.height);
    o.raw("pluck_weights", s.pluck ? weights(s.pluck->position, s.pluck->width) : none).raw("pluck_force", numbers(pluck));
    o.raw("tap_names", array(scene.taps, [](const Tap& t) { return quote(t.name); }));
    o.raw("tap_quantities", array(scene.taps, [](const Tap& t) { return quote(name_of(t.quantity)); }));
    return o.raw("tap_weights", array(scene.taps, tap)).text();
}

std::string run_text(const Run& r, double making) {
    const auto fact = [](const Fact& f) { return Object().with("name", f.name).with("value", f.value).with("unit", f.unit).text(); };
    return Object()
        .with("outcome", name_of(r.status.outcome))
        .with("step", static_cast<double>(r.status.step))
        .with("steps", static_cast<double>(r.steps))
        .with("rows", static_cast<double>(r.trace.rows))
        .with("rate", r.trace.tap_rate)
        .with("dofs", static_cast<double>(r.dofs))
        .with("wall", r.wall_seconds)
        .with("making", making)
        .raw("taps", array(r.trace.names, [](const std::string& n) { return quote(n); }))
        .raw("facts", array(r.facts, fact))
        .text();
}

}  // namespace jvari::web

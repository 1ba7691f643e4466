#include "web/json.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <variant>
#include <vector>

#include "analysis/alignment.hpp"
#include "analysis/error.hpp"
#include "analysis/judgement.hpp"
#include "analysis/spectrum.hpp"
#include "reference/references.hpp"
#include "scenes/barrier.hpp"
#include "scenes/excitation.hpp"
#include "scenes/pitch.hpp"
#include "scenes/wording.hpp"
#include "schemes/controls.hpp"
#include "schemes/making.hpp"
#include "schemes/open/problem.hpp"
#include "schemes/registry.hpp"

namespace jvari::web {

namespace {
std::string text_of(double x) {  // JSON lacks infinity: a number out of range reads so
    return std::isnan(x) ? "null" : std::isinf(x) ? (x < 0 ? "-1e999" : "1e999") : number_text(x);
}
std::string text_of(const std::string& s) { return quote(s); }
std::string text_of(const char* s) { return quote(s); }
std::string text_of(bool b) { return b ? "true" : "false"; }
std::string text_of(std::int64_t n) { return std::to_string(n); }

template <class List, class Of>
std::string array(const List& list, Of of) {
    std::string inside;
    for (const auto& one : list) inside += (inside.empty() ? "" : ",") + of(one);
    return "[" + inside + "]";
}
std::string text_of(const Matrix& m) {
    const auto row = [&m](std::int64_t r) {
        return array(std::span(m.data + r * m.columns, static_cast<std::size_t>(m.columns)),
                     [](double x) { return text_of(x); });
    };
    if (m.rows < 0) return row(0);
    std::string rows;
    for (std::int64_t r = 0; r < m.rows; ++r) rows += (r ? "," : "") + row(r);
    return "[" + rows + "]";
}
std::string text_of(const Words& w) {
    return array(std::span(w.data, static_cast<std::size_t>(w.count)), quote);
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

std::string scheme_text(const Descriptor& d) {
    const auto option = [](const Option& o) { return Object().with("name", o.name).text(); };
    return Object()
        .with("name", d.name)
        .with("source", d.source)
        .with("control", is_control(d))
        .raw("options", array(d.options, option))
        .text();
}

std::string barrier_text(const Barrier& b, double length) {
    Object o;
    if (const auto* point = std::get_if<LumpedBarrier>(&b))
        return o.with("shape", "lumped")
            .with("position", point->position)
            .with("height", point->height)
            .with("stiffness", point->stiffness.k)
            .with("exponent", point->exponent)
            .text();
    const auto& profile = std::get<ProfileBarrier>(b);
    std::vector<double> x;
    for (int k = 0; k <= 64; ++k)
        x.push_back(profile.from + (std::min(profile.to, length) - profile.from) * k / 64);
    const std::vector<double> h = heights(profile.curve, x);
    if (const auto* parabola = std::get_if<ParabolaCurve>(&profile.curve))
        o.with("coefficient", parabola->coefficient);
    return o.with("shape", "profile")
        .with("from", profile.from)
        .with("to", profile.to)
        .with("stiffness", profile.stiffness.K)
        .raw("x", array(x, [](double v) { return text_of(v); }))
        .raw("height", array(h, [](double v) { return text_of(v); }))
        .text();
}

std::string start_text(const auto& shape) {  // a start from a file or at rest has neither
    Object o;
    if constexpr (requires { shape.position; }) o.with("position", shape.position);
    if constexpr (requires { shape.amplitude; }) o.with("amplitude", shape.amplitude);
    return o.text();
}

std::string string_text(const String& s) {
    Object o;
    o.with("length", s.length)
        .with("linear_density", s.linear_density)
        .with("tension", s.tension)
        .with("bending_stiffness", s.bending_stiffness);
    o.with("pitch", pitch_of(s)).with("note", note_of(pitch_of(s)));
    o.raw("barrier",
          array(s.barriers, [&s](const Barrier& b) { return barrier_text(b, s.length); }));
    o.raw("mass", array(s.masses, [](const Mass& m) {
              return Object().with("position", m.position).with("height", -m.gap).text();
          }));
    if (s.thread)
        o.raw(
            "thread",
            Object().with("position", s.thread->position).with("height", s.thread->height).text());
    if (s.start)
        o.raw("start", std::visit([](const auto& shape) { return start_text(shape); }, *s.start));
    if (s.pluck)
        o.raw("pluck", Object()
                           .with("position", s.pluck->position)
                           .with("amplitude", s.pluck->amplitude)
                           .text());
    return o.text();
}
}  // namespace

std::string list_text() {
    return Object()
        .raw("schemes", array(schemes(), scheme_text))
        .raw("references", array(references(), scheme_text))
        .text();
}

std::string scene_text(const Scene& scene) {
    const Descriptor* reference = best_reference(scene);
    const auto tap = [](const Tap& t) {
        return Object().with("name", t.name).with("quantity", name_of(t.quantity)).text();
    };
    std::vector<std::string> able;
    for (const Descriptor& d : schemes())
        if (represents(d, scene)) able.emplace_back(d.name);
    return Object()
        .with("name", scene.name)
        .with("source", scene.source)
        .with("duration", scene.duration)
        .with("free_from", free_from(scene))
        .raw("string", array(scene.strings, string_text))
        .raw("tap", array(scene.taps, tap))
        .raw("able", array(able, quote))
        .with("reference", reference ? reference->name : "")
        .with("matched", reference && matched(*reference, scene, {}))
        .text();
}

// The string as arrays, for a scheme typed into the page: the same members as for other readers of
// arrays.
std::string problem_text(const Scene& scene, const Settings& settings) {
    refuse_beyond_arrays(scene);
    Object o;
    const Problem problem(scene, settings);
    each_member(problem.arrays(),
                [&o](const char* name, const auto& value) { o.with(name, value); });
    return o.text();
}

std::string run_text(const Run& r, const Scene& scene, int modes, Balance promised) {
    const Figures figures = figures_of(promised, scene, modes, r);
    const auto fact = [](const Fact& f) {
        return Object().with("name", f.name).with("value", f.value).with("unit", f.unit).text();
    };
    return Object()
        .with("outcome", name_of(r.status.outcome))
        .with("step", static_cast<double>(r.status.step))
        .with("rows", static_cast<double>(r.trace.rows))
        .with("rate", r.trace.tap_rate)
        .with("dofs", static_cast<double>(r.dofs))
        .with("modes", static_cast<double>(modes))
        .with("wall", r.wall_seconds)
        .with("residual", figures.energy_residual_accumulated)
        .with("verdict",
              name_of(verdict_of(figures, promised, std::numeric_limits<double>::quiet_NaN())))
        .raw("taps", array(r.trace.names, [](const std::string& n) { return quote(n); }))
        .raw("facts", array(r.facts, fact))
        .text();
}

namespace {
double energy(std::span<const double> x) {
    return std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
}
// Logarithm of the energy in the first half over the energy in the second: 2 sigma times half the
// duration, for a signal that decays by exp(-sigma t).
double fallen(std::span<const double> x) {
    const std::size_t half = x.size() / 2;
    return std::log(energy(x.first(half)) / energy(x.last(half)));
}
}  // namespace

std::string sounds_text(std::span<const double> run, std::span<const double> reference,
                        double rate) {
    constexpr double range = 60;          // [dB]
    constexpr double least_fallen = 0.1;  // less is no decay to compare
    // A transform of many rows is slow where their number has a large prime factor.
    const std::size_t all = std::min(run.size(), reference.size()),
                      rows = all < 256 ? all : all - all % 256;
    run = run.first(rows), reference = reference.first(rows);
    const Bands a = third_octaves(run, rate), b = third_octaves(reference, rate);
    const double floor = *std::max_element(b.level.begin(), b.level.end()) - range;
    std::vector<std::size_t> counted;
    for (std::size_t k = 0; k < b.level.size(); ++k)
        if (b.level[k] > floor) counted.push_back(k);
    const auto band = [&](std::size_t k) {
        return "[" + text_of(b.centre[k]) + "," +
               text_of(std::max(a.level[k], floor) - b.level[k]) + "]";
    };
    const Alignment found = stretched(run, reference, 0);
    const double decay = fallen(reference);
    return Object()
        .raw("bands", array(counted, band))
        .with("louder", 10 * std::log10(energy(run) / energy(reference)))
        .with("octaves", third_octave_difference(run, reference, rate, {.range = range}))
        .with("decay", decay > least_fallen ? fallen(run) / decay - 1 : nan)
        .with("cents", 1200 * std::log2(1 + found.stretch))
        .with("left", found.left)
        .with("apart", relative_l2(run, reference, rate))
        .text();
}

std::string choice_text(const Choice& c) {
    const auto place = [](std::size_t k) { return std::to_string(k); };
    return Object()
        .raw("best", c.best ? place(*c.best) : "null")
        .raw("ties", array(c.ties, place))
        .raw("perhaps", array(c.perhaps, place))
        .text();
}

}  // namespace jvari::web

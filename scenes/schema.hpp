// Schema for scene files: every part's keys in writing order, each with its unit, its range and its
// default. Four passes use the schema: naming the keys, reading, writing, and checking ranges.
// validate.cpp checks rules that involve several values, for example a bridge beyond the string's
// end.
//
// A pass has number, stiffness (a number or "rigid"), count, text, optional_text, file (beside the
// scene), choice, string_index, refused (a key without meaning here), columns (a CSV file), modes
// (columns with numbered rows), one_of (a variant and its choosing key), material (with a diameter,
// in place of two numbers), rebound (a restitution, in place of a contact loss), tension (or a
// pitch), concert_pitch (A4 of those), start ("rest" or a CSV file, in place of a table),
// start_table (its columns), force (a file), part (a table) and parts (an array of tables).
#pragma once

#include <concepts>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "scenes/scene.hpp"

namespace jvari {

template <class T, class Part>
concept Is = std::same_as<std::remove_const_t<T>, Part>;

struct Range {
    const char* says;
    double low = -std::numeric_limits<double>::infinity(),
           high = std::numeric_limits<double>::infinity();
    bool without_low = false;
    bool holds(double x) const {
        return x - x == 0 && x >= low && x <= high && !(without_low && x == low);
    }  // x - x: neither nan nor infinite
};
inline constexpr Range any{"a finite number"};
inline constexpr Range positive{"a positive number", 0, std::numeric_limits<double>::infinity(),
                                true};
inline constexpr Range positive_or_rigid{"\"rigid\" or a positive number", 0,
                                         std::numeric_limits<double>::infinity(), true};
inline constexpr Range not_negative{"a number >= 0", 0};
inline constexpr Range one_or_more{"a number >= 1", 1};
inline constexpr Range fraction{"a number above 0 and at most 1", 0, 1, true};

// Column with another name and unit: a cell's number in SI units, perhaps by the number in the
// first column of its row.
struct Spelling {
    const char* name;
    double (*in_si)(double x, double first);
};
struct Column {  // column in a CSV file
    const char* name;
    const char* alias;
    Range range;
    std::span<const Spelling> others = {};
};
inline constexpr Spelling
    hertz_spellings[] = {{"f_hz", [](double f, double) { return f; }},
                         {"frequency_khz", [](double f, double) { return 1000 * f; }},
                         {"f_khz", [](double f, double) { return 1000 * f; }}},
    // T60 = 3 ln(10)/sigma, sigma = pi f/Q = 2 pi f zeta; first: f
    decay_spellings[] = {{"t60_s", [](double t, double) { return 3 * std::numbers::ln10 / t; }},
                         {"tau_s", [](double t, double) { return 1 / t; }},
                         {"q", [](double q, double f) { return std::numbers::pi * f / q; }},
                         {"zeta",
                          [](double zeta, double f) { return 2 * std::numbers::pi * f * zeta; }}},
    x_spellings[] = {{"x_mm", [](double x, double) { return x / 1000; }}},
    height_spellings[] = {{"height_mm", [](double h, double) { return h / 1000; }}},
    displacement_spellings[] = {{"displacement_mm", [](double y, double) { return y / 1000; }}};

inline constexpr const char* quantity_names[] = {"displacement", "velocity",     "nut_force",
                                                 "bridge_force", "thread_force", "driving_force"};
inline constexpr const char* damping_names[] = {"none", "polynomial", "quality_factor", "table",
                                                "per_period"};
inline constexpr const char* barrier_names[] = {"lumped", "profile"};
inline constexpr const char* loss_law_names[] = {"hunt_crossley", "clipped"};
inline constexpr const char* side_names[] = {"below", "above"};
inline constexpr const char* pluck_names[] = {"pull", "blow"};
inline constexpr const char* curve_names[] = {"flat", "line", "parabola", "table"};
inline constexpr const char* shape_names[] = {"mode", "triangle"};

// Walks through all tables and does nothing else. Self derives from Pass and replaces the functions
// for the keys that it handles; `seen` receives every other key.
template <class Self>
struct Pass {
    std::string path{};  // path to the current table: "string.0.barrier.1"

    Self& self() { return static_cast<Self&>(*this); }
    std::string at(const std::string& key) const { return path.empty() ? key : path + "." + key; }
    void seen(const char*) {}

    void number(const char* key, auto&&...) { self().seen(key); }
    void stiffness(const char* key, auto&&...) { self().seen(key); }
    void count(const char* key, auto&) { self().seen(key); }
    void text(const char* key, auto&) { self().seen(key); }
    void optional_text(const char* key, auto&) { self().seen(key); }
    void file(const char* key, auto&) { self().seen(key); }
    void choice(const char* key, auto&&...) { self().seen(key); }
    void string_index(const char* key, auto&) { self().seen(key); }
    void refused(const char* key, const char*) { self().seen(key); }
    void columns(const char* key, auto&&...) { self().seen(key); }
    void modes(const char* key, auto& t, const Column& frequency, const Column& decay) {
        self().columns(key, t.file, frequency, t.frequency_hz, decay, t.decay_rate);
    }
    void start(const char* key, auto&) { self().seen(key); }
    void force(const char* key, auto&) { self().seen(key); }
    void material() {}
    void rebound() {}
    void tension(auto&) {}
    void concert_pitch() {}
    void start_table(auto&) {}
    void one_of(const char*, auto& variant, auto&&...) {
        std::visit([this](auto& alternative) { fields(self(), alternative); }, variant);
    }
    template <class Part>
    void part(const char* key, Part& p) {
        if constexpr (requires { p.has_value(); }) {
            if (p) part(key, *p);
        } else {
            const std::string outside = std::exchange(path, at(key));
            fields(self(), p);
            path = outside;
        }
    }
    void parts(const char* key, auto& all) {
        for (std::size_t i = 0; i < all.size(); ++i)
            part((key + ("." + std::to_string(i))).c_str(), all[i]);
    }
};

// ---- Losses

void fields(auto&, Is<NoDamping> auto&) {}
void fields(auto& pass, Is<PolynomialDamping> auto& d) {
    pass.number("sigma0", d.sigma0, not_negative, "1/s", 0.0);
    pass.number("sigma1", d.sigma1, not_negative, "m/s", 0.0);
    pass.number("sigma3", d.sigma3, not_negative, "m^3/s", 0.0);
}
void fields(auto& pass, Is<QualityFactorDamping> auto& d) {
    pass.number("diameter", d.diameter, positive, "m");
    pass.number("air_viscosity", d.air_viscosity, not_negative, "kg/(m s)");
    pass.number("air_density", d.air_density, not_negative, "kg/m^3");
    pass.number("viscoelastic_angle", d.viscoelastic_angle, not_negative, "rad");
    pass.number("thermoelastic_loss", d.thermoelastic_loss, not_negative, "");
}
void fields(auto& pass, Is<TableDamping> auto& d) {
    pass.modes("file", d, Column{"frequency_hz", "frequency_hz", positive, hertz_spellings},
               Column{"decay_rate_per_s", "sigma_per_s", not_negative, decay_spellings});
}
void fields(auto& pass, Is<PerPeriodDamping> auto& d) {
    pass.number("factor", d.factor, fraction, "");
}
void fields(auto& pass, Is<Damping> auto& d) { pass.one_of("law", d, damping_names); }

// ---- The obstacle

void fields(auto&, Is<FlatCurve> auto&) {}
void fields(auto& pass, Is<LineCurve> auto& c) {
    pass.number("coefficient", c.coefficient, any, "");
}
void fields(auto& pass, Is<ParabolaCurve> auto& c) {
    pass.number("coefficient", c.coefficient, any, "1/m");
}
void fields(auto& pass, Is<TableCurve> auto& c) {
    pass.columns("file", c.file, Column{"x_m", "x_m", any, x_spellings}, c.x,
                 Column{"height_m", "height_m", any, height_spellings}, c.height);
}
void law_of_contact(auto& pass, auto& contact) {
    pass.number("exponent", contact.exponent, one_or_more, "", 1.0);
    pass.rebound();
    pass.number("contact_loss", contact.contact_loss, not_negative, "s/m", 0.0);
    pass.choice("loss_law", contact.loss_law, loss_law_names, LossLaw::hunt_crossley);
}
void fields(auto& pass, Is<LumpedBarrier> auto& b) {
    pass.number("position", b.position, any, "m");
    pass.number("width", b.width, not_negative, "m", 0.0);
    pass.number("height", b.height, any, "m", 0.0);
    pass.stiffness("stiffness", b.stiffness.k, "N/m^exponent");
    law_of_contact(pass, b);
    pass.choice("side", b.side, side_names, Side::below);
}
void fields(auto& pass, Is<ProfileBarrier> auto& b) {
    pass.one_of("curve", b.curve, curve_names);
    pass.number("from", b.from, any, "m");
    pass.number("to", b.to, any, "m");
    pass.stiffness("stiffness_density", b.stiffness.K, "N/m^(exponent+1)");
    law_of_contact(pass, b);
}
void fields(auto& pass, Is<Barrier> auto& b) { pass.one_of("shape", b, barrier_names); }

void fields(auto& pass, Is<Thread> auto& t) {
    pass.number("position", t.position, any, "m");
    pass.number("width", t.width, not_negative, "m", 0.0);
    pass.number("stiffness", t.stiffness, not_negative, "N/m");
    pass.number("damping", t.damping, not_negative, "kg/s", 0.0);
    pass.number("height", t.height, any, "m", 0.0);
}

void fields(auto& pass, Is<Mass> auto& m) {
    pass.number("mass", m.mass, positive, "kg");
    pass.number("position", m.position, any, "m");
    pass.number("width", m.width, not_negative, "m", 0.0);
    pass.number("velocity", m.velocity, any, "m/s", 0.0);
    pass.number("gap", m.gap, any, "m", 0.0);
    pass.number("stiffness", m.stiffness, positive, "N/m^exponent");
    law_of_contact(pass, m);
    pass.number("spring", m.spring, not_negative, "N/m", 0.0);
    pass.number("damping", m.damping, not_negative, "kg/s", 0.0);
    pass.number("weight", m.weight, not_negative, "N", 0.0);
}

// ---- Initial shape and excitation

void fields(auto& pass, Is<ModeShape> auto& m) {
    pass.count("number", m.number);
    pass.number("amplitude", m.amplitude, any, "m or m/s");
}
void fields(auto& pass, Is<TriangleShape> auto& t) {
    pass.number("position", t.position, any, "m");
    pass.number("amplitude", t.amplitude, any, "m or m/s");
    pass.number("smoothing", t.smoothing, not_negative, "m", 0.0);
}
void fields(auto& pass, Is<TableStart> auto& t) { pass.start_table(t); }
void fields(auto&, Is<RestStart> auto&) {}
void fields(auto& pass, Is<Shape> auto& s) { pass.one_of("shape", s, shape_names); }
void fields(auto& pass, Is<Start> auto& s) { pass.one_of("shape", s, shape_names); }

void fields(auto& pass, Is<Pluck> auto& p) {
    pass.force("file", p);
    if (p.file.empty()) {
        pass.number("amplitude", p.amplitude, any, "N");
        pass.number("duration", p.duration, positive, "s");
        pass.number("skew", p.skew, not_negative, "", 0.0);
        pass.number("start", p.start, not_negative, "s", 0.0);
    } else {
        pass.number("amplitude", p.amplitude, any, "N", p.peak);
        for (const char* key : {"duration", "skew", "start"})
            pass.refused(key, "nothing beside file, which says as much");
    }
    pass.number("position", p.position, any, "m");
    pass.number("width", p.width, not_negative, "m", 0.0);
    pass.choice("kind", p.kind, pluck_names, PluckKind::pull);
}
void fields(auto& pass, Is<Polarisation> auto& p) {
    pass.number("rotation", p.rotation, any, "rad");
    pass.number("pluck_angle", p.pluck_angle, any, "rad", 0.0);
}

void fields(auto& pass, Is<String> auto& s) {
    pass.number("length", s.length, positive, "m");
    pass.material();
    pass.number("linear_density", s.linear_density, positive, "kg/m");
    pass.tension(s);
    pass.number("bending_stiffness", s.bending_stiffness, not_negative, "N m^2", 0.0);
    pass.number("axial_stiffness", s.axial_stiffness, not_negative, "N", 0.0);
    pass.start("start", s.start);
    pass.part("damping", s.damping);
    pass.parts("barrier", s.barriers);
    pass.part("thread", s.thread);
    pass.parts("mass", s.masses);
    pass.part("start", s.start);
    pass.part("velocity", s.velocity);
    pass.part("pluck", s.pluck);
    pass.part("polarisation", s.polarisation);
}

// ---- Taps

constexpr bool has_position(Quantity q) {
    return q == Quantity::displacement || q == Quantity::velocity;
}

void fields(auto& pass, Is<Tap> auto& t) {
    pass.text("name", t.name);
    pass.choice("quantity", t.quantity, quantity_names);
    pass.string_index("string", t.string);
    pass.string_index("mass", t.mass);
    if (has_position(t.quantity) && !t.mass) pass.number("position", t.position, any, "m");
    else
        pass.refused("position", t.mass ? "no position beside mass, which is where it is"
                                        : "no position, which only displacement and velocity have");
}
void fields(auto& pass, Is<BodyMode> auto& m) {
    pass.number("mass", m.mass, positive, "kg");
    pass.number("stiffness", m.stiffness, positive, "N/m");
    pass.number("damping", m.damping, not_negative, "kg/s", 0.0);
}
void fields(auto& pass, Is<Body> auto& b) {
    pass.file("bridge", b.bridge);
    pass.file("nut", b.nut);
    pass.parts("mode", b.modes);
}
void fields(auto& pass, Is<Scene> auto& s) {
    pass.text("name", s.name);
    pass.optional_text("source", s.source);
    pass.number("duration", s.duration, positive, "s");
    pass.concert_pitch();
    pass.parts("string", s.strings);
    pass.parts("tap", s.taps);
    pass.part("body", s.body);
}

}  // namespace jvari

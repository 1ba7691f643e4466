// jvari new: writes a scene to begin with, from a library scene with comments. Further keys of
// scene files follow below as comments. Never overwrites a file.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"
#include "scenes/columns.hpp"
#include "scenes/material.hpp"
#include "scenes/pitch.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::command {

namespace {
namespace fs = std::filesystem;

struct NewRequest : Common {
    std::string instrument, name, material;
    double diameter = 0;  // [m]; 0: the library's string
};

struct Template {
    const char *instrument, *scene;
};
constexpr Template templates[] = {{"guitar", "guitar_over_fret"},
                                  {"tanpura", "tanpura_c3_release"},
                                  {"sitar", "sitar_parabola"},
                                  {"bass", "slap_bass"},
                                  {"piano", "prepared_piano"}};

constexpr const char* what_else = R"(
# ---- What a scene can say
#
# SI units throughout. x runs along the string from 0 to `length`. Its displacement y is positive
# away from the barrier, so what pushes or plucks it towards the barrier is negative. A barrier
# below the string at rest has a negative `height`. A string with neither `start` nor `pluck` is
# silent, unless a barrier presses on it.
#
# The barrier pushes with stiffness * penetration^exponent. A lumped one acts at one place (over
# `width`), a profile along `from` to `to`:
#   shape = "profile", curve = "flat" (height 0), "line" (coefficient x),
#                              "parabola" (-coefficient x^2) or "table" (a file)
#
# A string's mass and stiffness are `linear_density` and `bending_stiffness`, or `material` and
# `diameter` of a plain wire: "steel", "nickel", "brass", "bronze", "phosphor bronze", "nylon",
# "fluorocarbon", "gut". Its pitch is a `tension`, a `frequency` or a `note` ("E2",
# "A2 -14c"; `A4 = 415` above all tables tunes the notes to 415 Hz).
#
# Losses: the amplitude of a mode falls as exp(-sigma t). Its wavenumber is b, its frequency f [Hz].
#   law = "none"            sigma = 0
#   law = "polynomial"      sigma = sigma0 + sigma1 b + sigma3 b^3
#   law = "quality_factor"  sigma = pi f / Q, 1/Q = the losses by air, viscoelasticity and heat
#   law = "per_period"      sigma = -f1 ln(factor), f1 the frequency of the first mode: all alike
#   law = "table"           sigma and f of each mode from a file
#
# Taps: what is recorded and compared. `string` counts from 0; a force without it is the sum over
# strings.
#   quantity = "displacement", "velocity"   of the string at `position`
#   quantity = "nut_force"      of the string on its end at x = length, whatever that is on your
#                               instrument: errors are of the first such tap
#   quantity = "bridge_force"   of the barriers on the string, the mean between two rows
#   quantity = "thread_force"   of the thread on the string, the same
#   quantity = "driving_force"  -(bridge_force + thread_force)
#
# A hammer or a bolt is a [[string.mass]]: `mass`, `position`, `stiffness` of its felt, `gap` below
# the string, `velocity` towards it. `weight` presses a ring against the string, `spring` and
# `damping` join a rattling foot to the ground. A tap with `mass = 0` hears it.
#
# A lumped barrier with side = "above" pushes the string down. `restitution` and `impact_speed`
# [m/s] may stand in place of its `contact_loss`.
#
# Start: [string.start] is a shape that is let go, [string.velocity] the same of its velocity,
# [string.pluck] the force of a finger or hammer.
#   shape = "mode" (number, amplitude)
#   shape = "triangle" (position, amplitude, smoothing: 0 is a sharp corner)
#   start = "rest"      under [[string]]: the string lies still on what presses it
#   start = "file.csv"  columns x_m or mode, displacement_m, velocity_m_per_s
#
# Try it:   jvari run @FILE@ --scheme modal_two_point --out @NAME@.wav
# Compare:  jvari compare @FILE@ --duration 0.1 --out @NAME@-report
)";

std::vector<std::string> instruments() {
    std::vector<std::string> names;
    for (const Template& t : templates) names.emplace_back(t.instrument);
    names.emplace_back("body");
    return names;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

// Renames the library's text and removes its source: a paper on the library's string says nothing
// about this string.
std::string renamed(std::string text, const std::string& name) {
    const auto replace_line = [&text](const char* begin, const std::string& by) {
        if (const auto at = text.find(begin); at != std::string::npos)
            text.replace(at, text.find('\n', at + 1) - at, by);
    };
    replace_line("\nname = ", fmt::format("\nname = \"{}\"", name));
    replace_line("\nsource = ", "");
    return text;
}

// Lines with mass and stiffness for the requested string. It is either a plain wire made from a
// material, or a string from a commercial series; such a string is as stiff as its core.
std::string of_that_string(const NewRequest& r) {
    constexpr const char* instead = "in place of the string that is described above";
    std::vector<std::string> known(std::begin(material_names), std::end(material_names));
    if (std::find(known.begin(), known.end(), r.material) != known.end())
        return fmt::format("material = \"{}\"  # a plain wire, {}\ndiameter = {}  # m", r.material,
                           instead, r.diameter);
    const std::vector<SoldString> sold = sold_strings();
    const auto in_series = [&r](const SoldString& s) { return s.series == r.material; };
    if (std::none_of(sold.begin(), sold.end(), in_series)) {
        for (const SoldString& s : sold)
            if (known.back() != s.series) known.push_back(s.series);
        throw store::UsageError(store::unknown("material", r.material, known));
    }
    const SoldString s = sold_string(sold, r.material, r.diameter);
    return fmt::format(
        "# {} {}, {} in, by gauges.csv: {}\nlinear_density = {:.5g}  # kg/m\n"
        "bending_stiffness = {:.5g}  # N m^2: {}",
        s.maker, s.series, s.gauge, instead, s.linear_density,
        s.core ? bending_stiffness_of(materials[0], *s.core) : 0,
        s.core ? fmt::format("E pi/64 d^4 of its steel core, d = {} m", *s.core)
               : "none is assumed, for its core is not known. A steel core of d m has 9.82e9 d^4");
}

// Refuses a gauge in inches without its unit, and warns of a plain wire as thick as a wound string.
void note_gauge(const NewRequest& r, const Console& console) {
    constexpr double inch = 0.0254, thickest = 0.01;  // [m]
    if (r.diameter > thickest)
        throw store::UsageError(
            fmt::format("new: found --diameter {:g}, which is {:g} mm, expected at most 10 mm; a "
                        "gauge in inches is written {:g}in",
                        r.diameter, 1e3 * r.diameter, r.diameter));
    if (std::find(std::begin(material_names), std::end(material_names), r.material) ==
        std::end(material_names))
        return;
    for (const SoldString& s : sold_strings()) {
        const bool wound = s.series.find(r.material) != std::string::npos &&
                           s.series.find("wound") != std::string::npos;
        if (!wound || r.diameter < s.gauge * inch * (1 - 1e-9)) continue;
        console.warn(fmt::format(
            "{:.4g} in of {} is a solid wire, {:.3g} kg/m; strings of that "
            "gauge are sold wound: --material \"{}\"",
            r.diameter / inch, r.material,
            linear_density_of(materials[std::find(std::begin(material_names),
                                                  std::end(material_names), r.material) -
                                        std::begin(material_names)],
                              r.diameter),
            s.series));
        return;
    }
}

// Replaces each string of the scene by the requested string at the same pitch.
std::string strung(const std::string& text, const Scene& scene, const NewRequest& r) {
    std::istringstream lines(text);
    std::string strung;
    std::size_t strings = 0;
    bool of_string = false;  // in the table [[string]] itself, not in a table below
    for (std::string line; std::getline(lines, line);) {
        const auto is = [&](const char* key) {
            return of_string && line.starts_with(std::string(key) + " = ");
        };
        if (line.starts_with("[")) of_string = line.starts_with("[[string]]"), strings += of_string;
        if (is("bending_stiffness")) continue;
        if (is("linear_density")) line = of_that_string(r);
        if (is("tension"))
            line = fmt::format("frequency = {:.6g}  # Hz, as of that string",
                               pitch_of(scene.strings[strings - 1]));
        strung += line + "\n";
    }
    return strung;
}

void must_be_free(const fs::path& file) {
    std::error_code error;
    if (fs::exists(file, error))
        throw store::UsageError(
            fmt::format("{} is there already; choose another name", file.string()));
    store::must_be_writable(file);
}

int new_body(const std::string& name, const Console& console) {
    const fs::path bridge = name + "_bridge.wav", nut = name + "_nut.wav";
    must_be_free(bridge);
    must_be_free(nut);
    const Body body = read_scene("tanpura_drone").body.value();  // the library's synthetic pair
    store::write_fresh(bridge, store::read_whole(body.bridge));
    store::write_fresh(nut, store::read_whole(body.nut));
    console.print(
        fmt::format("written: {} and {}, synthetic: no instrument has them. In a scene beside "
                    "them:\n\n[body]\nbridge = \"{}\"\nnut = \"{}\"",
                    bridge.string(), nut.string(), bridge.string(), nut.string()));
    console.print_json(
        store::indented({{"status", "ok"}, {"bridge", bridge.string()}, {"nut", nut.string()}}));
    return exit_code::done;
}

int new_command(NewRequest r) {
    const Console console(r.json, r.quiet);
    const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
    if (r.name.empty() || r.name.front() == '-' ||
        !std::all_of(r.name.begin(), r.name.end(), plain))
        throw store::UsageError(
            fmt::format("new: found the name {}, expected letters, digits, _ and -, the first of "
                        "them no -: it becomes NAME.toml here",
                        found_text(r.name)));
    if (r.material.empty() != (r.diameter == 0) || (r.instrument == "body" && r.diameter > 0))
        throw store::UsageError(
            "new: --material and --diameter go together, and with an instrument; expected both of "
            "them or none");
    if (r.instrument == "body") return new_body(r.name, console);
    const Template* chosen =
        std::find_if(std::begin(templates), std::end(templates),
                     [&r](const Template& t) { return r.instrument == t.instrument; });
    if (chosen == std::end(templates))
        throw store::UsageError(store::unknown("instrument", r.instrument, instruments()));
    const fs::path file = r.name + ".toml";
    must_be_free(file);
    const std::string end =
        replaced(replaced(what_else, "@FILE@", file.string()), "@NAME@", r.name);
    std::string text = renamed(library_text(chosen->scene + std::string(".toml")), r.name) + end;
    if (r.diameter > 0) note_gauge(r, console);
    if (r.diameter > 0) text = strung(text, parse_scene(text, file.string()), r);
    const Scene scene = parse_scene(text, file.string());
    store::write_fresh(file, text);
    for (const String& string : scene.strings)
        console.print("string: " + compare::tuning_text(string));
    console.print(fmt::format(
        "written: {}, after the library's {}; it says what each key means, and what to try",
        file.string(), chosen->scene));
    console.print_json(
        store::indented({{"status", "ok"}, {"file", file.string()}, {"after", chosen->scene}}));
    return exit_code::done;
}
}  // namespace

Act new_verb(CLI::App& program) {
    Verb<NewRequest> v(program, "new", "a commented scene to begin with: writes NAME.toml here");
    v.option("instrument", v.r.instrument, {"INSTRUMENT"},
             "guitar, tanpura, sitar, bass or piano; or body: a made-up pair of responses")
        ->required();
    v.option("name", v.r.name, {"NAME"}, "of the scene and, with .toml, of its file")->required();
    const std::vector<std::string> materials(std::begin(material_names), std::end(material_names));
    v.option("--material", v.r.material, {"MATERIAL"},
             fmt::format("its strings are plain wires of it, at the same pitch: {}; or as they are "
                         "sold: a series of gauges.csv, as \"nickel wound\"",
                         fmt::join(materials, ", ")));
    v.option("--diameter", v.r.diameter, metres, "of these strings, as 0.7mm, 0.046in or .046\"");
    return v.does(new_command, "Example: jvari new guitar my_guitar");
}

}  // namespace jvari::bench::command

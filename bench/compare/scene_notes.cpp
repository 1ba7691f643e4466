#include "bench/compare/scene_notes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "scenes/barrier.hpp"
#include "scenes/pitch.hpp"
#include "scenes/start.hpp"

namespace jvari::bench::compare {

namespace {
// of an instrument's string, from a piano's highest to its lowest [m]
constexpr double least_length = 0.03, most_length = 4;
constexpr double least_pitch = 10, most_pitch = 1e4;  // [Hz]
// of the length: beyond, the equations of small motion do not hold
constexpr double most_start = 0.1;
constexpr double most_stiffness = 1e13;  // [N/m^exponent], a thousand times the stiffest in use

bool plucked(const String& s) { return s.pluck && s.pluck->amplitude != 0; }
bool pressed(const String& s) {  // at rest something above or below it pushes or pulls
    const auto above = [](const LumpedBarrier& b) { return b.height > 0; };
    const auto somewhere = [](const ProfileBarrier& b) {
        const auto* table = std::get_if<TableCurve>(&b.curve);
        const auto is_above = [&](double x) { return height(b.curve, x) > 0; };
        return is_above(b.from) || is_above(b.to) ||
               (table && std::ranges::any_of(table->height, [](double h) { return h > 0; }));
    };
    return (s.thread && s.thread->height != 0) ||
           std::ranges::any_of(s.barriers, [&](const Barrier& b) {
               const auto* lumped = std::get_if<LumpedBarrier>(&b);
               return lumped ? above(*lumped) : somewhere(std::get<ProfileBarrier>(b));
           });
}
bool set_in_motion(const String& s, double before) {
    const bool table = s.start && std::holds_alternative<TableStart>(*s.start);
    return largest_displacement(s) != 0 || table || s.velocity || pressed(s) ||
           std::ranges::any_of(s.masses,
                               [](const Mass& m) { return m.velocity > 0 || m.gap < 0; }) ||
           (plucked(s) && s.pluck->start < before);
}
}  // namespace

std::string tuning_text(const String& s) {
    const double f1 = pitch_of(s);
    const std::string note = note_of(f1);
    return fmt::format("f1 = {:.4g} Hz{}, tension {:.3g} N, inharmonicity {:.2g}", f1,
                       note.empty() ? "" : " (" + note + ")", s.tension, inharmonicity(s));
}

std::string untouched_text(const Scene& scene, const Figures& run) {
    const bool any =
        std::ranges::any_of(scene.strings, [](const String& s) { return s.has_contacts(); });
    if (!any || run.largest_contact_force != 0 || run.deepest_penetration > 0) return "";
    return fmt::format(
        "no string of {} touches a barrier or a mass in {:g} s, so no contact is in this run. Are "
        "height [m], position and the side of the start as meant?",
        scene.name, scene.duration);
}

void note_scene(const Scene& scene, const store::Listener& listener) {
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        const auto doubt = [&](bool doubtful, const char* key, double value, const char* unit,
                               const char* usual) {
            if (doubtful)
                listener.note(
                    fmt::format("warning: string {}: {} = {:g} {}; expected {}. Is the unit right?",
                                i, key, value, unit, usual));
        };
        doubt(s.length < least_length || s.length > most_length, "length", s.length, "m",
              "0.03 to 4 m");
        doubt(pitch_of(s) < least_pitch || pitch_of(s) > most_pitch,
              "the pitch that length, tension and linear_density give", pitch_of(s), "Hz",
              "10 to 10000 Hz");
        const double start = largest_displacement(s);
        doubt(start > most_start * s.length, "start.amplitude", start, "m",
              "less than a tenth of the length");
        for (const Barrier& b : s.barriers)
            if (const auto* lumped = std::get_if<LumpedBarrier>(&b)) {
                doubt(std::abs(lumped->height) > most_start * s.length, "barrier.height",
                      lumped->height, "m", "less than a tenth of the length");
                const double k = lumped->stiffness.k;
                doubt(std::isfinite(k) && k > most_stiffness, "barrier.stiffness", k,
                      "N/m^exponent", "at most 1e13, or \"rigid\"");
            }
        doubt(plucked(s) && std::abs(s.pluck->amplitude) > s.tension, "pluck.amplitude",
              plucked(s) ? s.pluck->amplitude : 0, "N", "less than the tension");
    }
    const auto moves = [&](const String& s) { return set_in_motion(s, scene.duration); };
    // one shakes the others
    if (scene.body && !scene.body->modes.empty() && std::ranges::any_of(scene.strings, moves))
        return;
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        if (moves(s)) continue;
        const std::string why =
            plucked(s) ? fmt::format("its pluck begins at {:g} s, and the run ends at {:g} s",
                                     s.pluck->start, scene.duration)
                       : "nothing sets it in motion; give it [string.start] or [string.pluck]";
        listener.note(fmt::format("warning: string {} of {} stays silent: {}", i, scene.name, why));
    }
}

}  // namespace jvari::bench::compare

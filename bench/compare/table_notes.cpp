// Notes on the tables in a scene, and on the modes that a run takes from them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bench/compare/scene_notes.hpp"
#include "scenes/modes.hpp"
#include "scenes/pitch.hpp"
#include "schemes/grid/finite_difference.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::compare {

namespace {
// Tolerated deviation of a table's first mode from the tuned pitch, a share: losses or a worn
// string can cause this much.
constexpr double out_of_tune = 0.05;
constexpr double much_longer = 10;  // duration of a force over its run

const TableStart* table_of(const String& s) {
    return s.start ? std::get_if<TableStart>(&*s.start) : nullptr;
}
}  // namespace

void note_tables(const Scene& scene, const store::Listener& listener) {
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        const auto warn = [&](const std::string& what) {
            listener.warn(fmt::format("string {}: {}", i, what));
        };
        if (const auto* t = std::get_if<TableDamping>(&s.damping)) {
            if (!t->filled.empty())
                warn(
                    fmt::format("{} has no row of mode {}: frequency and decay rate are taken "
                                "between those of the neighbours",
                                t->file, fmt::join(t->filled, ", ")));
            if (std::abs(pitch_of(s) / tuned_pitch(s) - 1) > out_of_tune)
                warn(
                    fmt::format("the first mode of {} is at {:.4g} Hz, and length, tension and "
                                "linear_density give {:.4g} Hz. Is frequency_hz in Hz, and its "
                                "first row mode 1?",
                                t->file, pitch_of(s), tuned_pitch(s)));
        }
        if (const auto* t = table_of(s); t && !t->state_of.empty() && t->state_of != scene.name)
            warn(fmt::format("{} is a state of {}, and this scene is {}", t->file, t->state_of,
                             scene.name));
        if (const auto& p = s.pluck;
            p && !p->file.empty() && p->duration > much_longer * scene.duration)
            warn(fmt::format("the force of {} lasts {:g} s, and the run {:g} s. Is time_s in s?",
                             p->file, p->duration, scene.duration));
    }
}

bool has_own_grid(const Descriptor& d) { return declares(d, grid_option.name); }

std::string grid_text(const Descriptor& d, const std::string& modes) {
    return fmt::format(
        "{}: its grid follows from the rate, and modes = {} is left aside; option "
        "grid sets the intervals, one more than the nodes",
        d.name, modes);
}

void note_modes(const Descriptor& d, const Scene& scene, const Settings& settings,
                const store::Listener& listener) {
    if (has_own_grid(d)) {
        if (settings.modes > 0) listener.note(grid_text(d, std::to_string(settings.modes)));
        return;
    }
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const TableStart* t = table_of(scene.strings[i]);
        if (!t || !t->of_modes) continue;
        const int carried = modes_for(scene.strings[i], settings);
        double last = 0;
        for (std::size_t k = 0; k < t->at.size(); ++k)
            if (t->displacement[k] != 0 || t->velocity[k] != 0) last = t->at[k];
        if (last > carried)
            listener.warn(
                fmt::format("string {}: {} moves modes up to {:g}, and this run "
                            "has {}: what the others hold is left out. --modes {:g} "
                            "takes all",
                            i, t->file, last, carried, last));
    }
}

}  // namespace jvari::bench::compare

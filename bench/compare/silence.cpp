#include "bench/compare/silence.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <variant>

namespace jvari::bench::compare {

namespace {
bool plucked(const String& s) {
    return s.pluck && s.pluck->amplitude != 0;
}
bool set_in_motion(const String& s, double before) {
    const bool shaped = s.initial && std::visit([](const auto& shape) { return shape.amplitude != 0; }, *s.initial);
    return shaped || (plucked(s) && s.pluck->start < before);
}
}  // namespace

void note_silent_strings(const Scene& scene, const store::Listener& listener) {
    const auto moves = [&](const String& s) { return set_in_motion(s, scene.duration); };
    if (scene.body && !scene.body->modes.empty() && std::ranges::any_of(scene.strings, moves)) return;  // one shakes the others
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        if (moves(s)) continue;
        const std::string why = plucked(s)
                                    ? fmt::format("its pluck begins at {:g} s, and the run ends at {:g} s", s.pluck->start, scene.duration)
                                    : "nothing sets it in motion; give it [string.initial] or [string.pluck]";
        listener.note(fmt::format("warning: string {} of {} stays silent: {}", i, scene.name, why));
    }
}

}  // namespace jvari::bench::compare

#include "bench/compare/silence.hpp"

#include <fmt/core.h>

#include <variant>

namespace jvari::bench::compare {

void note_silent_strings(const Scene& scene, const store::Listener& listener) {
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        const bool shaped = s.initial && std::visit([](const auto& shape) { return shape.amplitude != 0; }, *s.initial);
        const bool plucked = s.pluck && s.pluck->amplitude != 0;
        if (shaped || (plucked && s.pluck->start < scene.duration)) continue;
        const std::string why = plucked
                                    ? fmt::format("its pluck begins at {:g} s, and the run ends at {:g} s", s.pluck->start, scene.duration)
                                    : "nothing sets it in motion; give it [string.initial] or [string.pluck]";
        listener.note(fmt::format("warning: string {} of {} stays silent: {}", i, scene.name, why));
    }
}

}  // namespace jvari::bench::compare

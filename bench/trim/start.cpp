#include "bench/trim/start.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace jvari::bench::trim {

namespace {
constexpr double sizes[starts] = {1, 0.8, 0.7, 0.9, 0.6};
constexpr double places[starts] = {0, 0.88, 0.31, 0.42, 0.67};  // of the string's length
constexpr double plectrum = 0.01;  // of the string's length: what rounds the sharpest corner, which has modes without end otherwise
constexpr double shortest[starts] = {1, 0.5, 0.7, 0.9, 0.6};  // of the time that a pluck takes

// At the start's place, or as far from the other end where that is where it was.
double elsewhere(double position, double length, int start) {
    const double there = places[start] * length;
    return std::abs(there - position) < 0.05 * length ? length - there : there;
}

Initial initial(const Initial& own, double length, int start) {
    const auto* mode = std::get_if<ModeInitial>(&own);
    const auto* triangle = std::get_if<TriangleInitial>(&own);
    const double amplitude = sizes[start] * (mode ? mode->amplitude : triangle->amplitude);
    if (start == 2) return ModeInitial{mode ? mode->number + 4 : 5, amplitude};
    const double position = elsewhere(triangle ? triangle->position : 0, length, start);
    const double sharp = plectrum * length, smoothing = triangle ? triangle->smoothing : 0.05 * length;
    return TriangleInitial{position, amplitude, start == 1 ? std::min(sharp, smoothing) : smoothing};
}
}  // namespace

Scene started(Scene scene, int start) {
    if (start == 0) return scene;
    for (String& s : scene.strings) {
        if (s.initial) s.initial = initial(*s.initial, s.length, start);
        if (!s.pluck) continue;
        s.pluck->amplitude *= sizes[start];
        s.pluck->duration *= shortest[start];
        if (s.pluck->width < 0.2 * s.length) s.pluck->position = elsewhere(s.pluck->position, s.length, start);
    }
    return scene;
}

std::string name_of_start(const Scene& scene) {
    for (const String& s : scene.strings) {
        if (s.pluck)
            return fmt::format("a pluck of {:.3g} N in {:.3g} s at {:.3g} m", s.pluck->amplitude, s.pluck->duration, s.pluck->position);
        if (!s.initial) continue;
        if (const auto* m = std::get_if<ModeInitial>(&*s.initial)) return fmt::format("mode {}, {:.3g} m", m->number, m->amplitude);
        const auto& t = std::get<TriangleInitial>(*s.initial);
        return fmt::format("a {}triangle at {:.3g} m, {:.3g} m", t.smoothing > plectrum * s.length ? "smoothed " : "", t.position,
                           t.amplitude);
    }
    return "at rest";
}

}  // namespace jvari::bench::trim

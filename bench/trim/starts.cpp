#include "bench/trim/judge.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>

#include "scenes/start.hpp"

namespace jvari::bench::trim {

namespace {
// Factors for each start: on displacements and forces, on velocities, on the string's length, on
// the pluck's duration.
constexpr double sizes[starts] = {1, 0.8, 0.7, 0.9, 0.6};
constexpr double speeds[starts] = {1, 1.5, 0.7, 2, 0.5};
constexpr double places[starts] = {0, 0.88, 0.31, 0.42, 0.67};
constexpr double shortest[starts] = {1, 0.5, 0.7, 0.9, 0.6};
constexpr int sharp = 1;        // start with an unrounded corner
constexpr double narrow = 0.2;  // width over length: narrower footprints have room elsewhere

// Position at the start's place, or at the mirror image if the original position is too near.
double elsewhere(double position, double length, int start) {
    const double there = places[start] * length;
    return std::abs(there - position) < 0.05 * length ? length - there : there;
}

Shape other_shape(const Shape& own, double length, double size, int start) {
    const auto* mode = std::get_if<ModeShape>(&own);
    const auto* triangle = std::get_if<TriangleShape>(&own);
    const double amplitude = size * (mode ? mode->amplitude : triangle->amplitude);
    if (start == 2) return ModeShape{mode ? mode->number + 4 : 5, amplitude};
    return TriangleShape{elsewhere(triangle ? triangle->position : 0, length, start), amplitude,
                         start == sharp ? 0
                         : triangle     ? triangle->smoothing
                                        : 0.05 * length};
}

// Other start for a string: scales a start from a file, and leaves an equilibrium unchanged.
Start other_start(const String& s, int start) {
    if (const auto* mode = std::get_if<ModeShape>(&*s.start))
        return std::visit([](auto x) -> Start { return x; },
                          other_shape(*mode, s.length, sizes[start], start));
    if (const auto* triangle = std::get_if<TriangleShape>(&*s.start))
        return std::visit([](auto x) -> Start { return x; },
                          other_shape(*triangle, s.length, sizes[start], start));
    return *scaled(s, sizes[start]).start;
}

std::string name_of(const Shape& shape, const char* unit) {
    if (const auto* m = std::get_if<ModeShape>(&shape))
        return fmt::format("mode {}, {:.3g} {}", m->number, m->amplitude, unit);
    const auto& t = std::get<TriangleShape>(shape);
    return fmt::format("a {} triangle at {:.3g} m, {:.3g} {}",
                       t.smoothing > 0 ? "smoothed" : "sharp", t.position, t.amplitude, unit);
}

std::string name_of(const Start& start, double size) {
    if (const auto* m = std::get_if<ModeShape>(&start)) return name_of(Shape(*m), "m");
    if (const auto* t = std::get_if<TriangleShape>(&start)) return name_of(Shape(*t), "m");
    if (const auto* table = std::get_if<TableStart>(&start))
        return table->file + (size == 1 ? "" : fmt::format(" times {:g}", size));
    return "at rest";
}
}  // namespace

Scene started(Scene scene, int start) {
    if (start == 0) return scene;
    for (String& s : scene.strings) {
        if (s.start) s.start = other_start(s, start);
        if (s.velocity) s.velocity = other_shape(*s.velocity, s.length, speeds[start], start);
        for (Mass& m : s.masses) {  // a mass at rest is a part of the scene
            if (m.velocity == 0) continue;
            m.velocity *= speeds[start];
            if (m.width < narrow * s.length) m.position = elsewhere(m.position, s.length, start);
        }
        if (!s.pluck) continue;
        s.pluck->amplitude *= sizes[start];
        if (s.pluck->time.empty()) s.pluck->duration *= shortest[start];
        if (s.pluck->width < narrow * s.length)
            s.pluck->position = elsewhere(s.pluck->position, s.length, start);
    }
    return scene;
}

std::string name_of_start(const Scene& own, int start) {
    const Scene scene = started(own, start);
    for (const String& s : scene.strings) {
        std::vector<std::string> parts;
        if (s.pluck)
            parts.push_back(fmt::format("a pluck of {:.3g} N in {:.3g} s at {:.3g} m",
                                        s.pluck->amplitude, s.pluck->duration, s.pluck->position));
        for (const Mass& m : s.masses)
            if (m.velocity != 0)
                parts.push_back(
                    fmt::format("a mass of {:.3g} m/s at {:.3g} m", m.velocity, m.position));
        if (s.velocity) parts.push_back(name_of(*s.velocity, "m/s"));
        if (s.start && (parts.empty() || !std::holds_alternative<RestStart>(*s.start)))
            parts.push_back(name_of(*s.start, sizes[start]));
        if (!parts.empty()) return fmt::format("{}", fmt::join(parts, ", with "));
    }
    return "at rest";
}

}  // namespace jvari::bench::trim

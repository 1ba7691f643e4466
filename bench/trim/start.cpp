#include "bench/trim/start.hpp"

#include <fmt/core.h>

namespace jvari::bench::trim {

namespace {
constexpr double sizes[starts] = {1, 0.8, 0.7, 0.9, 0.6};
constexpr double places[starts] = {0, 0.17, 0.11, 0.05, 0.14};  // how far the place moves, of the string's length

double moved(double position, double length, int start) {
    const double by = places[start] * length;
    return position < 0.7 * length ? position + by : position - by;
}

struct Start {
    const String& string;
    int start;
    Initial operator()(ModeInitial m) const {
        if (start == 1) return TriangleInitial{0.3 * string.length, sizes[start] * m.amplitude, 0.2 * string.length};
        return ModeInitial{m.number + start - 1, sizes[start] * m.amplitude};
    }
    Initial operator()(TriangleInitial t) const {
        t.position = moved(t.position, string.length, start);
        t.amplitude *= sizes[start];
        return t;
    }
};
}  // namespace

Scene started(Scene scene, int start) {
    if (start == 0) return scene;
    for (String& s : scene.strings) {
        if (s.initial) s.initial = std::visit(Start{s, start}, *s.initial);
        if (!s.pluck) continue;
        s.pluck->amplitude *= sizes[start];
        s.pluck->duration *= sizes[start];
        if (s.pluck->width < 0.2 * s.length) s.pluck->position = moved(s.pluck->position, s.length, start);
    }
    return scene;
}

std::string name_of_start(const Scene& scene) {
    for (const String& s : scene.strings) {
        if (s.pluck) return fmt::format("a pluck of {:.3g} N in {:.3g} s", s.pluck->amplitude, s.pluck->duration);
        if (!s.initial) continue;
        if (const auto* m = std::get_if<ModeInitial>(&*s.initial)) return fmt::format("mode {}, {:.3g} m", m->number, m->amplitude);
        const auto& t = std::get<TriangleInitial>(*s.initial);
        return fmt::format("a triangle at {:.3g} m, {:.3g} m", t.position, t.amplitude);
    }
    return "at rest";
}

}  // namespace jvari::bench::trim

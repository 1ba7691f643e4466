// The sitar scenes of the tests: C5 on a fretted string, the paper's pitch and loss; its other
// figures are ours (scenes/sitar_c5.toml says which).
#pragma once

#include "tests/runs.hpp"

namespace jvari {

inline String sitar_string_at(double f0) {
    String s;
    s.length = 0.25;
    s.linear_density = 4.8828125e-4;
    s.tension = s.linear_density * (2 * s.length * f0) * (2 * s.length * f0);
    s.start = TriangleShape{0.5 * s.length, 2e-3, 0};
    return s;
}

inline Scene sitar_scene(double f0 = 523.25) {
    Scene scene;
    scene.name = "sitar";
    scene.duration = 1;
    scene.strings = {sitar_string_at(f0)};
    return scene;
}

inline ProfileBarrier bridge(Curve curve, double to = 0.025) {
    ProfileBarrier b;
    b.curve = std::move(curve);
    b.to = to;
    b.stiffness = {1e10};
    return b;
}

inline Tap tap(Quantity q, double position = 0) {
    Tap t;
    t.name = name_of(q) + std::string("_") + std::to_string(position);
    t.quantity = q;
    t.string = 0;
    t.position = position;
    return t;
}

inline Run run_sitar(const std::string& form, const Scene& scene, double sample_rate = 44100,
                     double tap_rate = 44100) {
    return play(form, scene, {sample_rate, tap_rate, 0, {}}, {.energy = true});
}

}  // namespace jvari

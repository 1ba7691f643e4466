// The C3 string of van Walstijn, Bridges & Mehes 2016, Table 1 with x_c = 5 mm, as tests and
// benchmarks use it.
#pragma once

#include "scenes/scene.hpp"

namespace jvari {

inline Scene c3_free() {  // the string alone, at rest
    Scene scene;
    scene.name = "c3";
    scene.duration = 1;
    String s;
    s.length = 1.0;
    s.linear_density = 4.83e-4;
    s.tension = 33.1;
    s.bending_stiffness = 6.03e-5;
    s.damping = PolynomialDamping{0.6, 6.5e-3, 5.0e-6};
    scene.strings = {s};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}, {"y03", Quantity::displacement, 0, 0.3}};
    return scene;
}

inline Scene c3_release() {  // over bridge and thread, released from +1.9 mm of the first mode
    Scene scene = c3_free();
    String& s = scene.strings.front();
    s.barriers = {LumpedBarrier{10e-3, 2e-3, 0, {4.39e8}, 1, 0}};
    s.thread = Thread{5e-3, 1.2e-3, 1.2e5, 1.2, 0};
    s.start = ModeShape{1, 1.9e-3};
    scene.taps.push_back({"bridge", Quantity::bridge_force, 0, 0});
    scene.taps.push_back({"thread", Quantity::thread_force, 0, 0});
    return scene;
}

inline Scene c3_pluck() {  // plucked as in section 4.1
    Scene scene = c3_release();
    scene.strings.front().start.reset();
    scene.strings.front().pluck = Pluck{-0.4, 50e-3, 30.0, 0.0, 0.5, 1.0};
    return scene;
}

inline Scene lossless(Scene scene) {
    for (String& s : scene.strings) {
        s.damping = NoDamping{};
        if (s.thread) s.thread->damping = 0;
    }
    return scene;
}

}  // namespace jvari

// What stands in row 0: the scene's shape, and no contact force.
#include <fmt/core.h>

#include <cmath>

#include "bench/check/judges.hpp"
#include "bench/check/scenes.hpp"
#include "scenes/modes.hpp"

namespace jvari::bench::check {

Verdict starts_from_the_scenes_shape(const Case& c) {
    Scene scene = c.scene;
    scene.duration = 1 / contract_tap_rate;
    scene.taps.clear();
    std::vector<double> expected, scale;
    for (std::size_t k = 0; k < scene.strings.size(); ++k) {
        String s = scene.strings[k];
        s.damping = NoDamping{};
        const Modes all = modes_of(s, 2000);
        const auto shape = initial_displacement(all, s);
        for (const double x : {0.1, 0.25, 0.4, 0.5, 0.7, 0.9}) {
            scene.taps.push_back({"y" + std::to_string(scene.taps.size()), Quantity::displacement, static_cast<int>(k), x * s.length});
            const auto w = displacement_weights(all, x * s.length);
            double y = 0;
            for (std::size_t i = 0; i < w.size(); ++i) y += w[i] * shape[i];
            expected.push_back(y);
            scale.push_back(s.initial ? std::visit([](const auto& i) { return std::abs(i.amplitude); }, *s.initial) : 0);
        }
    }
    const jvari::Run r = run(*make_scheme(c.scheme, scene, c.settings), scene, c.settings);
    for (std::size_t k = 0; k < expected.size(); ++k) {
        const double y = r.trace.column(static_cast<int>(k))[0];
        if (!(std::abs(y - expected[k]) <= 0.02 * scale[k]))
            return broken(fmt::format("{:.4g} m at {:.3g} m in place of {:.4g} m", y, scene.taps[k].position, expected[k]));
    }
    return kept();
}

Verdict starts_without_contact_forces(const Case& c) {
    const jvari::Run r = fresh(c, {});
    for (int k = 0; r.trace.rows > 0 && k < r.trace.taps(); ++k) {
        const Quantity q = c.scene.taps[k].quantity;
        const bool contact_force = q == Quantity::bridge_force || q == Quantity::thread_force || q == Quantity::driving_force;
        const bool at_rest = contact_force || !needed_by(c.scene).has(Feature::initial_shape);
        if (at_rest && r.trace.column(k)[0] != 0)
            return broken(fmt::format("tap {} is {:.3g} {} in row 0", r.trace.names[k], r.trace.column(k)[0], unit_of(q)));
    }
    return kept();
}

}  // namespace jvari::bench::check

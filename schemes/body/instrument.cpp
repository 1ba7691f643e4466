#include "schemes/body/instrument.hpp"

#include <numbers>

#include "schemes/body/body_modes.hpp"

namespace jvari {

void must_be_below_half_the_rate(const BodyMode& m, double dt) {
    const double omega = std::sqrt(m.stiffness / m.mass);
    if (omega * dt >= std::numbers::pi)
        throw Refusal("a mode of the body, at " + std::to_string(0.5 * omega / std::numbers::pi) +
                      " Hz, is not below half the sample rate of " + std::to_string(1 / dt) +
                      " Hz, where it would alias");
}

std::vector<BodyTap> body_taps(const Scene& scene, int string, std::vector<bool>& heard_already) {
    std::vector<BodyTap> all;
    const String& s = scene.strings[string];
    for (const HeardTap& heard : heard_taps(scene, string, heard_already)) {
        const Tap& tap = scene.taps[heard.column];
        BodyTap own{heard};
        if (tap.quantity == Quantity::displacement) own.on_w = 1 - tap.position / s.length;
        if (tap.quantity == Quantity::velocity) own.on_speed = 1 - tap.position / s.length;
        if (tap.quantity == Quantity::nut_force) own.on_w = s.tension / s.length;  // -T psi'
        all.push_back(own);
    }
    return all;
}

}  // namespace jvari

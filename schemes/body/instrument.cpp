#include "schemes/body/instrument.hpp"

#include <numbers>

#include "schemes/body/body_modes.hpp"

namespace jvari {

void must_be_below_half_the_rate(const BodyMode& m, double dt) {
    const double omega = std::sqrt(m.stiffness / m.mass);
    if (omega * dt >= std::numbers::pi)
        throw Refusal("a mode of the body, at " + std::to_string(0.5 * omega / std::numbers::pi) +
                      " Hz, is not below half the sample rate of " + std::to_string(1 / dt) + " Hz, where it would alias");
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

void add_taps(const Block& out, int row, const std::vector<BodyTap>& taps, const double* of_v, double w, double speed) noexcept {
    for (std::size_t t = 0; t < taps.size(); ++t) {
        double& cell = out.tap[taps[t].column * out.stride + row];
        const double heard = of_v[t] + (taps[t].on_w * w + taps[t].on_speed * speed);
        cell = taps[t].first ? heard : cell + heard;
    }
}

}  // namespace jvari

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
    for (std::size_t t = 0; t < scene.taps.size(); ++t) {
        const Tap& tap = scene.taps[t];
        if (!hears(tap, scene, string)) continue;
        BodyTap own{static_cast<int>(t), !heard_already[t]};
        if (tap.quantity == Quantity::displacement) own.on_w = 1 - tap.position / s.length;
        if (tap.quantity == Quantity::velocity) own.on_speed = 1 - tap.position / s.length;
        if (tap.quantity == Quantity::nut_force) own.on_w = s.tension / s.length;  // -T psi'
        heard_already[t] = true;
        all.push_back(own);
    }
    return all;
}

std::vector<Fact> body_facts(const BodyStep& step) {
    const ObstacleStep& c = step.contacts();
    const ObstacleStep::Tally& t = c.tally();
    if (c.contacts() == 0) return {};
    return {{facts::contact_points, static_cast<double>(c.contacts())},
            {facts::coupled_contact_points, static_cast<double>(c.coupled())},
            {facts::smallest_contact_force, t.smallest_force},
            {facts::deepest_penetration, t.deepest},
            {facts::contact_iterations_mean, t.solves > 0 ? t.iterations / static_cast<double>(t.solves) : 0},
            {facts::contact_iterations_most, static_cast<double>(t.most_iterations)},
            {facts::contact_residual, t.residual}};
}

}  // namespace jvari

// The two-point update on several points with the forces of obstacle_step.hpp: modal_two_point_points.hpp.
#include "schemes/modal/modal_two_point_points.hpp"

#include "schemes/body/body_modes.hpp"
#include "schemes/making.hpp"

namespace jvari {

TwoPointCoefficients exact_two_point(double omega0, double sigma, double dt) {
    const ModeStep m = exact_step(omega0, sigma, dt);
    return {m.A(), m.B()};
}

bool touches_once_without_loss(const String& s) {
    if (s.barriers.empty()) return true;
    const auto* lumped = std::get_if<LumpedBarrier>(&s.barriers.front());
    return s.barriers.size() == 1 && lumped && lumped->contact_loss == 0;
}

std::unique_ptr<Scheme> modal_two_point_points(const Descriptor& descriptor, const Scene& scene, const Settings& settings,
                                               TwoPointLaw law) {
    using OnPoints = ModalTwoPointPoints<ObstacleStep>;
    matched_without_loss(descriptor, scene, settings);
    return on_its_support<OnPoints>(
        scene, steps_per_row(settings),
        [&](const Scene& one) {
            return std::make_unique<OnPoints>(descriptor, one, settings, law, [](const auto&... parts) { return ObstacleStep(parts...); });
        },
        [&] { return TwoPointBody(scene.body->modes, 1 / settings.sample_rate, law); });
}

}  // namespace jvari

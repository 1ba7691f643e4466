// The two-point update on several points with the forces of obstacle_step.hpp: modal_two_point_points.hpp.
#include "schemes/modal/modal_two_point_points.hpp"

#include "schemes/body/body_modes.hpp"

namespace jvari {

std::unique_ptr<Scheme> modal_two_point_points(const Descriptor& descriptor, const Scene& scene, const Settings& settings,
                                               TwoPointLaw law) {
    using OnPoints = ModalTwoPointPoints<ObstacleStep>;
    const bool matched = choice_option(settings, compliance_option) == "matched";
    if (matched && needed_by(scene).has(Feature::contact_loss))
        throw Refusal(std::string(descriptor.name) + ": compliance=matched leaves out contact loss");
    const auto one = [&](const Scene& of) {
        return std::make_unique<OnPoints>(descriptor, of, settings, law, [](const auto&... parts) { return ObstacleStep(parts...); });
    };
    if (!needed_by(scene).has(Feature::moving_body)) return one(scene);
    if (matched) throw Refusal(std::string(descriptor.name) + ": compliance=matched leaves out a moving body");
    TwoPointBody body(scene.body->modes, 1 / settings.sample_rate, law);
    return std::make_unique<Instrument<OnPoints, TwoPointBody>>(scene, each_string<OnPoints>(scene, one), std::move(body),
                                                                steps_per_row(settings));
}

}  // namespace jvari

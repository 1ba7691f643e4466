// The two-point update on several points with the forces of obstacle_step.hpp: modal_two_point_points.hpp.
#include "schemes/modal/modal_two_point_points.hpp"

namespace jvari {

std::unique_ptr<Scheme> modal_two_point_points(const Descriptor& descriptor, const Scene& scene, const Settings& settings,
                                               TwoPointLaw law) {
    const bool loses = needed_by(scene).has(Feature::contact_loss);
    if (loses && choice_option(settings, compliance_option) == "matched")
        throw Refusal(std::string(descriptor.name) + ": compliance=matched leaves out contact loss");
    return std::make_unique<ModalTwoPointPoints<ObstacleStep>>(descriptor, scene, settings, law,
                                                               [](const auto&... parts) { return ObstacleStep(parts...); });
}

}  // namespace jvari

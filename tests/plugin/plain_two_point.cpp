// A scheme from outside the tree: the modal two-point scheme in plain Eigen, offered under the name `plain_two_point`.
#include "plain_two_point.hpp"

namespace {
using namespace jvari;

extern const Descriptor plain_two_point;

const Descriptor plain_two_point = {
    "plain_two_point",
    "van Walstijn et al. 2016, eqs 38-49, as printed",
    Features(Feature::bending_stiffness) | Feature::damping | Feature::frequency_dependent_damping | Feature::measured_modes |
        Feature::lumped_barrier | Feature::thread | Feature::initial_shape | Feature::pluck,
    Balance::none,
    Clock::stepped,
    [](const Scene& scene, const Settings& settings) -> std::unique_ptr<Scheme> {
        refuse_missing(plain_two_point, scene);
        refuse_unknown_options(settings, {});
        return std::make_unique<PlainTwoPoint<double>>(scene, settings);
    },
};

}  // namespace

extern "C" const jvari::Plugin jvari_plugin = {jvari::plugin_abi, &plain_two_point, 1};

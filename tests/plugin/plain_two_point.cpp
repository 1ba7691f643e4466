// A scheme from outside the tree: the modal two-point scheme in plain Eigen, offered under the name `plain_two_point`.
#include "plain_two_point.hpp"

#include "schemes/plugin.hpp"

namespace {
using namespace jvari;

constexpr Descriptor table[] = {{
    "plain_two_point",
    "van Walstijn et al. 2016, eqs 38-49, as printed",
    Features(Feature::bending_stiffness) | Feature::damping | Feature::frequency_dependent_damping | Feature::measured_modes |
        Feature::lumped_barrier | Feature::thread | Feature::initial_shape | Feature::pluck,
    Balance::none,
    Clock::stepped,
    [](const Descriptor&, const Scene& scene, const Settings& settings) -> std::unique_ptr<Scheme> {
        return std::make_unique<PlainTwoPoint<double>>(scene, settings);
    },
}};

}  // namespace

JVARI_PLUGIN(table)

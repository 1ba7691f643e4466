// Steps the string in three_point_modes.hpp by the discrete gradient: the recursion of
// modal_spatial_newton (Issanchou et al. 2016, eqs 14-16). The contacts act by their footprints'
// weights instead of at grid nodes. Leaves out: contact loss with compliance=matched; polarisation;
// a body that moves.
#include "schemes/driver/driver.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/three_point_modes.hpp"

namespace jvari {

namespace {
template <class Rule>
std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    matched_without_loss(descriptor, scene, settings);
    return driven(std::make_unique<ThreePointModes>(problem_of_modes(descriptor, scene, settings)),
                  descriptor, settings, rule_of<Rule>(settings));
}
}  // namespace

extern const Descriptor modal_three_point, modal_quadratised, modal_explicit_penalty;
const Descriptor modal_three_point = {
    .name = "modal_three_point",
    .source = "Issanchou et al. 2016, eqs 14-16, with contacts by their footprints",
    .represents = modal_features_of_points | any_rigid | any_mass | Feature::barrier_above,
    .balance = Balance::exact,
    .make = make<GradientRule>,
    .options = matched_options,
    .approximates = modal_approximates,
    .stand_in_rank = 0};

const StringRow modal_three_point_row = {
    &modal_three_point,
    {JVARI_RULES(JVARI_MAKER)},
    {{"quadratised", &modal_quadratised, "levels=3"}, {"penalty", &modal_explicit_penalty}}};

}  // namespace jvari

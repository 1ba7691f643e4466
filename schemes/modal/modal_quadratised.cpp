// Modal schemes with quadratised (linearly implicit) contact: the strings in two_point_modes.hpp
// (van Walstijn et al. 2016, eqs 38-52) and three_point_modes.hpp (Issanchou et al. 2016) with
// quadratised_rule.hpp. Energy columns hold the scheme's own energy, with psi^2/2 for the contact;
// the facts report its distance from the true energy. Option `compliance` = own (default) |
// matched: puts the compliance that cut and step take from the string in series with barrier and
// thread. Leaves out: contact loss with compliance=matched; polarisation.
#include "schemes/contact/quadratised_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/three_point_modes.hpp"
#include "schemes/modal/two_point_modes.hpp"

namespace jvari {

namespace {
constexpr Option levels_option{"levels", "2", "time levels of the recursion", {"2", "3"}};
constexpr Option variant_option{
    "variant",
    "released",
    "raw leaves psi where the step puts it, and may pull; released lets go where it would pull",
    {"raw", "released"}};
constexpr Option options[] = {levels_option, variant_option, compliance_option,
                              profile_points_option};

std::unique_ptr<Scheme> quadratised_modes(const Descriptor& descriptor, const Scene& scene,
                                          const Settings& settings) {
    using enum Quadratisation;
    matched_without_loss(descriptor, scene, settings);
    const RuleChoice rule = choice_option(settings, variant_option) == "raw"
                                ? rule_of<QuadratisedRule<raw>>(settings)
                                : rule_of<QuadratisedRule<released>>(settings);
    if (choice_option(settings, levels_option) == "3")
        return driven(
            std::make_unique<ThreePointModes>(problem_of_modes(descriptor, scene, settings)),
            descriptor, settings, rule);
    return driven(std::make_unique<TwoPointModes>(descriptor, scene, settings, exact_two_point),
                  descriptor, settings, rule);
}
}  // namespace

extern const Descriptor modal_quadratised = {
    .name = "modal_quadratised",
    .source = "Ducceschi et al. 2021, psi released in full where it would pull",
    .represents = modal_features_of_points | any_mass | Feature::barrier_above,
    .balance = Balance::exact,
    .make = quadratised_modes,
    .options = options,
    .approximates = modal_approximates_elastic};

}  // namespace jvari

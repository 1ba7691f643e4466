// Modal schemes with quadratised (linearly implicit) contact: the strings of two_point_modes.hpp (van Walstijn et al. 2016, eqs 38-52) and
// three_point_modes.hpp (Issanchou et al. 2016) with quadratised_rule.hpp. Energy columns hold the scheme's own energy, with psi^2/2 for
// the contact; the facts tell how far that is from the true one. Option `compliance` = own (default) | matched: what cut and step take from
// the string's compliance stands in series with barrier and thread. Leaves out: contact loss with compliance=matched; polarisation.
#include <algorithm>

#include "schemes/contact/quadratised_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/three_point_modes.hpp"
#include "schemes/modal/two_point_modes.hpp"

namespace jvari {

namespace {
using Made = std::unique_ptr<Scheme>;

using Make = Made (*)(const Descriptor&, const Scene&, const Settings&);

template <int levels, Quadratisation variant>  // of the recursion
Made made(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    matched_without_loss(descriptor, scene, settings);
    using Rule = QuadratisedRule<variant>;
    if constexpr (levels == 2)
        return driven<Rule>(std::make_unique<TwoPointModes>(descriptor, scene, settings, exact_two_point), descriptor, settings);
    else return driven<Rule>(std::make_unique<ThreePointModes>(problem_of_modes(descriptor, scene, settings)), descriptor, settings);
}

constexpr Option levels_option{"levels", "2", "time levels of the recursion", {"2", "3"}};
constexpr Option variant_option{"variant",
                                "released",
                                "what is done about psi and the potential drifting apart: the header of quadratised_contact.hpp",
                                {"raw", "constrained", "released", "relaxed", "controlled"}};
constexpr Option chosen_options[] = {levels_option, variant_option, lambda0_option, compliance_option, profile_points_option};

Made made_as_chosen(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    using enum Quadratisation;
    static constexpr Make all[][2] = {{made<2, raw>, made<3, raw>},  // in the order of the option's words
                                      {made<2, constrained>, made<3, constrained>},
                                      {made<2, released>, made<3, released>},
                                      {made<2, relaxed>, made<3, relaxed>},
                                      {made<2, controlled>, made<3, controlled>}};
    const auto words = variant_option.words();
    const auto variant = std::find(words.begin(), words.end(), choice_option(settings, variant_option)) - words.begin();
    return all[variant][choice_option(settings, levels_option) == "3"](descriptor, scene, settings);
}

constexpr const char* raw_source = "Ducceschi et al. 2021 without the constraint on psi (known-bad control)";
constexpr const char* constrained_source = "Ducceschi et al. 2021, with g signed by psi and psi driven to 0 out of contact";
constexpr const char* released_source = "Ducceschi et al. 2021, psi released in full where it would pull";

constexpr Descriptor quadratised(const char* name, const char* source, Make make, std::span<const Option> options) {
    return {.name = name,
            .source = source,
            .represents = modal_features_of_points,
            .balance = Balance::exact,
            .clock = Clock::stepped,
            .make = make,
            .options = options,
            .approximates = modal_approximates_elastic};
}
}  // namespace

extern const Descriptor modal_quadratised = quadratised("modal_quadratised", released_source, made_as_chosen, chosen_options);
extern const Descriptor modal_quadratised_two_point_constrained =
    quadratised("modal_quadratised_two_point_constrained", constrained_source, made<2, Quadratisation::constrained>, matched_options);
extern const Descriptor modal_quadratised_two_point_raw =
    quadratised("modal_quadratised_two_point_raw", raw_source, made<2, Quadratisation::raw>, matched_options);
extern const Descriptor modal_quadratised_three_point =
    quadratised("modal_quadratised_three_point", released_source, made<3, Quadratisation::released>, matched_options);
extern const Descriptor modal_quadratised_three_point_constrained =
    quadratised("modal_quadratised_three_point_constrained", constrained_source, made<3, Quadratisation::constrained>, matched_options);
extern const Descriptor modal_quadratised_three_point_raw =
    quadratised("modal_quadratised_three_point_raw", raw_source, made<3, Quadratisation::raw>, matched_options);

}  // namespace jvari

// Modal two-point scheme: van Walstijn, Bridges & Mehes 2016, eqs 16-52 (the update in the form of
// two_point_modes.hpp).
//
// Exact modal frequencies and decay by the coefficients in eq 33; the thread eliminated by eqs
// 45-47; one barrier, whose force is the two-point discrete gradient in eq 30. Starts from rest
// with q = 0, like the paper. With losses this differs slightly from the true rest: a freely
// decaying mode begins with a small phase offset (fact `start_phase_offset`). Without losses free
// motion is exact to rounding. Option `compliance` = own (default, the paper's scheme) | matched:
// puts the compliance that truncation and step take from the string in series with barrier and
// thread (contact/compliance.hpp), and adds its part to displacement and nut force.
// `modal_two_point_trapezoidal` is the same with the coefficients a_i, b_i in eq 32 not replaced:
// stable, and dispersive. Leaves out: contact loss and a moving body with compliance=matched;
// polarisation.
#include "schemes/body/body_modes.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/two_point_modes.hpp"

namespace jvari {

namespace {

TwoPointCoefficients trapezoidal(double omega0, double sigma, double dt) {  // a_i, b_i in (32)
    return {0.25 * omega0 * omega0 * dt * dt, sigma * dt};
}

std::unique_ptr<Scheme> two_point_scheme(const Descriptor& descriptor, const Scene& scene,
                                         const Settings& settings, TwoPointLaw law,
                                         const RuleChoice& rule) {
    matched_without_loss(descriptor, scene, settings);
    return on_its_support<TwoPointModes>(
        descriptor, scene, settings, rule,
        [&](const Scene& one) {
            return std::make_unique<TwoPointModes>(descriptor, one, settings, law);
        },
        [&] { return TwoPointBody(scene.body->modes, 1 / settings.sample_rate, law); });
}
template <class Rule, TwoPointLaw law = exact_two_point>
std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    return two_point_scheme(descriptor, scene, settings, law, rule_of<Rule>(settings));
}

}  // namespace

extern const Descriptor modal_two_point = {
    .name = "modal_two_point",
    .source = "van Walstijn et al. 2016, eqs 16-52",
    .represents = modal_features_of_points | Feature::moving_body | any_rigid |
                  Feature::clipped_loss | any_mass | Feature::barrier_above,
    .balance = Balance::exact,
    .clock = Clock::stepped,
    .make = make<GradientRule>,
    .options = matched_options,
    .approximates = modal_approximates,
    .stand_in_rank = 2};
extern const Descriptor modal_two_point_trapezoidal = {
    .name = "modal_two_point_trapezoidal",
    .source = "van Walstijn et al. 2016, eq 32: coefficients not replaced (dispersive control)",
    .represents = modal_features_of_points | any_rigid | any_mass | Feature::barrier_above,
    .balance = Balance::exact,
    .clock = Clock::stepped,
    .make = make<GradientRule, trapezoidal>,
    .options = matched_options,
    .approximates = modal_approximates};

extern const Descriptor modal_quadratised;
const StringRow modal_two_point_row = {
    &modal_two_point, {JVARI_RULES(JVARI_MAKER)}, {{"quadratised", &modal_quadratised}}};

}  // namespace jvari

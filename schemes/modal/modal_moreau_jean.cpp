// String in its modes over rigid barriers by Moreau-Jean time stepping: Issanchou, Acary, Perignon,
// Touze & Le Carrou 2018 ("A modal-based approach to the nonlinear vibration of strings against a
// unilateral obstacle"; Siconos). Their theta scheme with the modal theta and damping that make
// free motion exact is the recursion in three_point_modes.hpp, with the gain dt^2/W = kappa/(m
// omega0^2), kappa = 1 + C~ - C. This gain gives every mode the right yield under a steady force.
// Contacts by contact/moreau_jean_rule.hpp. The energy shown is the scheme's own, with W for m; it
// tends to the true one. Option `compliance` = own (default, the paper's scheme) | matched: puts
// the compliance that cut and step take from the string in series. Leaves out: contact loss,
// because the barriers are rigid; polarisation; a body that moves.
#include "schemes/contact/moreau_jean_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/modal/three_point_modes.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

namespace {
double static_gain(double omega0, double sigma, double dt) {  // over dt^2/m
    return exact_step(omega0, sigma, dt).num / (omega0 * omega0 * dt * dt);
}

std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    return driven(std::make_unique<ThreePointModes>(
                      problem_of_modes(descriptor, scene, settings, static_gain)),
                  descriptor, settings, rule_of<MoreauJeanRule>(settings));
}
constexpr Option options[] = {compliance_option, profile_points_option, restitution_option};
}  // namespace

extern const Descriptor modal_moreau_jean = {
    .name = "modal_moreau_jean",
    .source = "Issanchou, Acary et al. 2018: rigid contact with a coefficient of restitution",
    .represents = (modal_features_of_points - MoreauJeanRule::leaves_out) | any_rigid,
    .balance = Balance::none,
    .make = make,
    .options = options,
    .approximates = MoreauJeanRule::approximates,
    .stand_in_rank = 0};

}  // namespace jvari

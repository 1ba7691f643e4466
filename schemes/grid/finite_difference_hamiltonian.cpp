// Two-step midpoint finite differences: Chatziioannou & van Walstijn 2015, "Energy conserving
// schemes for the simulation of musical instrument contact dynamics", the model with which van
// Walstijn et al. 2016 compare cost (section 5).
//
//     (I + A + B) s = 2(q - A y) + xi sum g F,   y <- y + s, q <- s - q;
//     A = dt^2 K/4, B = dt R/2, xi = dt^2/(2 mu dx), q = v dt/2
//
// with K = -c^2 D2 + kappa^2 D4 and R = 2 sigma0 - 2 sigma1 D2 + 2 sigma2 D4: five diagonals
// (grid_solve.hpp). The responses (I + A + B)^-1 g for contacts and thread are solved at the start,
// and give the compliance Theta; the contact equation is van Walstijn et al.'s eq 48 over the span
// dt.
//
// The coefficients in A y are rounded so that they add up to 0 exactly. Any remainder would be a
// spring to the ground that no energy includes: eps/(omega dt)^2 relative to a mode's own
// stiffness, 5e-8 for mode 1 of C3 at 11 MHz. Unconditionally stable; frequencies warp like (2/dt)
// atan(omega dt/2). The default grid is that of the explicit scheme without loss: its spatial error
// (beta dx)^2/24 is then at least half the warp's (c beta dt)^2/12. Option `grid` takes any number
// of intervals. Energy belongs to the row's instant: mass/2 (|v|^2 + <y, K y>) + P(y). The pluck
// acts with its force at the middle of the step.
#include "schemes/driver/pairings.hpp"
#include "schemes/grid/midpoint_string.hpp"
#include "schemes/making.hpp"

namespace jvari {

namespace {
constexpr Option options[] = {compliance_option, profile_points_option, grid_option};

// Midpoint rule throughout: gamma of a quadratised contact is taken at the middle of the step too.
// At the older level its lag would add to the string's warp, and a soft profile would err by 2.4 %
// at 176.4 kHz in place of 0.9 %.
template <class Rule>
struct AtTheMiddle {
    using type = Rule;
};
template <Quadratisation variant>
struct AtTheMiddle<QuadratisedRule<variant>> {
    using type = QuadratisedRule<variant, true>;
};

template <class Rule>
std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    const double dt = 1 / settings.sample_rate;
    const String& s = scene.strings.front();
    const double own = std::floor(s.length / explicit_spacing_limit(s, {}, dt));
    const Grid grid = grid_of(descriptor, s, number_option(settings, grid_option, own));
    const GridString g = on_grid(descriptor, scene, settings, grid, fit_losses(s));
    return driven(std::make_unique<MidpointString>(g, dt), descriptor, settings,
                  rule_of<typename AtTheMiddle<Rule>::type>(settings));
}
}  // namespace

extern const Descriptor finite_difference_hamiltonian = {
    .name = "finite_difference_hamiltonian",
    .source = "Chatziioannou & van Walstijn 2015",
    .represents = grid_features,
    .balance = Balance::exact,
    .make = make<GradientRule>,
    .options = options,
    .approximates = grid_approximates};

const StringRow finite_difference_hamiltonian_row = {&finite_difference_hamiltonian,
                                                     {JVARI_RULES(JVARI_MAKER)}};

}  // namespace jvari

// Strang splitting of the string and its points: half a kick by the forces at the instant, the exact motion of the free modes over dt, half
// a kick (Strang 1968; Hairer, Lubich & Wanner 2006, ch. II.5). The thread's own state moves by an exponential step of half the length on
// either side of a kick, the string held (exponential Euler-Rosenbrock, of second order). All symmetric, so of second order in time, and
// explicit. Eliminating the velocities, it is the recursion of modal_three_point.hpp with gain dt R sin(omega dt)/(m omega).
//
// That is of use where the contact is soft: what cut and kicks take from the string's compliance stands in series
// (contact/compliance.hpp). In lasting contact it is stable below the stiffness of fact stable_stiffness_limit, 1/sum g^2 e/den, to be held
// against 1/series_compliance, which the contact cannot pass. Beyond it the run may diverge, and then says so.
// No energy balance is promised; the stored energy is the true one, with what is in series.
// Leaves out: contact loss, several barriers, profiles, polarisation, the body.
#include "schemes/modal/series_force.hpp"

namespace jvari {

extern const Descriptor modal_strang;

namespace {
std::unique_ptr<Scheme> made(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    ModalString string = modal_string(descriptor, scene, settings);
    const ModalArray gain = impulse_gain(string);
    return explicit_in_series(descriptor, scene, std::move(string), gain);
}

double margin(const Scene& scene, const Settings& settings) {
    return series_margin(modal_strang, scene, settings, impulse_gain);
}
}  // namespace

extern const Descriptor modal_strang = {
    .name = "modal_strang",
    .source = "Strang 1968, with the residual compliance of the cut modes (MacNeal 1971) in series",
    .represents = modal_features,
    .balance = Balance::none,
    .clock = Clock::stepped,
    .make = made,
    .note =
        "One lumped barrier without contact loss: several contacts behind one compliance have their forces "
        "only by iteration, and a loss needs a velocity. An explicit kick has neither.",
    .limit = {"penalty_limit", margin}};

}  // namespace jvari

// Strang splitting of the string and its contact: half a kick by the force at the instant, the exact motion of the free modes over dt, half
// a kick (Strang 1968; Hairer, Lubich & Wanner 2006, ch. II.5). Symmetric, so of second order in time, and explicit. Eliminating the
// velocities, it is the recursion of three_point_modes.hpp with gain dt R sin(omega dt)/(m omega).
//
// That is of use where the contact is soft: what cut and kicks take from the string's compliance stands in series with contact and thread
// (contact/explicit_rule.hpp, contact/obstacle.hpp), which takes the mean of the outer levels. In lasting contact it is stable below the
// stiffness of fact stable_stiffness_limit, to be held against 1/series_compliance, which the contact cannot pass. Beyond it the run may
// diverge, and then says so. No energy balance is promised; the stored energy is the true one.
// Leaves out: contact loss, several barriers, profiles, polarisation, the body.
#include "schemes/modal/penalised_modes.hpp"

namespace jvari {

extern const Descriptor modal_strang;

namespace {
Settings matched(Settings s) {
    s.options = {{compliance_option.name, "matched"}};
    return s;
}

std::unique_ptr<Scheme> made(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    return penalised(descriptor, scene, matched(settings), {impulse_gain});
}

double margin(const Scene& scene, const Settings& settings) {
    return penalty_margin(modal_strang, scene, matched(settings), {impulse_gain});
}
}  // namespace

extern const Descriptor modal_strang = {
    .name = "modal_strang",
    .source = "Strang 1968, with the residual compliance of the cut modes (MacNeal 1971) in series",
    .represents = modal_features | Feature::rigid_barrier,
    .balance = Balance::none,
    .clock = Clock::stepped,
    .make = made,
    .note = "One lumped barrier without contact loss: a loss needs a velocity, which an explicit kick has not.",
    .limit = {"penalty_limit", margin}};

}  // namespace jvari

// Two-moment scheme: modes exact under forces that are lines in the step, docs/two-moments.md.
//
// Contacts by rule D or G (moments/moment_contact.hpp), chosen by their compliances before the run
// (fact `conserving_contacts`). Option `compliance` has the meaning in modal_two_point.cpp;
// matched, the ladder of the cut modes is exact in the step too. Modes above half the sample rate
// move correctly, and alias in the rows. Leaves out: a moving body, polarisation, and profiles,
// whose many points cost more than a linear force gains.
#include "schemes/driver/driver.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/two_moment_modes.hpp"

namespace jvari {

namespace {
std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    return driven(std::make_unique<TwoMomentModes>(descriptor, scene, settings), descriptor,
                  settings, {});
}
}  // namespace

extern const Descriptor modal_two_moment = {
    .name = "modal_two_moment",
    .source = "docs/two-moments.md; Betsch & Steinmann 2001, Gonzalez 1996",
    .represents = modal_features | Feature::several_barriers | Feature::contact_loss |
                  Feature::clipped_loss | Feature::rigid_barrier | Feature::free_mass |
                  Feature::barrier_above,
    .balance = Balance::exact,
    .clock = Clock::stepped,
    .make = make,
    .options = {&compliance_option, 1},
    .note = "a profile's many points cost more than the gain: 10 us a step with 16"};

}  // namespace jvari

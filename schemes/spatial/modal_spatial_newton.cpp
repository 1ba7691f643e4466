// Full-modal spatial Newton: exact three-point recursion per mode, conservative contact forces on
// the nodes x_i = iL/N of a grid with equally many interior nodes and modes. Source: Issanchou et
// al. 2016, eqs 13-28. The matrices D in (15) and (19) are never formed, for they are full: the
// modes are stepped (14), (17) and read at the nodes by (13).
//
// Beyond the paper: barriers with a footprint, a thread and a pluck act through modal weights. The
// thread's force is the average over the outer levels, F_c = k_c (h_c - (u+ + u-)/2) - r_c (u+ -
// u-)/(2 dt), and is eliminated from the contact equation by van Walstijn et al. 2016, eqs 45-48.
// Contacts that are no nodes, or have a thread beside them, are coupled and solved for together.
// Leaves out two polarisations. On a body that moves (schemes/body) the points on all strings are
// solved for together, and its acceleration is one more force.
//
// Option `compliance` = own (default, the paper's scheme) | matched: puts the compliance that cut
// and step take from the string in series with contacts and thread (contact/compliance.hpp,
// contact/obstacle.hpp). Profiles are then touched at separate points (option `points`), and
// contact loss is left out. Refused if the scheme is too soft already.
//
// The string comes from modal/three_point_modes.hpp, with the nodes for points. Rows, energy and
// start come from driver.hpp.
#include <cmath>

#include "schemes/body/instrument.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/three_point_modes.hpp"
#include "schemes/spatial/spatial_ports.hpp"

namespace jvari {

ThreePointProblem spatial_problem(const Descriptor& descriptor, const Scene& scene,
                                  const Settings& settings) {
    ThreePointProblem p;
    p.scene = scene;
    p.dt = 1 / settings.sample_rate;
    p.on_body = needed_by(scene).has(Feature::moving_body);
    const bool matched = matched_without_loss(descriptor, scene, settings);
    if (matched) p.scene.strings.front() = with_profile_points(p.string(), settings);
    const int intervals = p.update.intervals =
        matched ? modes_for(p.string(), settings) + 1 : intervals_for(p.string(), settings);
    if (intervals < 2) throw Refusal("modal_spatial_newton needs one mode at least");
    p.modes = modes_of(p.string(), intervals - 1);
    p.points = points_of(p.scene, p.dt);
    place_contacts(p);
    complete(p, descriptor, settings);
    p.facts.insert(p.facts.begin(),
                   {{facts::interior_nodes, double(p.update.modes())},
                    {facts::modes_above_nyquist, double(p.three_point.above_nyquist)}});
    return p;
}

namespace {
std::unique_ptr<Scheme> spatial_scheme(const Descriptor& descriptor, const Scene& scene,
                                       const Settings& settings, const RuleChoice& rule) {
    return on_its_support<ThreePointModes>(
        descriptor, scene, settings, rule,
        [&](const Scene& one) {
            return std::make_unique<ThreePointModes>(spatial_problem(descriptor, one, settings));
        },
        [&] { return ThreePointBody(scene.body->modes, 1 / settings.sample_rate); });
}
template <class Rule>
std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    return spatial_scheme(descriptor, scene, settings, rule_of<Rule>(settings));
}

}  // namespace

extern const Descriptor modal_spatial_newton = {
    .name = "modal_spatial_newton",
    .source = "Issanchou et al. 2016, eqs 13-16, 20-21, 24-28",
    .represents = (modal_features_of_points - Feature::equilibrium) | Feature::moving_body |
                  any_rigid | Feature::free_mass,
    .balance = Balance::exact,
    .make = make<GradientRule>,
    .options = matched_options,
    .stand_in_rank = 3};

const StringRow modal_spatial_newton_row = {&modal_spatial_newton, {JVARI_RULES(JVARI_MAKER)}};

}  // namespace jvari

#include "schemes/modal/three_point_modes.hpp"

#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

template class ThreePointModesBy<ThreePointPass>;
template class Driver<ThreePointModes>;

void complete(ThreePointProblem& p, const Descriptor& descriptor, const Settings& settings,
              ModalGain gain) {
    const String& s = p.string();
    const bool linear = p.points.contacts.count() == 0 && !s.thread;
    p.three_point = three_point(p.modes, p.dt, (linear ? 0.95 : 0.25) * std::numbers::pi);
    LinearUpdate& u = p.update;
    u.Ct = p.three_point.Ct;
    u.kappa = p.three_point.kappa;
    u.gain = p.three_point.gain;
    for (int j = 0; j < p.modes.count(); ++j) {
        if (gain) u.over_plain.push_back(gain(p.modes.omega0[j], p.modes.sigma[j], p.dt));
        p.W.push_back(gain ? p.dt * p.dt / u.gain_of(j) : p.modes.mass);
    }
    if (s.thread) {
        u.ports.push_back({footprint_weights(p.modes, s.thread->position, s.thread->width), 0});
        p.points.positions.push_back(s.thread->position);
    }
    if (p.on_body) u.ports.push_back({end_inertia(p.modes, s), 0});
    u.reads = static_cast<int>(u.ports.size());
    if (s.pluck)
        u.ports.push_back({footprint_weights(p.modes, s.pluck->position, s.pluck->width), 0});
    for (std::size_t a = 0; a < u.ports.size(); ++a) {
        p.theta.emplace_back();
        for (int b = 0; b < u.reads; ++b) {
            const Port &one = u.ports[std::min<int>(a, b)], &other = u.ports[std::max<int>(a, b)];
            // nodes are orthogonal
            const bool apart = one.node != 0 && other.node != 0 && one.node != other.node;
            double sum = 0;
            for (int j = 0; !apart && j < p.modes.count(); ++j)
                sum += u.gain_of(j) * one.weights[j] * other.weights[j];
            p.theta[a].push_back(sum);
            if (static_cast<int>(a) < u.reads) p.points.theta.push_back(sum);
        }
    }
    std::vector<double> own;
    // under a steady force (14)
    for (int j = 0; j < p.modes.count(); ++j) own.push_back(u.gain_of(j) / u.kappa[j]);
    if (choice_option(settings, compliance_option) == "matched")
        p.points.series = modal_missing_matrix(descriptor, p.scene, p.modes, p.dt, own);
    else if (s.barriers.size() == 1 && std::holds_alternative<LumpedBarrier>(s.barriers.front()))
        p.facts.push_back({facts::static_compliance, relative_compliance(p.modes, s, own)});
    p.start = start_of(p.modes, s, yield_of(own, p.points.series));
    p.points.start_force = p.start.force;
    for (int j = 0; j < p.modes.count(); ++j) {
        const double y = p.start.displacement[j], v = p.start.velocity[j];
        // in equilibrium the recursion itself, with equal levels 0 and -1
        p.first.push_back(
            (p.start.force.empty() ? p.three_point.start[j] * y : -0.5 * u.kappa[j] * y) +
            p.three_point.drift[j] * v);
    }
}

ThreePointProblem problem_of_modes(const Descriptor& descriptor, const Scene& scene,
                                   const Settings& settings, ModalGain gain) {
    ThreePointProblem p;
    p.scene = scene;
    p.scene.strings.front() = with_profile_points(scene.strings.front(), settings);
    p.dt = 1 / settings.sample_rate;
    p.modes = modes_of(p.string(), settings);
    refuse_above_nyquist(descriptor, p.modes, settings.sample_rate);
    p.points = points_of(p.scene, p.dt);
    p.update.intervals = p.modes.count() + 1;
    for (const Place& place : add_contacts(p.points, p.string()))
        p.update.ports.push_back({footprint_weights(p.modes, place.at), 0});
    complete(p, descriptor, settings, gain);
    return p;
}

}  // namespace jvari

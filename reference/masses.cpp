#include "reference/masses.hpp"

#include <cmath>

namespace jvari {

double share_of(const Modes& modes, const Mass& m) { return std::sqrt(modes.mass / m.mass); }

Modes with_masses(Modes modes, const String& s) {
    for (const Mass& m : s.masses) {
        modes.beta.push_back(0);
        modes.omega0.push_back(std::sqrt(m.spring / m.mass));
        modes.sigma.push_back(0.5 * m.damping / m.mass);
    }
    return modes;
}

ModalStart with_masses(ModalStart start, const Modes& modes, const String& s) {
    for (const Mass& m : s.masses) {
        start.displacement.push_back((m.spring > 0 ? -m.weight / m.spring : -m.gap) /
                                     share_of(modes, m));
        start.velocity.push_back(m.velocity / share_of(modes, m));
    }
    return start;
}

std::vector<double> falling(const Modes& modes, const String& s) {
    std::vector<double> force(modes.beta.size(), 0.0);
    std::size_t own = force.size() - s.masses.size();
    for (const Mass& m : s.masses) force[own++] = m.spring > 0 ? 0 : m.weight * share_of(modes, m);
    return force;
}

std::vector<Touched> touched_by(const Modes& modes, const String& s) {
    std::vector<Touched> all;
    const auto add = [&](const LumpedBarrier& b) {
        all.push_back({b, contact_weights(modes, b)});
        all.back().law.height *= b.sign();
    };
    for (const Barrier& barrier : s.barriers) add(std::get<LumpedBarrier>(barrier));
    std::size_t own = modes.beta.size() - s.masses.size();
    for (const Mass& m : s.masses) {
        add({m.position,
             m.width,
             m.spring > 0 ? m.rest() : 0,
             {m.stiffness},
             m.exponent,
             m.contact_loss,
             m.loss_law});
        all.back().weights[own++] = -share_of(modes, m);
    }
    return all;
}

}  // namespace jvari

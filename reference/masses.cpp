#include "reference/masses.hpp"

#include <cmath>

namespace jvari {

double share_of(const Modes& modes, const Mass& m) { return std::sqrt(modes.mass / m.mass); }

Modes with_masses(Modes modes, const String& s) {
    for (auto* v : {&modes.beta, &modes.omega0, &modes.sigma})
        v->insert(v->end(), s.masses.size(), 0.0);
    return modes;
}

ModalStart with_masses(ModalStart start, const Modes& modes, const String& s) {
    for (const Mass& m : s.masses) {
        start.displacement.push_back(-m.gap / share_of(modes, m));
        start.velocity.push_back(m.velocity / share_of(modes, m));
    }
    return start;
}

std::vector<Touched> touched_by(const Modes& modes, const String& s) {
    std::vector<Touched> all;
    const auto add = [&](const LumpedBarrier& b) {
        all.push_back({b, footprint_weights(modes, b.position, b.width)});
    };
    for (const Barrier& barrier : s.barriers) add(std::get<LumpedBarrier>(barrier));
    std::size_t own = modes.beta.size() - s.masses.size();
    for (const Mass& m : s.masses) {
        add({m.position, m.width, 0, {m.stiffness}, m.exponent, m.contact_loss, m.loss_law});
        all.back().weights[own++] = -share_of(modes, m);
    }
    return all;
}

}  // namespace jvari

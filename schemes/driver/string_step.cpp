#include "schemes/driver/string_step.hpp"

namespace jvari {

StringPoints points_of(const String& s, double dt) {
    StringPoints p;
    if (s.thread) p.threads.push_back(*s.thread);
    p.pluck = s.pluck;
    p.mass = s.linear_density * s.length;
    p.length = s.length;
    p.tension = s.tension;
    p.dt = dt;
    return p;
}

void add_lumped(StringPoints& p, const String& s) {
    for (const Barrier& barrier : s.barriers) {
        const auto& b = std::get<LumpedBarrier>(barrier);
        p.contacts.add({b.stiffness.k, b.exponent}, b.height, b.contact_loss);
        p.positions.push_back(b.position);
    }
    if (s.thread) p.positions.push_back(s.thread->position);
}

}  // namespace jvari

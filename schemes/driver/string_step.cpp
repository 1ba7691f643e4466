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

void refuse_rigid(const Descriptor& scheme, const StringPoints& p, const double* start, bool in_series_only) {
    const auto refuse = [&](const std::string& why) { throw Refusal(std::string(scheme.name) + ": " + why); };
    if (in_series_only && !p.series)
        refuse("a rigid barrier needs compliance=matched, for a force that is known before the step needs something that gives way");
    for (int a = 0; a < p.contacts.count(); ++a) {
        if (!p.contacts.laws[a].rigid())
            refuse("a rigid barrier beside one that gives way; make all of them rigid, or give each a stiffness");
        if (const double inside = p.contacts.heights[a] - start[a]; inside > 1e-12 * p.length)
            refuse("the string starts " + std::to_string(inside * 1e6) + " um inside a rigid barrier; lower the barrier or start above it");
    }
}

}  // namespace jvari

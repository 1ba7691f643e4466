#include "schemes/driver/string_step.hpp"

#include "scenes/barrier.hpp"

namespace jvari {

StringPoints points_of(const Scene& scene, double dt) {
    const String& s = scene.strings.front();
    StringPoints p;
    p.masses = s.masses;
    p.taps = scene.taps;
    if (s.thread) p.threads.push_back(*s.thread);
    p.pluck = s.pluck;
    p.mass = s.linear_density * s.length;
    p.length = s.length;
    p.tension = s.tension;
    p.dt = dt;
    return p;
}

std::vector<Place> add_contacts(StringPoints& p, const String& s, int intervals) {
    std::vector<Place> all;
    int of = -1;  // barrier number
    const auto add = [&](const Place& place, const ContactLaw& law, double height, const auto& b) {
        all.push_back(place);
        p.positions.push_back(place.at.position);
        p.contacts.add(law, height, b.contact_loss, b.loss_law,
                       {0, of, static_cast<int>(s.barriers.size() + s.masses.size())},
                       place.at.sign);
    };
    for (const Barrier& barrier : s.barriers) {
        ++of;
        if (const auto* b = std::get_if<LumpedBarrier>(&barrier)) {
            add({{b->position, b->width, b->sign()}}, {b->stiffness.k, b->exponent},
                b->sign() * b->height, *b);
            continue;
        }
        const auto& b = std::get<ProfileBarrier>(barrier);
        const double dx = s.length / intervals;
        const auto [first, x] = nodes_on(b, s.length, intervals);
        if (x.empty())
            throw Refusal("no node of the grid lies on the barrier from " + std::to_string(b.from) +
                          " m to " + std::to_string(b.to) + " m: the spacing is " +
                          std::to_string(dx) + " m");
        const std::vector<double> height = heights(b.curve, x);
        for (std::size_t i = 0; i < x.size(); ++i)
            add({{x[i], 0}, first + static_cast<int>(i)}, {b.stiffness.K * dx, b.exponent},
                height[i], b);
    }
    for (const Mass& m : s.masses) {
        ++of;
        add({{m.position, m.width}}, {m.stiffness, m.exponent}, 0, m);
    }
    return all;
}

void add_lumped(StringPoints& p, const String& s) {
    add_contacts(p, s);
    if (s.thread) p.positions.push_back(s.thread->position);
}

void refuse_rigid(const Descriptor& scheme, const StringPoints& p, const double* start) {
    const auto refuse = [&](const std::string& why) {
        throw Refusal(std::string(scheme.name) + ": " + why);
    };
    for (int a = 0; a < p.contacts.count(); ++a) {
        if (!p.contacts.laws[a].rigid())
            refuse(
                "a rigid barrier beside one that gives way; make all of them rigid, or give each a "
                "stiffness");
        if (const double inside = p.contacts.heights[a] - start[a]; inside > 1e-12 * p.length)
            refuse("the string starts " + std::to_string(inside * 1e6) +
                   " um inside a rigid barrier; lower the barrier or start above it");
    }
}

void refuse_rest_in_powers(const Descriptor& scheme, const StringPoints& p) {
    for (const ContactLaw& law : p.contacts.laws)
        if (!p.start_force.empty() && law.alpha != 1)
            throw Refusal(std::string(scheme.name) +
                          ": does not stay at rest on a contact with an exponent other than 1, "
                          "where rounding grows from step to step; take modal_two_point");
}

}  // namespace jvari

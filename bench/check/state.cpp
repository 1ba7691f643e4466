// How much a scheme carries from step to step.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/check/judges.hpp"
#include "bench/check/scenes.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::check {

namespace {
std::optional<int> dofs_of(const Case& c) {  // none where it refuses
    try {
        return make_scheme(c.scheme, c.scene, c.settings)->dofs();
    } catch (const Refusal&) {
        return std::nullopt;
    } catch (const BadScene&) {
        return std::nullopt;
    }
}

// Displacement and velocity of each mode, or of each node of a grid, whose spacing no wave passes within a step; then a value for each
// contact, and a few for a filter at an end. A second plane has as many again. A profile has a contact at each node on it, or at the points
// of its own that a scheme says it has.
double contacts_on(const ProfileBarrier& profile, double length, double nodes, const Case& c) {
    const bool own =
        std::ranges::any_of(c.scheme.options, [](const Option& o) { return o.name == std::string(profile_points_option.name); });
    const double on_nodes = std::ceil(nodes * (profile.to - profile.from) / length);
    return own ? std::max(on_nodes, number_option(c.settings, profile_points_option)) : on_nodes;
}
int most_state(const Case& c, bool sized_by_modes) {
    double most = 0;
    for (const String& s : c.scene.strings) {
        const double speed = std::sqrt(s.tension / s.linear_density);
        const double nodes = sized_by_modes ? contract_modes : std::ceil(s.length * c.settings.sample_rate / speed);
        double contacts = 0;
        for (const Barrier& b : s.barriers) {
            const auto* profile = std::get_if<ProfileBarrier>(&b);
            contacts += profile ? contacts_on(*profile, s.length, nodes, c) : 1;
        }
        constexpr int at_an_end = 6;
        most += (2 * nodes + contacts + at_an_end) * (s.polarisation ? 2 : 1);
    }
    return static_cast<int>(most);
}
}  // namespace

Verdict carries_no_more_state(const Case& c) {
    const int dofs = dofs_of(c).value();
    if (dofs <= 0) return broken(fmt::format("says that it carries {} doubles", dofs));
    Case more = c;
    more.settings.modes = 2 * contract_modes;
    const int most = most_state(c, dofs_of(more).value_or(0) > dofs);
    if (dofs > most) return broken(fmt::format("carries {} doubles, where {} do", dofs, most));
    Case bare = c;  // without what it listens to, is struck by and rests on
    bare.scene.taps.resize(1);
    for (String& s : bare.scene.strings) {
        s.pluck.reset();
        s.thread.reset();
        s.barriers.clear();
        s.polarisation.reset();
    }
    std::erase_if(bare.scene.taps, [](const Tap& t) { return t.quantity != Quantity::displacement && t.quantity != Quantity::nut_force; });
    if (const auto other = dofs_of(bare); other && *other > dofs)
        return broken(fmt::format("carries {} doubles without contact, thread and pluck, and {} with them", *other, dofs));
    Case quiet = c;
    quiet.scene.taps.resize(1);
    if (const auto other = dofs_of(quiet); other && *other != dofs)
        return broken(fmt::format("carries {} doubles for one tap, and {} for {}", *other, dofs, c.scene.taps.size()));
    return kept();
}

}  // namespace jvari::bench::check

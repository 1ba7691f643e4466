#include "reference/profile_points.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/barrier.hpp"
#include "schemes/making.hpp"

namespace jvari {

ProfilePoints profile_points(const Settings& settings) {
    if (option(settings, nodes_option) == "grid") return {0};
    const double count = number_option(settings, nodes_option);
    if (count != std::floor(count) || count < 1 || count > most_points)
        throw Refusal("option nodes: expected grid, or a whole number from 1 to " +
                      std::to_string(most_points));
    return {static_cast<int>(count)};
}

String with_points(String s, int modes, ProfilePoints points) {
    bool profiles = false;
    s.barriers = without_profiles(s, [&](const ProfileBarrier& b) {
        profiles = true;
        if (points.count > 0) return lumped(b, points.count);
        const auto x = nodes_on(b, s.length, modes + 1).x;
        if (x.empty())
            throw Refusal("no node of a grid of " + std::to_string(modes) +
                          " lies on a profile barrier; ask for more modes, or for nodes");
        return lumped(b, x, s.length / (modes + 1));
    });
    if (profiles && s.barriers.size() > most_points)
        throw Refusal("the profiles come to " + std::to_string(s.barriers.size()) +
                      " points of contact; the references take " + std::to_string(most_points) +
                      " at most");
    return s;
}

}  // namespace jvari

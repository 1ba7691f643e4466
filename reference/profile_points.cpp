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
    std::vector<Barrier> barriers;
    bool profiles = false;
    for (const Barrier& barrier : s.barriers) {
        const auto* b = std::get_if<ProfileBarrier>(&barrier);
        if (!b) {
            barriers.push_back(barrier);
            continue;
        }
        profiles = true;
        const bool grid = points.count == 0;
        const double spacing = grid ? s.length / (modes + 1) : (b->to - b->from) / points.count;
        const auto x = grid ? nodes_on(*b, s.length, modes + 1).x : middles(*b, points.count);
        if (x.empty())
            throw Refusal("no node of a grid of " + std::to_string(modes) +
                          " lies on a profile barrier; ask for more modes, or for nodes");
        for (const LumpedBarrier& point : lumped(*b, x, spacing)) barriers.push_back(point);
    }
    if (profiles && barriers.size() > most_points)
        throw Refusal("the profiles come to " + std::to_string(barriers.size()) +
                      " points of contact; the references take " + std::to_string(most_points) +
                      " at most");
    s.barriers = std::move(barriers);
    return s;
}

}  // namespace jvari

// Source: Issanchou et al. 2016, eq 13 and section 3.2 (a force density at a node); van Walstijn et
// al. 2016, eq 20 (weights of a footprint).
#include "schemes/spatial/spatial_ports.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/barrier.hpp"
#include "schemes/making.hpp"

namespace jvari {

namespace {
constexpr double most_weights = 1 << 27;  // nodes x modes: a gigabyte

// sin(pi numerator/intervals), with the argument reduced in integers
double sine(long numerator, long intervals) {
    long turn = numerator % (2 * intervals);
    const double sign = turn >= intervals ? -1 : 1;
    turn %= intervals;
    return sign * std::sin(std::numbers::pi * double(std::min(turn, intervals - turn)) /
                           double(intervals));
}

int node_at(double position, double length, int intervals) {  // 0: between nodes
    const double i = position / length * intervals, node = std::round(i);
    return std::abs(i - node) <= near_node * intervals && node >= 1 && node < intervals
               ? static_cast<int>(node)
               : 0;
}

}  // namespace

// Row in the matrix S of (13), without its factor sqrt(2/L).
std::vector<double> node_weights(int intervals, int node) {
    std::vector<double> w;
    for (int j = 1; j < intervals; ++j) w.push_back(sine(long(j) * node, intervals));
    return w;
}

int intervals_for(const String& s, const Settings& settings) {
    // modes_of refuses the surplus mode
    if (settings.modes > 0) return std::min(settings.modes, most_modes + 1) + 1;
    const int least = modes_of(s, settings).count() + 1;
    int intervals = least;
    for (const Barrier& barrier : s.barriers)
        if (const auto* profile = std::get_if<ProfileBarrier>(&barrier))
            intervals = std::max(
                intervals,
                static_cast<int>(std::min(std::ceil(8 * s.length / (profile->to - profile->from)),
                                          most_modes + 2.0)));
    const auto footprints = footprints_of(s);
    const auto on_nodes = [&](int n) {
        return std::all_of(footprints.begin(), footprints.end(), [&](const Footprint& f) {
            return f.width != 0 || node_at(f.position, s.length, n) != 0;
        });
    };
    for (int n = intervals; n <= 4 * intervals; ++n)
        if (on_nodes(n)) return n;
    return intervals;
}

void place_contacts(ThreePointProblem& p) {
    const int intervals = p.update.intervals;
    const std::string scene = " of scene " + p.scene.name;
    std::vector<Place> places = add_contacts(p.points, p.string(), intervals);
    std::vector<int> nodes;
    for (Place& place : places) {
        if (place.node == 0 && place.at.width == 0)
            place.node = node_at(place.at.position, p.string().length, intervals);
        if (place.node == 0) continue;
        if (std::find(nodes.begin(), nodes.end(), place.node) != nodes.end())
            throw Refusal("modal_spatial_newton: two barriers" + scene + " act on node " +
                          std::to_string(place.node) + "; it solves one contact per node");
        nodes.push_back(place.node);
    }
    if (static_cast<double>(nodes.size()) * intervals > most_weights)
        throw Refusal("modal_spatial_newton: " + std::to_string(nodes.size()) + " of " +
                      std::to_string(intervals - 1) + " nodes touch a barrier" + scene +
                      ", more than fit in memory; ask for fewer modes");
    for (const Place& place : places)
        p.update.ports.push_back(
            {place.node != 0 ? node_weights(intervals, place.node)
                             : footprint_weights(p.modes, place.at.position, place.at.width),
             place.node});
}

}  // namespace jvari

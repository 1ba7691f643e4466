// Source: Issanchou et al. 2016, section 3.2 (a force density at a node); van Walstijn et al. 2016, eq 20 (weights of a footprint).
#include "schemes/spatial/spatial_ports.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/barrier.hpp"
#include "schemes/making.hpp"

namespace jvari {

namespace {
constexpr double most_weights = 1 << 27;  // of nodes on modes: a gigabyte

double sine(long numerator, long intervals) {  // sin(pi numerator/intervals), its argument reduced in integers
    long turn = numerator % (2 * intervals);
    const double sign = turn >= intervals ? -1 : 1;
    turn %= intervals;
    return sign * std::sin(std::numbers::pi * double(std::min(turn, intervals - turn)) / double(intervals));
}

int node_at(double position, double length, int intervals) {  // 0: between nodes
    const double i = position / length * intervals, node = std::round(i);
    return std::abs(i - node) <= near_node * intervals && node >= 1 && node < intervals ? static_cast<int>(node) : 0;
}

}  // namespace

std::vector<double> node_weights(int intervals, int node) {
    std::vector<double> w;
    for (int j = 1; j < intervals; ++j) w.push_back(sine(long(j) * node, intervals));
    return w;
}

namespace {
struct PointsOf {
    const String& s;
    const Modes& modes;
    int intervals;
    const std::string& scene;
    SpatialPorts& out;

    void add(ContactPoint point, int node, std::vector<double> weights) const {
        for (const Port& port : out.ports)
            if (node != 0 && port.node == node)
                throw Refusal("modal_spatial_newton: two barriers of scene " + scene + " act on node " + std::to_string(node) +
                              "; it solves one contact per node");
        out.points.push_back(point);
        out.ports.push_back({std::move(weights), node});
    }
    void operator()(const LumpedBarrier& b) const {
        const ContactPoint point{{b.stiffness.k, b.exponent}, b.height, b.contact_loss, b.position};
        const int node = b.width == 0 ? node_at(b.position, s.length, intervals) : 0;
        add(point, node, node != 0 ? node_weights(intervals, node) : footprint_weights(modes, b.position, b.width));
    }
    void operator()(const ProfileBarrier& b) const {
        const auto [first, x] = nodes_on(b, s.length, intervals);
        if (x.empty())
            throw Refusal("modal_spatial_newton: no node of " + std::to_string(intervals - 1) + " lies on the profile barrier of scene " +
                          scene + "; ask for more modes");
        if (static_cast<double>(x.size()) * intervals > most_weights)
            throw Refusal("modal_spatial_newton: " + std::to_string(x.size()) + " of " + std::to_string(intervals - 1) +
                          " nodes lie on the profile barrier of scene " + scene + ", more than fit in memory; ask for fewer modes");
        const double dx = s.length / intervals;
        int node = first;
        for (const double height : heights(b.curve, x)) {
            add({{b.stiffness.K * dx, b.exponent}, height, b.contact_loss, node * dx}, node, node_weights(intervals, node));
            ++node;
        }
    }
};
}  // namespace

int intervals_for(const String& s, const Settings& settings) {
    if (settings.modes > 0) return std::min(settings.modes, most_modes + 1) + 1;  // modes_of refuses the one too many
    const int least = modes_of(s, settings).count() + 1;
    int intervals = least;
    for (const Barrier& barrier : s.barriers)
        if (const auto* profile = std::get_if<ProfileBarrier>(&barrier))
            intervals =
                std::max(intervals, static_cast<int>(std::min(std::ceil(8 * s.length / (profile->to - profile->from)), most_modes + 2.0)));
    const auto on_nodes = [&](int n) {
        return std::all_of(s.barriers.begin(), s.barriers.end(), [&](const Barrier& barrier) {
            const auto* b = std::get_if<LumpedBarrier>(&barrier);
            return !b || b->width != 0 || node_at(b->position, s.length, n) != 0;
        });
    };
    for (int n = intervals; n <= 4 * intervals; ++n)
        if (on_nodes(n)) return n;
    return intervals;
}

SpatialPorts spatial_ports(const String& s, const Modes& modes, int intervals, const std::string& scene, bool coupled_may_be) {
    SpatialPorts out;
    for (const Barrier& barrier : s.barriers) std::visit(PointsOf{s, modes, intervals, scene, out}, barrier);
    const bool all_nodes = std::all_of(out.ports.begin(), out.ports.end(), [](const Port& p) { return p.node != 0; });
    if (out.points.size() > 1 && !all_nodes && !coupled_may_be)
        throw Refusal("modal_spatial_newton solves several contacts only where each is a node of the grid; in scene " + scene +
                      " a barrier with a footprint or between nodes is coupled to another contact");
    if (out.points.size() > 1 && s.thread && !coupled_may_be)
        throw Refusal("modal_spatial_newton couples a thread to one contact point; scene " + scene + " has " +
                      std::to_string(out.points.size()) + " with " + std::to_string(intervals - 1) + " nodes");
    return out;
}

}  // namespace jvari

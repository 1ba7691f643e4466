#include "bench/compare/pareto.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

namespace {
bool sound(const Point& p) {
    return std::isfinite(p.cost) && std::isfinite(p.error);
}
bool tie(const Point& a, const Point& b) {
    return a.cost_lower <= b.cost_upper && b.cost_lower <= a.cost_upper;
}
bool beats(const Point& a, const Point& b) {
    if (!sound(a)) return false;
    return a.error < b.error ? a.cost <= b.cost || tie(a, b) : a.error == b.error && a.cost < b.cost && !tie(a, b);
}
}  // namespace

std::vector<bool> pareto_front(std::span<const Point> points) {
    std::vector<bool> front;
    for (const Point& p : points)
        front.push_back(sound(p) && std::none_of(points.begin(), points.end(), [&p](const Point& other) { return beats(other, p); }));
    return front;
}

}  // namespace jvari

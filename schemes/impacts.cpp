#include "schemes/impacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jvari {

Impacts::Impacts(const String& s) {
    for (const Barrier& b : s.barriers)
        profile_.push_back(std::holds_alternative<ProfileBarrier>(b));
    profile_.resize(s.barriers.size() + s.masses.size());
    last_.resize(profile_.size());
}

// A scheme that touches a profile at points has equally many points on each profile.
int Impacts::barrier_of(const BarrierOf& of) const {
    const int barriers = static_cast<int>(profile_.size()),
              profiles = static_cast<int>(std::count(profile_.begin(), profile_.end(), 1));
    const int points = profiles > 0 ? (of.barriers - barriers + profiles) / profiles : 1;
    int own = 0;
    for (int behind = 0; own < barriers; ++own)
        if (behind += profile_[own] ? points : 1; of.barrier < behind) break;
    return own;
}

void Impacts::add(const Impact& part) {
    constexpr double rounding = 1e-12;  // in times [s]
    Last& last = last_[part.barrier];
    if (last.row < 0 || part.start > all_[last.row].end + rounding) {
        last.row = static_cast<int>(all_.size());
        all_.push_back(part);
        return;
    }
    Impact& row = all_[last.row];
    row.largest_force = std::max(row.largest_force, part.largest_force);
    row.impulse += part.impulse;
    row.energy_lost += part.energy_lost;
    row.speed_out = part.speed_out;
    if (part.start < row.start + rounding) row.speed_in = std::fmax(row.speed_in, part.speed_in);
    row.end = std::max(row.end, part.end);
}

void Impacts::step(const BarrierOf& of, int a, const Step& s) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    if (points_.size() <= static_cast<std::size_t>(a)) points_.resize(a + 1);
    Point& point = points_[a];
    const double speed = s.moved / s.span;
    const int barrier = barrier_of(of);
    Last& last = last_[barrier];
    const bool touches = s.force != 0 || s.lost != 0;  // without a force by a clipped loss
    if (touches) {
        last = {last.row, s.force + (s.to == last.until ? last.force : 0), s.to};
        add({barrier, s.to - s.lasts, s.to, last.force, s.force * s.lasts,
             point.known && point.speed < 0 ? -point.speed : unknown, unknown, s.lost});
    } else if (point.touches) all_[last.row].speed_out = speed > 0 ? speed : unknown;
    point = {speed, true, touches};
}

}  // namespace jvari

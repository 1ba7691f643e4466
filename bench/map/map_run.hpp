// Runs the maps of a suite: every point, then the boundaries along x by bisection. Each point is
// content-addressed and kept as DIR/points/<id>.json, so that a suite which was stopped goes on
// where it was and comes to the same tables. Processes that share DIR run each point once.
#pragma once

#include <string>
#include <vector>

#include "bench/map/trial.hpp"
#include "bench/store/system/listener.hpp"
#include "schemes/scheme.hpp"

namespace jvari::bench::map {

struct PointPlace {  // on a map
    const Map* map;
    const Descriptor* scheme;
    std::string x, y;  // "" for a map without y
};
Trial trial_at(const PointPlace&);

struct JudgedPoint {
    PointPlace at;
    Tried tried;
};
struct Boundary {
    const Map* map;
    const Descriptor* scheme;
    std::string y;
    study::Verdict low, high;            // outcomes on its sides
    std::string x_low, x_high;           // between them it lies
    double theory;                       // NaN where there is none
    double relative_difference() const;  // of the middle from theory
};
struct MapRun {
    std::vector<JudgedPoint> points;   // in the order of the file: map, scheme, y, x
    std::vector<Boundary> boundaries;  // in that order
    int ran = 0, read_back = 0;        // points, those of bisections included
};

// Throws what a scene or a name that is none throws, before anything is run.
MapRun run_maps(const std::vector<Map>&, const compare::Catalogue&, const MapRequest&,
                const store::Listener&);

// Bisection of a change between two outcomes along one axis: `verdict_at(x)` is asked at most
// `times` times, at the geometric mean of positive numbers and the arithmetic of others, and not
// between neighbours where only `whole` numbers count. Where a third outcome lies between, the
// search goes on towards where stability ends, and where both sides are stable, or neither is,
// towards the lower.
struct Bracket {
    double low, high;
    study::Verdict at_low, at_high;
};
template <class VerdictAt>
Bracket bisect(Bracket b, int times, bool whole, VerdictAt verdict_at);

// ---- Boundaries that are known, for maps to be compared with: those that schemes state as their
// limit (Descriptor::limit), and
//
//   nyquist         the highest mode's frequency is half the rate
//
// Of the schemes in the program:
//   grid_limit      the spacing of the grid is the least that is stable (finite_difference.hpp)
//   penalty_limit   the highest root of the string in lasting contact passes z = -1
//                   (modal_explicit_penalty.cpp)

std::vector<std::string> theories();

// For which motion it holds: "lasting contact: where the string parts from the barrier the boundary
// is elsewhere".
std::string motion_of(const std::string& theory);

// Positive on the sound side, 0 on the boundary; NaN where the theory has nothing to say of the
// scheme.
double theory_margin(const std::string& theory, const Descriptor&, const Scene&, const Settings&);

}  // namespace jvari::bench::map

#include <cmath>

template <class VerdictAt>
jvari::bench::map::Bracket jvari::bench::map::bisect(Bracket b, int times, bool whole,
                                                     VerdictAt verdict_at) {
    for (int n = 0; n < times; ++n) {
        double middle = b.low > 0 ? std::sqrt(b.low) * std::sqrt(b.high) : 0.5 * (b.low + b.high);
        if (whole) middle = std::round(middle);
        if (!(middle > b.low && middle < b.high)) break;
        const study::Verdict v = verdict_at(middle);
        const bool stable = study::is_stable(b.at_low),
                   ends = stable != study::is_stable(b.at_high);
        const bool lower =
            v == b.at_low || (v != b.at_high && ends && study::is_stable(v) == stable);
        if (lower) b.low = middle, b.at_low = v;
        else b.high = middle, b.at_high = v;
    }
    return b;
}

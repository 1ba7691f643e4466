// Sizes at which a reference runs: numbers of modes, and numbers of points for a profile.
#pragma once

#include <string>
#include <vector>

#include "bench/study/reference.hpp"

namespace jvari::bench::study {

struct Size {
    int modes, points;  // points for a profile; 0: none, or the nodes of a grid
    bool operator==(const Size&) const = default;
    std::string text() const;  // "266 modes and 64 points"
};

// Sizes for a reference. From one to the next either the modes double or the points do, never both:
// each difference then shows the effect of one of them. By default there is a single size, from
// which they are doubled; a profile starts with a quarter of its modes and of the default points.
// If the user asks for a number of modes or points, a quarter and a half of both run first, because
// any finite number leaves something out.
struct Sizes {
    std::vector<Size> each;  // the coarsest first
    bool doubled = false;    // true: doubling continues beyond the last entry of `each`
    int measured = 0;        // number of modes in the strings' tables; 0: no tables
    int most_modes() const;
};
// `modes`: number asked for, 0 if none. `begin`: number in the cells, 0 for their default.
Sizes sizes_of(const ReferenceChoice&, const Scene&, int modes, int begin);

// True if a run with this size takes at most about ten to twenty seconds, times `effort`. The
// scene's duration is counted in rows, so that its unit does not matter.
bool within_budget(const Descriptor& reference, const Scene&, double tap_rate, const Size&,
                   double effort = 1);

ReferenceChoice sized(ReferenceChoice, const Size&);

}  // namespace jvari::bench::study

// Sizes that a reference is run at: how many modes, and how many points for a profile.
#pragma once

#include <string>
#include <vector>

#include "bench/study/reference.hpp"

namespace jvari::bench::study {

struct Size {
    int modes, points;  // points of a profile; 0: none, or the nodes of a grid
    Size twice(int most) const { return {std::min(2 * modes, most), 2 * points}; }
    bool operator==(const Size&) const = default;
    std::string text() const;  // "266 modes and 64 points"
};

// Unasked: one size, from which both are doubled. Where a number of modes or of points is asked
// for: that, and before it a half and a quarter of both, which tell what it leaves out. A certain
// number of points leaves something out as a number of modes does.
struct Sizes {
    std::vector<Size> each;  // the coarsest first
    bool doubled = false;    // further than the last of `each`
    int measured = 0;        // modes of the strings' tables; 0: no tables
    int most_modes() const;
};
// `modes`: asked for; 0: none are. `begin`: modes that the cells carry; 0: as many as they take
// unasked.
Sizes sizes_of(const ReferenceChoice&, const Scene&, int modes, int begin);

// Where a run of this size takes about ten to twenty seconds at most, times `effort`. The time that
// the scene lasts is counted in rows, so that its unit does not matter.
bool within_budget(const Descriptor& reference, const Scene&, double tap_rate, const Size&,
                   double effort = 1);

ReferenceChoice sized(ReferenceChoice, const Size&);

}  // namespace jvari::bench::study

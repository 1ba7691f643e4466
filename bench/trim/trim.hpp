// jvari trim as a function: search, verification by another start, needs, and what was not tried.
#pragma once

#include <algorithm>

#include "bench/trim/needs.hpp"

namespace jvari::bench::trim {

struct Verified {
    int start;
    std::string said;           // "a triangle at 0.3 m, 0.00152 m"
    double error, certificate;  // certificate NaN: unknown
    bool within;
    bool judged_by;  // the search knew this start
    bool decided;    // Judge::certain
};

struct Trimmed {
    Scene whole, scene;  // the trimmed one as long as it was judged
    double own_duration;
    Path path;
    std::vector<Spread> costs;  // of the path's steps, timed in turn
    std::vector<Need> needs;
    std::vector<Verified> verified;  // of all starts
    std::vector<Truth> truths;       // of them
    std::vector<std::string> not_tried;
    int judged, read_back;
    int independent() const {  // how many starts verified it that the search did not know
        return static_cast<int>(std::ranges::count_if(verified, [](const Verified& v) { return v.decided && !v.judged_by; }));
    }
    const Step& full() const { return path.steps.front(); }
    const Step& last() const { return path.steps.back(); }
};

// The model is verified by all starts. Where it fails, the start where it fails worst joins those that the search is judged by. Throws
// Refusal where the reference is not certain enough to tell what is within.
Trimmed trimmed(Judge&, const Request&, const compare::Catalogue&, const store::Listener&);

}  // namespace jvari::bench::trim

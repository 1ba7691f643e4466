// jvari trim as a function: search, verification by another start, needs, and what was not tried.
#pragma once

#include <algorithm>

#include "bench/trim/search.hpp"

namespace jvari::bench::trim {

// What each part of a scene is needed for: the error if it alone is left out, and what it costs.
struct Need {
    std::string part, becomes;
    // of the whole scene at the trimmed model's settings without it, worst of the starts; NaN: no
    // such model runs
    double error;
    // of that model's cost, a share; negative where the rest costs more. NaN: not timed
    double saved;
    // of the trimmed model, the part's state turned round: put back, or left out as well
    double error_in_trimmed;
    bool left_out;  // of the trimmed model
    bool needed;    // left out alone, the error is beyond the tolerance
};

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
        return static_cast<int>(std::ranges::count_if(
            verified, [](const Verified& v) { return v.decided && !v.judged_by; }));
    }
    const Step& full() const { return path.steps.front(); }
    const Step& last() const { return path.steps.back(); }
};

// The model is verified by all starts. Where it fails, the start where it fails worst joins those
// that the search is judged by. Throws Refusal where the reference is not certain enough to tell
// what is within.
Trimmed trimmed(Judge&, const Request&, const compare::Catalogue&, const store::Listener&);

}  // namespace jvari::bench::trim

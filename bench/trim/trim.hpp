// jvari trim as a function: search, verification by another start, needs, and what was not tried.
#pragma once

#include "bench/trim/needs.hpp"

namespace jvari::bench::trim {

struct Verified {
    int start;
    std::string said;  // "a triangle at 0.3 m, 0.00152 m"
    double error, certificate;
    bool within;
    bool judged_by;  // the search knew this start
};

struct Trimmed {
    Scene whole, scene;  // the trimmed one as long as it was judged
    double own_duration;
    Path path;
    std::vector<Spread> costs;  // of the path's steps, timed in turn
    std::vector<Need> needs;
    std::vector<Verified> verified;
    std::vector<Truth> truths;  // of the starts that were used
    std::vector<std::string> not_tried;
    int judged, read_back;
    bool independent() const {
        return !verified.empty() && !verified.back().judged_by;
    }  // a start verified it that the search did not know
    const Step& full() const { return path.steps.front(); }
    const Step& last() const { return path.steps.back(); }
};

// The model is verified by a start that the search did not know. Where it fails there, that start joins those that the search is judged by,
// and the next one verifies.
Trimmed trimmed(Judge&, const Request&, const compare::Catalogue&, const store::Listener&);

}  // namespace jvari::bench::trim

// What each part of a scene is needed for: the error if it alone is left out, and what it costs.
#pragma once

#include "bench/trim/search.hpp"

namespace jvari::bench::trim {

struct Need {
    std::string part, becomes;
    double error;             // of the whole scene at the trimmed model's settings without it, worst of the starts; NaN: no such model runs
    double saved;             // of that model's cost, a share; negative where the rest costs more. NaN: not timed
    double error_in_trimmed;  // of the trimmed model, the part's state turned round: put back, or left out as well
    bool left_out;            // of the trimmed model
    bool needed;              // left out alone, the error is beyond the tolerance
};
std::vector<Need> needs_of(Judge&, const Model& whole, const Model& trimmed, const std::vector<int>& starts);

}  // namespace jvari::bench::trim

// The cheapest model of a scene within a tolerance.
//
// A model is a set of parts left out, a scheme with its options, a rate and a number of modes.
//   0. The whole scene, compliance the scheme's own, as published: what the trimmed model is held
//   against.
//   1. Of the whole scene, less the taps that are not judged: for each scheme, own and matched
//   compliance, and each rate the fewest modes
//   that serve; the cheapest stays (cheapest_settings.hpp).
//   2. In turn the part that saves most for the error it costs is left out, the fewest modes at
//   half, the same and twice the rate are
//      sought anew, and what is cheaper stays. Parts that went before are put back in the same way:
//      what one part costs depends on others.
//   3. Step 1 for what is left: a plainer scene is open to more schemes. What is cheaper stays, and
//   step 2 begins again.
// Cheaper is by a twentieth or more: a part that saves less stays, and so do losses unless the
// decay is judged. Of costs that are closer the more accurate model is taken, so that a clock's
// noise decides nothing. Costs are processor time, so that what else the machine does hardly
// counts.
#pragma once

#include <string>
#include <vector>

#include "bench/trim/judge.hpp"

namespace jvari::bench::trim {

struct Step {
    std::string change;  // to the model of the step before
    Model model;
    // worst of the starts that it is judged by
    double error = std::numeric_limits<double>::quiet_NaN();
    double cost = std::numeric_limits<double>::quiet_NaN();  // [s of processor per s]
    bool within = false;
};

struct Path {
    // [0]: the whole scene without matched compliance; the last is the trimmed model
    std::vector<Step> steps;
    bool found = false;              // the last step is within the tolerance
    std::vector<std::string> tried;  // schemes that represent the whole scene
    // variants of the whole scene, after a first look: "name (its errors)"
    std::vector<std::string> passed_over;
};

// Judged by these starts.
Path search(Judge&, const std::vector<const Descriptor*>& schemes, const std::vector<int>& starts,
            const store::Listener&);

}  // namespace jvari::bench::trim

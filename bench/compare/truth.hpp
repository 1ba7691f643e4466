// What every error is measured against: the motion of the scene, and not of the model that a comparison happens to carry.
//
// A string cut off at 133 modes is another string: its nut force after half a second has little to do with that of the scene. So the
// reference does not take its modes from the cells. From those below 20 kHz, and from the points that stand for a profile unasked, both are
// doubled until a doubling changes the headline figure by less than is `enough`, or until the next would cost more than `budget`. It then
// says so. What the last doubling changed is part of what the reference is certain to, on every tap and window, and so is what all further
// ones may change together: and_further_ones (certificate.hpp), less the one that was made.
//
// Enough is `settled`, a tenth of the finest accuracy that the table of the cheapest asks for. A comparison on its own is content with a
// tenth of the smallest error that it shows. An error of less than ten times what the reference is certain to is shown as a bound
// (bound.hpp).
#pragma once

#include <optional>

#include "bench/compare/compare_plan.hpp"

namespace jvari::bench::compare {

constexpr double settled = 1e-4;
constexpr double budget = 6e5;  // [s], of motion times modes^2 times 1 + points^2/4 times how dear the reference is: some twenty seconds

// The reference with the modes of the truth: found where `modes` is 0, else so many. A stand-in is left as it is. `said` tells how far it
// went. `enough`, of the truth so far: by how much a doubling may change the headline figure; absent: `settled`. Throws as run_reference.
struct Truth {
    Reference reference;
    std::string said;
    double horizon = std::numeric_limits<double>::quiet_NaN();  // [s], of the headline against itself with half the modes and points
};
Truth run_truth(const std::vector<ReferenceChoice>&, const Scene&, int modes, int jobs, const store::Listener&,
                double time_limit = HUGE_VAL, const std::function<double(const Trace&)>& enough = {});

}  // namespace jvari::bench::compare

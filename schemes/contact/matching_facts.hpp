// Where a compliance in series with the contacts may do harm: a fact for each cause that is known (docs/compliance-matching.md, Limits).
//
// The modes that were cut off yield, and they also carry energy away. The compliance stands for the first alone.
#pragma once

#include "schemes/contact/impact_share.hpp"
#include "schemes/contact/series_points.hpp"

namespace jvari {

// Above these a run with compliance=matched may err by more than one without. Found by a random search (tests/fuzz/README.md).
struct MatchingLimit {
    FactName fact;
    double most;
    const char* cause;
};
inline constexpr MatchingLimit matching_limits[] = {
    {facts::impact_share, 0.25, "the string strikes its obstacle instead of wrapping around it"},
};

inline std::vector<Fact> matching_facts(const SeriesPoints& p, const ImpactShare& impacts) {
    std::vector<Fact> f;
    if (p.barrier) f.push_back({facts::impact_share, impacts.value()});
    return f;
}

}  // namespace jvari

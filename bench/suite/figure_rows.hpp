// The row facets that figures are drawn from; figure_facets.hpp says what each holds.
#pragma once

#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

store::Table trace_rows(const MeasuredCell&);
store::Table extent_rows(const MeasuredCell&);
store::Table profile_rows(const MeasuredCell&);
store::Table envelope_rows(const MeasuredCell&);
store::Table centroid_rows(const MeasuredCell&);

}  // namespace jvari::bench::suite

// The row facets that figures are drawn from; figure_facets.hpp says what each holds.
#pragma once

#include "bench/suite/row_facet.hpp"

namespace jvari {

Table trace_rows(const MeasuredCell&);
Table extent_rows(const MeasuredCell&);
Table profile_rows(const MeasuredCell&);
Table envelope_rows(const MeasuredCell&);
Table centroid_rows(const MeasuredCell&);

}  // namespace jvari

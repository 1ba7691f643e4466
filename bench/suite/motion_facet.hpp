// The row facet `motion`: the shape of string 0 over a short window, frame by frame, and the force of its barriers, of a cell and of its
// reference; what the page's moving string is drawn of. Both are run again over that window alone, with taps along the string.
//
// motion.csv, per cell and once per reference: from_s, step_s, positions [m], scales [m] (what 32767 is at each), shape (frame by frame, 16
// bit as base64), force_scale [N], force, obstacle (x:height [m], along the barriers).
#pragma once

#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

store::Table motion_rows(const MeasuredCell&);
void write_motion(const std::filesystem::path& folder, const store::Table& gathered);

}  // namespace jvari::bench::suite

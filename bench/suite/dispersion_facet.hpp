// Dispersion of a cell: frequency and decay rate of the string's first modes against the true ones, twice: by the scheme's own recursion
// (Scheme::free_modes) and from the trace by the matrix pencil of analysis/dispersion.hpp.
#pragma once

#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

constexpr int dispersion_modes = 30;  // at most

// Columns mode, frequency_hz, own_cents, trace_cents, decay_per_s, own_decay_per_s, trace_decay_per_s, note; an empty field is not known,
// and `note` says why the trace says nothing. A string that a thread or a barrier touches has no modes of its own in the trace.
store::Table dispersion_rows(const MeasuredCell&);

}  // namespace jvari::bench::suite

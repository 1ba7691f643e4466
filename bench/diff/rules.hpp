// How far a number of a cell may move before it has changed, and which way is worse.
//
// An error figure: 1000 times its noise floor (what a relative change of the start of 1e-12 makes
// of the reference, on that scene, window and tap) and 1e-9 of the figure; a centroid difference is
// the difference of two tracks of a kilohertz and blind to the scale of the start, so 1e-9 of a
// kilohertz is added to its own. So the tolerance covers what relative changes of 1e-9 would do.
// Another vector width changes the order of sums: with SSE2 in place of AVX-512, 5 of 6632 figures
// of the smoke suite moved by more than 100 floors, none but centroids by more than 350. A changed
// equation is out by far more. Facts and the modes' own frequencies follow from closed forms: 1e-9.
// What is read from a trace by the matrix pencil: 1e-4 cents.
//
// An error against a reference with the cell's modes has the floor of that against the scene, if
// not less than what follows. What follows the motion and has no noise floor of its own (contact
// force, penetration, certificates of stand-ins) may move by 1000 times the largest floor of the
// row and 1e-6 of itself; residuals of the ledger by 1e-9 and that; an instant by two rows; a noise
// floor, which is rounding itself, tenfold; what iterations counted and left, by a hundredth.
//
// An error that moved by more than that got worse or better if it moved by more than both
// certificates together. Otherwise neither side knows the true error that well, and the error only
// moved. The certificate of the later side counts no more than that of the earlier one, and a
// certificate that grew is worse itself: a result cannot be excused by knowing less.
// A number that was known and no longer is, is worse.
#pragma once

#include <string>

#include "bench/store/records.hpp"

namespace jvari::bench::diff {

enum class Turn { same, moved, better, worse };
const char* name_of(Turn);

bool is_cost(const std::string& column);     // of a clock
bool is_skipped(const std::string& column);  // a name, or what follows from the rest
// an error, a certificate or a residual: it gets worse or better
bool is_judged(const std::string& column);

// A field of a cell that is in both tables; a column that one of them lacks is empty there.
Turn turn_of(const std::string& column, const store::Table& before, std::size_t i,
             const store::Table& after, std::size_t k);

// A field of dispersion.csv.
Turn dispersion_turn(const std::string& column, double before, double after);

}  // namespace jvari::bench::diff

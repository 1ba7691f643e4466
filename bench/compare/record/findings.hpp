// What a set of cells says: the Pareto front of cost and error, where a difference that is no
// finding decides nothing; observed orders of convergence; and what to be warned of: a clock that
// cannot be believed, runs in which matched compliance did harm.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/compare.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::compare {

// ---- The front

struct Point {
    // median and quartiles; all the same for a cost that does not scatter
    double cost, cost_lower, cost_upper;
    // brought up to its noise floor and certificate by the caller: what lies below is a tie
    double error;
    double certificate = 0;  // the error is known to so much
};

// A point is on the front where no other is surely better: another whose error is less by more than
// both certificates at a cost that is less or a tie, or with an error no larger at a cost that is
// surely less. A point without a finite cost and error is never on it.
std::vector<bool> pareto_front(std::span<const Point>);

// The cells with `pareto` said: 1 for those on the front of `cost_s_per_s` and the headline error
// of their scene at their point of a sweep that are trusted and whose error is known.
study::Cells with_front(study::Cells);

// ---- Orders, per window and tap: cells fitted over their rates (analysis/convergence.hpp)

// Of a series of two rates or more that can tell (fall_over_rates).
struct ObservedOrder {
    std::size_t first;  // cell of the series
    std::size_t measure;
    std::string tap;
    double modes;  // NaN where they change with the rate, as a grid's do
    Order order;
    double from_hz, to_hz;
};
std::vector<ObservedOrder> convergence_of(const study::Cells&);
// Columns scene, <swept keys>, scheme, options, modes, tap, window, order, half_width (of the 95 %
// interval; empty with two points), points, from_hz, to_hz.
store::Table convergence_table(const study::Cells&);

// Of each series of cells that differ in the rate alone whose error surely rises with it, by more
// than a fifth over the headline's window: the cells of its lowest and its highest rate. Likewise
// where that error falls and the third octaves' difference rises, by 1 dB at least.
struct Rising {
    std::size_t low, high;
    std::string text;  // "its error rises with the rate, from 1.2 % at 44100 Hz to 3.4 %"
};
std::vector<Rising> rising_with_the_rate(const study::Cells&);

// ---- Warnings

// Half the distance of the quartiles of the cost over its median, of the middle one of the timed
// cells; NaN where none was timed.
double median_spread(const study::Cells&);
// Above a fifth: the sentence that says so, else "".
std::string busy_text(const study::Cells&);
// Of cells that differ in nothing but compliance=own and matched: those in which a tap's error,
// over the headline's window, is surely more than 1.2 times that of its own sibling; the sentence
// that counts them and names the worst, else "".
std::string harm_text(const study::Cells&);

// Of each series the cause that explains the error at its highest rate, or that it rises; else "".
std::string cause_text(const study::Cells&);

std::vector<std::string> warnings_of(const study::Cells&);  // all of these that say something

// ---- Advice, held against the reference

// Whether the cell with the settings that were advised has the error that was promised.
struct Verdict {
    enum class Says { held, not_held, not_known } says = Says::not_known;
    std::optional<std::size_t> cell{};
    Bound bound{};       // of its error
    std::string text{};  // "the advice held: 0.38 % where at most 1 % was asked"
};
Verdict verdict_on(const Advice&, const study::Cells&);
nlohmann::ordered_json json_of(const Advice&, const Verdict&);

// ---- A comparison as rows, as its manifest and as sounds.
//
// Numbers that repeat and measured times never share a committed file: facts.csv, errors.csv and
// cost.csv are committed (study/cells.hpp), cells.csv is to look at.

study::Cells cells_of(const Comparison&);
nlohmann::ordered_json manifest_of(const Comparison&, const CompareRequest&);

// sounds/ and sounds.csv: the reference, and of each scheme its lowest and its highest rate; the
// rates between while all are small.
void write_sounds(const Comparison&, const std::filesystem::path& folder);

}  // namespace jvari::bench::compare

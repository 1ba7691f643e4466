// Findings in a set of cells: the Pareto front of cost and error, observed orders of convergence,
// and warnings. On the front, differences within the uncertainty decide nothing. Warnings concern
// unreliable timings, and runs made worse by matched compliance.
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
    // median and quartiles; all equal for a cost without scatter
    double cost, cost_lower, cost_upper;
    // raised by the caller to at least noise floor and certificate, so that smaller errors tie
    double error;
    double certificate = 0;  // uncertainty of the error
};

// Selects the points on the front. A point is on the front unless another is surely better in one
// of two ways. The other's error is smaller by more than both certificates, at a cost that is
// smaller or tied. Or the other's error is no larger, at a cost that is surely smaller. A point
// without a finite cost and error is never on the front.
std::vector<bool> pareto_front(std::span<const Point>);

// Fills in `pareto`: 1 for trusted cells with a known error on the front. The front is drawn for
// `cost_s_per_s` and the headline error, for each scene and point of a sweep.
study::Cells with_front(study::Cells);

// ---- Orders, per window and tap: cells fitted over their rates (analysis/convergence.hpp)

// Order of a series with at least two usable rates (fall_over_rates).
struct ObservedOrder {
    std::size_t first;  // cell of the series
    std::size_t measure;
    std::string tap;
    double modes;  // NaN if they change with the rate, for example on a grid
    Order order;
    double from_hz, to_hz;
};
std::vector<ObservedOrder> convergence_of(const study::Cells&);
// Columns scene, <swept keys>, scheme, options, modes, tap, window, order, half_width (of the 95 %
// interval; empty with two points), points, from_hz, to_hz.
store::Table convergence_table(const study::Cells&);

// Series of cells, differing only in rate, whose error surely rises with the rate, by more than a
// fifth over the headline's window. Names the cells at the lowest and highest rate. Series with a
// falling error are included if the difference in third octaves rises by at least 1 dB.
struct Rising {
    std::size_t low, high;
    std::string text;  // sentence: "its error rises with the rate, from 1.2 % at 44100 Hz to 3.4 %"
};
std::vector<Rising> rising_with_the_rate(const study::Cells&);

// ---- Warnings

// Half the interquartile range over the median cost, for the middle timed cell; NaN if no cell was
// timed.
double median_spread(const study::Cells&);
// Warning if median_spread exceeds a fifth, else "".
std::string busy_text(const study::Cells&);
// Warning about matched compliance, else "". Compares cells that differ only in compliance=own and
// matched. Counts the matched cells with an error at any tap, over the headline's window, surely
// more than 1.2 times the own sibling's, and names the worst.
std::string harm_text(const study::Cells&);

// Causes, by series, of the error at the highest rate, or the statement that the error rises; else
// "".
std::string cause_text(const study::Cells&);

std::vector<std::string> warnings_of(const study::Cells&);  // all warnings that are not empty

// ---- Advice, compared with the reference

// Verdict: whether the cell with the advised settings has the promised error.
struct Verdict {
    enum class Says { confirmed, refuted, not_known } says = Says::not_known;
    std::optional<std::size_t> cell{};
    Bound bound{};       // bound for the cell's error
    std::string text{};  // "the advice held: 0.38 % where at most 1 % was asked"
};
Verdict verdict_on(const Advice&, const study::Cells&);
nlohmann::ordered_json json_of(const Advice&, const Verdict&);

// ---- Files of a comparison: rows, manifest and sounds.
//
// Numbers that repeat and measured times never share a committed file: facts.csv, errors.csv and
// cost.csv are committed (study/cells.hpp), cells.csv is for reading.

study::Cells cells_of(const Comparison&);
nlohmann::ordered_json manifest_of(const Comparison&, const CompareRequest&);

// Writes sounds/ and sounds.csv: the reference, and each scheme at its lowest and highest rate; the
// rates between too if all files are small.
void write_sounds(const Comparison&, const std::filesystem::path& folder);

}  // namespace jvari::bench::compare

// What is known of an error, and which error stands where one has to. Tables, text, JSON, pictures, the Pareto front and the cheapest all
// ask here.
//
// A cell is measured against a reference (e); the reference itself is certain to c, its certificate. By the triangle inequality the cell
// differs from the truth by e + c at most and by e - c at least, relative to the norm of the reference.
#pragma once

#include <limits>
#include <string>

#include "bench/store/cell_rows.hpp"

namespace jvari::bench::compare {

struct Bound {
    double error = std::numeric_limits<double>::quiet_NaN();        // as measured; NaN: none
    double certificate = std::numeric_limits<double>::quiet_NaN();  // NaN: none, and what was measured is all there is
    double floor = std::numeric_limits<double>::quiet_NaN();        // of noise, NaN: none

    double most() const;   // e + c
    double least() const;  // e - c, 0 at least

    enum class Says {
        nothing,   // there is no error
        measured,  // e: c is a tenth of it or less, or there is none
        at_most,   // e + c
        unknown    // e + c reaches 1, where nothing of the waveform is right: c is too large to tell
    };
    Says says() const;
    double shown() const;  // what stands in a picture: e, or e + c where that is what is known
    bool decides() const;  // larger than noise floor and certificate: how it falls with the rate is of the scheme
};

// Of a row of cells.csv, or of a table like it, and one of its error columns.
Bound bound_of(const store::Table& cells, std::size_t row, const std::string& error_column);

std::string error_text(const Bound&, const char* format);  // "1.30e-02", "\u22645.13e-02", "not known", "-" where there is no error

// The rows' own figures say nothing against them: they reached their end, and have no flags.
bool trusted(const store::Table& cells, std::size_t row);

// The column that stands for the error where one has to: relative L2 over 50 ms, else 10 ms, else the whole run; the first with a finite
// value in one of the rows.
std::string headline_error(const store::Table& cells, const store::Rows&);

// `cells` with bound_l2_10ms, bound_l2_50ms and bound_l2_whole beside them: e + c of the headline errors; empty where c is too large to
// tell or there is none.
store::Table with_bounds(store::Table cells);

}  // namespace jvari::bench::compare

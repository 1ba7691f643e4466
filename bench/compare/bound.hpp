// What is known of an error, and which error stands where one has to.
// Tables, text, JSON, pictures, the Pareto front and the cheapest all ask here.
//
// A cell is measured against a reference (e), which is itself uncertain by c, its certificate. By
// the triangle inequality the cell differs from the motion of the scene by e + c at most and by e -
// c at least, relative to the norm of the reference. Where c is unknown nothing follows from e.
// Spectral measures have no certificate and count as measured.
#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "analysis/convergence.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::compare {

// of a waveform, that the cheapest scheme is named for
constexpr double accuracies[] = {0.1, 0.01, 0.001};

struct Bound {
    double error = std::numeric_limits<double>::quiet_NaN();        // as measured; NaN: none
    double certificate = std::numeric_limits<double>::quiet_NaN();  // NaN: unknown
    double floor = std::numeric_limits<double>::quiet_NaN();        // of noise, NaN: none

    double most() const;   // e + c; NaN where c is unknown
    double least() const;  // e - c, 0 at least; 0 where c is unknown

    enum class Says {
        nothing,   // there is no error
        measured,  // e: c is a tenth of it or less
        at_most,   // e + c
        // e + c reaches 1, where nothing of the waveform is right: c is too large to tell
        unknown,
        unsure  // e, but c is unknown
    };
    Says says() const;
    double shown() const;  // what stands in a picture: e, or e + c where that is what is known
    // larger than noise floor and certificate: how it falls with the rate is of the scheme
    bool decides() const;
};

// of a tap, "" the headline's
Bound bound_of(const study::TabledCell&, std::size_t measure, const std::string& tap = "");

// "1.30e-02", "\u22645.13e-02", "1.30e-02?" (unsure), "not known", "-" where there is no error
std::string error_text(const Bound&, const char* format);
// " after the last pluck", where the windows of its errors begin there
std::string after_pluck(const study::TabledCell&);

// It reached the end of its run; one that is not needed was run over the headline's window alone.
bool reached(const study::TabledCell&);
// Its own figures say nothing against it: it reached the end of the whole run, and has no flags.
bool trusted(const study::TabledCell&);

// The measure that stands for the error where one has to: relative L2 over 50 ms, else 10 ms, else
// the whole run; the first with a finite value in one of the rows.
std::size_t headline_error(const study::Cells&, const study::Rows&);

// How an error falls with the rate over those of the rows that can tell: they reached their end,
// something of the waveform is right (an error below 1), and the error is larger than its noise
// floor and than what the reference is certain to.
struct Fall {
    Order order;
    study::Rows rows;
};
Fall fall_over_rates(const study::Cells&, const study::Rows&, std::size_t measure,
                     const std::string& tap = "");

// One object per cell: the columns of cells.csv, facts.csv and cost.csv, bound_l2_10ms and its
// like (e + c of a headline error, null where c is too large to tell or there is none), and errors:
// of each tap, of each measure, what errors.csv has.
nlohmann::ordered_json json_of(const study::Cells&);

}  // namespace jvari::bench::compare

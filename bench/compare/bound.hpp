// Bound of an error, and the choice of the headline error. Tables, text, JSON, pictures, the Pareto
// front and the table of the cheapest all use these functions.
//
// A cell has a measured error e against a reference. The reference has an uncertainty c, its
// certificate. By the triangle inequality the cell differs from the motion of the scene by at most
// e + c and at least e - c, relative to the norm of the reference. If c is unknown, nothing follows
// from e. Spectral measures have no certificate and count as measured.
#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "analysis/convergence.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::compare {

// accuracies on the waveform, for which the cheapest scheme is named
constexpr double accuracies[] = {0.1, 0.01, 0.001};

struct Bound {
    double error = std::numeric_limits<double>::quiet_NaN();        // measured; NaN: none
    double certificate = std::numeric_limits<double>::quiet_NaN();  // NaN: unknown
    double floor = std::numeric_limits<double>::quiet_NaN();        // noise floor, NaN: none

    double most() const;   // e + c; NaN if c is unknown
    double least() const;  // e - c, at least 0; 0 if c is unknown

    enum class Says {
        nothing,   // there is no error
        measured,  // e: c is at most a tenth of e
        at_most,   // e + c
        // e + c reaches 1, the error of silence: c is too large for a statement
        unknown,
        unsure  // e, but c is unknown
    };
    Says says() const;
    double shown() const;  // value for pictures: e if measured or unsure, else e + c
    // True if the error is larger than noise floor and certificate: then the scheme decides how the
    // error falls with the rate.
    bool decides() const;
};

// tap "": the headline's
Bound bound_of(const study::TabledCell&, std::size_t measure, const std::string& tap = "");

// Text of the error: "1.30e-02", "\u22645.13e-02", "1.30e-02?" (unsure), "not known", "-" without
// an error.
std::string error_text(const Bound&, const char* format);
// " after the last pluck" if the windows of the errors begin there, else "".
std::string after_pluck(const study::TabledCell&);

// True if the run reached its end; for a cell that is not needed, the end of the headline's window.
bool reached(const study::TabledCell&);
// True if the cell reached the end of the whole run and has no flags.
bool trusted(const study::TabledCell&);

// Measure for the headline error: relative L2 over 50 ms, else 10 ms, else the whole run; the first
// with a finite value in any row.
std::size_t headline_error(const study::Cells&, const study::Rows&);

// Fit of the error's fall with the rate. The fit uses the rows that reached their end, have an
// error below 1 (the error of silence), and whose error exceeds the noise floor and the
// certificate.
struct Fall {
    Order order;
    study::Rows rows;
};
Fall fall_over_rates(const study::Cells&, const study::Rows&, std::size_t measure,
                     const std::string& tap = "");

// Object per cell, with the columns of cells.csv, facts.csv and cost.csv, and two additions. Keys
// such as bound_l2_10ms have e + c for a headline error, or null if c is too large or the error is
// missing. Key `errors` has the contents of errors.csv, by tap and measure.
nlohmann::ordered_json json_of(const study::Cells&);

}  // namespace jvari::bench::compare

// The errors of one cell: every measure on every tap, and which of them stand in the headline.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::study {

class Pair;  // of a tap's signals: the run's and the reference's

struct Measure {
    std::string column;  // "error_l2_50ms"
    std::string unit;    // "1", "s", "dB", "Hz"
    std::string title;   // "relative L2 error, 0-50 ms"
    bool bridge;         // the headline figure is of the bridge tap, else of the nut tap
    bool less_is_better;
    double window;  // [s] that it is of, after the last excitation; infinite: to the end of the run
    double (*of)(Pair&);
};
const std::vector<Measure>& measures();
std::size_t measure(const std::string& column);  // its place among them
bool is_waveform(std::size_t measure);           // a relative L2 error: it may have a certificate
double error_of(std::size_t measure, std::span<const double> run, std::span<const double> reference,
                double rate);

using Measures = std::vector<std::size_t>;  // places; none: all

// One row per tap, one column per measure; NaN where the reference says nothing (a window that it
// does not cover), +inf for a run that stopped inside the window.
using Errors = std::vector<std::vector<double>>;
// Of each tap of the reference, by the run's tap of its name, from the instant `from` [s] on
// (free_from). NaN for a tap that the run has not, and for measures that are not asked for.
Errors errors_of(const Trace& candidate, const Trace& reference, const Measures& only = {},
                 double from = 0);

// The taps of the headline columns: the first nut force and the first bridge force, else the first
// driving force, else the first tap.
struct Headline {
    int nut = 0, bridge = 0;
    int tap(const Measure& m) const { return m.bridge ? bridge : nut; }
};
Headline headline_of(const Scene&);
double horizon_of(const Errors&, const Headline&);  // [s]
// how much [s] the nut tap's headline figure is of, infinite for less than 10 ms
double headline_window(const Scene&);

}  // namespace jvari::bench::study

// Errors of one cell: every measure on every tap, and the headline's choice among them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/scheme.hpp"
#include "schemes/trace.hpp"

namespace jvari::bench::study {

class Pair;  // signals of a tap, in the run and in the reference

// waveform: a relative L2 error, which may have a certificate; bands: levels in bands
enum class Kind { waveform, bands, other };
const char* name_of(Kind);

struct Measure {
    std::string column;  // "error_l2_50ms"
    Kind kind;
    std::string unit;   // "1", "s", "dB", "Hz"
    std::string title;  // "relative L2 error, 0-50 ms"
    std::string scale;  // unit on an axis, "dB rms"; "" for a ratio
    bool bridge;        // true: the headline takes the bridge tap, false: the nut tap
    bool less_is_better;
    double window;  // length [s], after the last excitation; infinite: to the end of the run
    double (*of)(Pair&);
    bool heard = false;  // true: run and reference are read by their modes below 20 kHz
    std::string axis() const { return scale.empty() ? title : title + " [" + scale + "]"; }
};
const std::vector<Measure>& measures();
std::size_t measure(const std::string& column);  // place in measures()
inline bool is_waveform(std::size_t measure) { return measures()[measure].kind == Kind::waveform; }
// Rows of a tap in a reference, as the measure reads them; empty if the reference has no such rows.
std::span<const double> rows_for(std::size_t measure, const Trace& reference, int tap);
double error_of(std::size_t measure, std::span<const double> run, std::span<const double> reference,
                double rate);

using Measures = std::vector<std::size_t>;  // places; empty: all

// A row per tap, a column per measure. NaN if the reference does not cover the window, +inf for a
// run that stopped inside the window.
using Errors = std::vector<std::vector<double>>;
// Scene whose taps come a second time, read by modes below 20 kHz (Trace::heard). All modes move.
// Contact forces have no modes. The same scene for a grid, for a scheme from outside, and for
// strings without modes below 20 kHz.
Scene heard_too(const Descriptor&, const Scene&);

// Errors on each tap of the reference, from the instant `from` [s] (free_from) on. The taps of the
// run are found by name. NaN for a tap that the run lacks, and for measures outside `only`. A run
// that is not read by its modes below 20 kHz is compared as it is.
Errors errors_of(const Trace& candidate, const Trace& reference, const Measures& only = {},
                 double from = 0);

// Taps of the headline columns: the first nut force and the first bridge force, else the first
// driving force, else the first tap.
struct Headline {
    int nut = 0, bridge = 0;
    int tap(const Measure& m) const { return m.bridge ? bridge : nut; }
};
Headline headline_of(const Scene&);
double horizon_of(const Errors&, const Headline&);  // [s]
// length [s] of the window for the nut tap's headline figure, infinite for less than 10 ms
double headline_window(const Scene&);
std::size_t waveform_over(double window);  // place of the relative L2 error over that window

}  // namespace jvari::bench::study

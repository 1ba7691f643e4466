// What figures are drawn from, beyond errors and cost: rows that a set of cells asks for, made of each cell's accuracy run (row_facet.hpp).
//
//   taps = [{ name = "y_b", quantity = "displacement", string = 0, position = 0.01 }]     beside those of the scene
//   trace    = { taps = ["y_b"], windows = [[0.05, 0.07]] }                every row of each window [s]
//   extent   = { taps = ["nut"], intervals = 400 }                         smallest and largest in each of equal parts of the run
//   profile  = { instants = [0.049], from = 0, to = 1, positions = 101 }   displacement along string 0 at the row nearest each instant
//   envelope = { taps = ["nut"], width_hz = 200, to_hz = 2e4, points = 200 }     upper envelope of the run's spectrum (Hann)
//   centroid = { taps = ["nut"], window = 0.02, hop = 0.01, from_hz = 500, to_hz = 8e3 }     of the power between them, frame by frame
//
// A tap "energy" is the energy stored; "bridge_pressure" and "nut_pressure" are what the scene's body makes of the driving force of all
// strings, and of their force on the nut (bench/sound/radiation.hpp). Values carry eight digits: they are for drawing and for findings, not
// for comparing bits.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari::bench::suite {

struct TraceRows {
    std::vector<std::string> taps;
    std::vector<std::array<double, 2>> windows;  // [s]
};
struct ExtentRows {
    std::vector<std::string> taps;
    int intervals = 0;
};
struct ProfileRows {
    std::vector<double> instants;  // [s]
    double from = 0, to = 0;       // [m]
    int positions = 0;
};
struct EnvelopeRows {
    std::vector<std::string> taps;
    double width_hz = 0, to_hz = 0;
    int points = 0;
};
struct CentroidRows {
    std::vector<std::string> taps;
    double window = 0, hop = 0;  // [s]
    double from_hz = 0, to_hz = HUGE_VAL;
};
struct FigureFacets {
    std::vector<Tap> taps;
    std::optional<TraceRows> trace;
    std::optional<ExtentRows> extent;
    std::optional<ProfileRows> profile;
    std::optional<EnvelopeRows> envelope;
    std::optional<CentroidRows> centroid;
    std::string identity;  // all of it as text: what makes a cell another cell
};

// The scene with the taps that the set asks for; those of a profile come last. Throws BadScene, and UsageError for a tap that is not there.
Scene with_figure_taps(Scene, const FigureFacets&);
Scene without_drawn_taps(Scene);  // without those of pressures and profiles: what rows of errors are made for

}  // namespace jvari::bench::suite

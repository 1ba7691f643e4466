// What figures are drawn from, beyond errors and cost: rows that a set of cells asks for, made of each cell's accuracy run (facet.hpp).
// Each kind of rows has a table of the set, whose keys figure_facets.cpp declares beside what it makes of them.
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

#include "bench/store/keys.hpp"
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

store::Key<FigureFacets> figure_taps_key();  // beside those of the scene
store::Key<FigureFacets> trace_key();
store::Key<FigureFacets> extent_key();
store::Key<FigureFacets> profile_key();
store::Key<FigureFacets> envelope_key();
store::Key<FigureFacets> centroid_key();

// The scene with the taps that the set asks for; those of a profile come last. Throws BadScene, and UsageError for a tap that is not there.
Scene with_figure_taps(Scene, const FigureFacets&);
Scene without_drawn_taps(Scene);  // without those of pressures and profiles: what rows of errors are made for

}  // namespace jvari::bench::suite

// What figures are drawn from, beyond errors and cost: rows that a set of cells asks for, made of each cell's accuracy run (facet.hpp).
// Each kind of rows has a table of the set, whose keys figure_facets.cpp declares beside what it makes of them.
//
// A tap "energy" is the energy stored; "bridge_pressure" and "nut_pressure" are what the scene's body makes of the driving force of all
// strings, and of their force on the nut (bench/sound/radiation.hpp). Values carry eight digits: they are for drawing and for findings, not
// for comparing bits.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "bench/store/keys.hpp"
#include "scenes/scene.hpp"

namespace jvari::bench::suite {

struct FigureRows {  // of one kind: what its table says
    std::vector<std::string> taps;
    std::vector<std::array<double, 2>> windows;  // [s]
    std::vector<double> instants;                // [s]
    double from = 0, to = 0;                     // along string 0 [m]
    double window = 0, hop = 0;                  // of frames [s]
    double width_hz = 0, from_hz = 0, to_hz = HUGE_VAL;
    int count = 0;  // of intervals, positions or points
};
struct FigureFacets {
    std::vector<Tap> taps;                   // beside those of the scene
    std::map<std::string, FigureRows> rows;  // by the name of their facet
    std::string identity;                    // all of it as text: what makes a cell another cell
};

// What the table of each kind says.
store::Kind<FigureRows> trace_table();
store::Kind<FigureRows> extent_table();
store::Kind<FigureRows> profile_table();
store::Kind<FigureRows> envelope_table();
store::Kind<FigureRows> centroid_table();

// The keys of a set: `taps`, and a table for each facet that is described by one.
store::Key<FigureFacets> figure_taps_key();
store::Key<FigureFacets> figure_rows_key(const char* facet, const store::Kind<FigureRows>&);

// The scene with the taps that the set asks for; those of a profile come last. Throws BadScene, and UsageError for a tap that is not there.
Scene with_figure_taps(Scene, const FigureFacets&);
Scene without_drawn_taps(Scene);  // without those of pressures and profiles: what rows of errors are made for

}  // namespace jvari::bench::suite

// Maps of a suite file: what becomes of each scheme over two settings of one scene. map_file.cpp
// declares their keys.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/store/keys.hpp"

namespace jvari::bench::map {

// "rate" [Hz], "modes", "duration" [s], "amplitude" (of initial shapes and plucks),
// "option:[SCHEME:]NAME", else a key of the scene.
struct MapAxis {
    std::string key;
    // in TOML syntax, an option's as the scheme reads it; numbers ascend
    std::vector<std::string> values;
    // as numbers, between which a boundary can be sought; empty where one of them is none
    std::vector<double> at;
    bool whole = false;       // modes, and options given as whole numbers
    double from = 0, to = 0;  // as the file may say its values; 0: absent, as of points
    int points = 0;
};

using Assignment = std::pair<std::string, std::string>;  // a key as an axis has it, and its value

struct Map {
    std::string name, scene, theory;
    std::string reference;  // "": the highest that represents the scene; "none"
    std::vector<std::string> schemes;
    MapAxis x, y;                   // y without a key: one row
    std::vector<Assignment> fixed;  // the same at every point
    int reference_modes = 0;        // 0: those of the point
    int refine = 0;
    bool reproduce = true;
};

// [[map]] tables of a suite.
store::Kind<std::vector<Map>> maps();

}  // namespace jvari::bench::map

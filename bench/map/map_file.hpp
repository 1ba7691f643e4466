// Maps of a suite file: what becomes of each scheme over two settings of one scene. bench/suites/README.md says the keys for writers.
//
//   [[map]]                     name = "stiffness_rate"        scene = "tanpura_c3_release"
//   schemes = ["modal_two_point"]                              (absent: every scheme that represents the scene)
//   x = { key = "rate", from = 44100, to = 705600, points = 5 }    from .. to are spaced by equal ratios
//   y = { key = "string.0.barrier.0.stiffness", values = [1e4, 1e16] }       (absent: one row)
//   duration = 0.01    amplitude = 1    rate = 44100    modes = 40    options = { grid = 100 }    set = { "string.0.tension" = 30 }
//   reference = "exact_contact" or "none"                      (absent: the highest that represents the scene)
//   reference_modes = 1064                                     of the reference, the same at every point (absent: those of the point)
//   theory = "grid_limit"                                      a boundary that is known: map_theory.hpp
//   refine = 12                                                bisections of each boundary along x (absent: 0)
//   reproduce = false                                          its failures are not minimised (absent: they are)
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace jvari {
struct Value;
}
namespace jvari::bench::store {
class SuiteReader;
}

namespace jvari::bench::map {

// "rate" [Hz], "modes", "duration" [s], "amplitude" (of initial shapes and plucks), "option:[SCHEME:]NAME", else a key of the scene.
struct MapAxis {
    std::string key;
    std::vector<std::string> values;  // in TOML syntax, an option's as the scheme reads it; numbers ascend
    std::vector<double> at;           // as numbers, between which a boundary can be sought; empty where one of them is none
    bool whole = false;               // modes, and options given as whole numbers
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

// The maps of a suite's root table. Throws SceneFileError with file, line and key.
std::vector<Map> maps_of(const store::SuiteReader&, const Value& root);

}  // namespace jvari::bench::map

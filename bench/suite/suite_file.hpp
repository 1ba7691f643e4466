// Suite files: TOML that declares what to compare. bench/suites/README.md says the keys for writers of suites.
//
//   name = "paper-deshmukh"            source = "figs 16-27"          (absent: "")
//   [[cells]]                          one table per set; its cells are the product of what it lists
//   scenes = ["sitar_c5"]              schemes = ["sitar_fdm"]        (absent: every scheme that represents the scene)
//   rates = [44100]                    modes = 40 or [20, 40]         (absent: as compare)
//   duration = 0.5      tap_rate = 44100      repeats = 5             [s], [Hz], timed runs
//   reference = "exact_contact"                                       (absent: the highest that represents the scene)
//   reference_modes = 0    (0: doubled until nothing moves, also absent where modes vary; "cell": those of the cell, else absent)
//   options = { "modal_controls:control" = ["a", "b"], name = "x" }   [SCHEME:]NAME, one value or several to vary
//   sweep = { "string.0.barrier.0.stiffness" = [1e6, 1e8] }           any scene key, each with the values to vary
//   measure = ["errors", "cost", "spectrogram", "sound", "dispersion", "ensemble"]   cost goes with errors alone: no speed without an error
//   tap = "y03"                        of the spectrogram             (absent: the scene's first)
//   elements = ["thread", "probe"]     also without each of these    (absent: none), elements.hpp
//   time_limit_s = 60                  of one accuracy run            (absent: none)
//   taps, trace, extent, profile, envelope, centroid                  figure_facets.hpp
//   [[figure]]                                                        figure_file.hpp
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/compare/elements.hpp"
#include "bench/compare/request.hpp"
#include "bench/map/map_file.hpp"
#include "bench/suite/figure_file.hpp"

namespace jvari::bench::suite {

enum class Facet {
    errors,
    cost,
    spectrogram,
    sound,
    dispersion,
    ensemble,
    trace,
    extent,
    profile,
    envelope,
    centroid
};  // what is measured of a cell
std::span<const Facet> facets();
const char* name_of(Facet);

struct SweptKey {
    std::string key;                  // of a scene: "string.0.tension"
    std::vector<std::string> values;  // in TOML syntax
};
struct VariedOption {
    std::string scheme, name;  // scheme "": every scheme that knows the name
    std::vector<std::string> values;
};

struct CellSet {
    std::vector<std::string> scenes, schemes;
    std::vector<double> rates;  // [Hz]
    std::vector<int> modes;     // {0}: as compare
    std::optional<double> duration, tap_rate;
    std::optional<int> reference_modes;
    int repeats = 5;
    std::string reference, tap;
    std::vector<VariedOption> options;
    std::vector<SweptKey> sweep;
    std::vector<Facet> measure;
    std::vector<compare::Element> elements;
    std::optional<double> time_limit;  // [s]
    FigureFacets figures;
    bool measures(Facet) const;
};

struct Suite {
    std::string name, source;
    std::vector<CellSet> sets;
    std::vector<Figure> figures;
    std::vector<map::Map> maps;
};

// A file, or a suite of the library by its name. Throws SceneFileError "suite.toml:12: cells.0.raets: unknown key; did you mean rates?".
Suite read_suite(const std::string& file_or_library_name);
Suite parse_suite(std::string_view text, const std::string& file_name);

// Names of the suites in the library, sorted: the directory $JVARI_SUITES, else that of the sources, else the installed one.
std::vector<std::string> library_suites();

// What compare would be asked for one scene of the set at one point of modes, options and sweep; in the order in which they stand.
struct SuitePoint {
    const CellSet* set;
    compare::CompareRequest request;
    std::optional<compare::Element> element = {};  // that the scene is to be without
};
std::vector<SuitePoint> points_of(const Suite&);

}  // namespace jvari::bench::suite

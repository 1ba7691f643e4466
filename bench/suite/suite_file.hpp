// Suite files: TOML that declares what to compare. suite_file.cpp declares their keys, facet.hpp
// what can be measured; `jvari list keys` shows them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/compare/request.hpp"
#include "bench/map/map_file.hpp"
#include "scenes/scene.hpp"

namespace jvari::bench::suite {

namespace measured {  // facets that more than their own file knows
inline constexpr const char *errors = "errors", *cost = "cost", *spectrogram = "spectrogram";
}

struct SweptKey {
    std::string key;                  // of a scene: "string.0.tension"
    std::vector<std::string> values;  // in TOML syntax
};
struct VariedOption {
    compare::SchemeOption option;  // without its value
    std::vector<std::string> values;
};

struct CellSet
    // of each of its scenes, at each of its modes, options and swept values; `search`: of errors
    // alone
    : compare::CompareRequest {
    std::vector<std::string> scenes;
    std::string tap;  // in place of the request's, whose other taps are not even run
    std::vector<VariedOption> varied;
    std::vector<SweptKey> sweep;
    std::vector<std::string> measure{measured::errors};  // names of facets
    std::optional<double> time_limit;                    // [s]
    std::vector<Tap> taps;                               // beside those of the scene
    bool measures(std::string_view facet) const;
};

struct Suite {
    std::string name, question, source;
    std::vector<CellSet> sets;
    std::vector<map::Map> maps;
};

// A file, or a suite of the library by its name. Throws SceneFileError "suite.toml:12:
// cells.0.raets: unknown key; did you mean rates?".
Suite read_suite(const std::string& file_or_library_name);
Suite parse_suite(std::string_view text, const std::string& file_name);

// The keys of a suite file, of each of its tables: "", "cells", "map".
struct TableWords {
    std::string table;
    std::vector<store::KeyWords> keys;
};
std::vector<TableWords> suite_keys();

// Names of the suites in the library, sorted: the directory $JVARI_SUITES, else that of the
// sources, else the installed one.
std::vector<std::string> library_suites();

// What compare would be asked for one scene of the set at one point of modes, options and sweep; in
// the order in which they stand.
struct SuitePoint {
    const CellSet* set;
    compare::CompareRequest request;
};
std::vector<SuitePoint> points_of(const Suite&);

}  // namespace jvari::bench::suite

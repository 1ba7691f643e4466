// Suite files: TOML that declares what to compare. suite_file.cpp and map_file.cpp declare their
// keys, and what can be measured; `jvari list keys` shows them.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/compare/advice.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/keys.hpp"
#include "bench/store/records.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/job.hpp"
#include "scenes/scene.hpp"

namespace jvari::bench::suite {

namespace measured {  // facets that more than their own file knows
inline constexpr const char *errors = "errors", *cost = "cost", *spectrogram = "spectrogram",
                            *sound = "sound", *share = "share", *advice = "advice";
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
    std::vector<Tap> taps;                               // beside those of the scene
    double effort = 1;                                   // of its references (study::run_truth)
    std::optional<Scene> drawn{};  // a string of a population, in place of reading its scene
    bool measures(std::string_view facet) const;
};

// ---- Maps: what becomes of each scheme over two settings of one scene.

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

// [[map]] tables of a suite (map_file.cpp).
store::Kind<std::vector<Map>> maps();

// ---- A population: strings drawn from ranges of a scene's keys, and fixed ones beside them. Each
// string becomes a set of cells of its own (population.cpp).

struct DrawnKey {
    std::string key;                   // of a scene
    std::vector<std::string> choices;  // in TOML syntax; none: a range
    double from = 0, to = 0;
    bool log = false;  // equal ratios are equally likely
};
struct Ground {  // strings of one kind
    std::string name, scene;
    int number = 0;
    std::vector<DrawnKey> draw;
};
struct Population : CellSet {  // `scenes`: the fixed strings
    int seed = 0;
    double periods = 8;                // of the first mode, after the last pluck
    std::vector<double> multiples{1};  // of the modes below 20 kHz
    std::vector<std::string> measure{measured::errors, measured::cost, measured::share};
};

// ---- A suite.

struct Suite {
    std::string name, question, source;
    std::vector<CellSet> sets;  // of a population one for each string
    std::vector<Map> maps;
    std::optional<Population> population;
    std::vector<Ground> grounds;
};

// A file, or a suite of the library by its name. Throws SceneFileError "suite.toml:12:
// cells.0.raets: unknown key; did you mean rates?".
Suite read_suite(const std::string& file_or_library_name);
Suite parse_suite(std::string_view text, const std::string& file_name);

// The keys of a suite file, of each of its tables: "", "cells", "map", "population", "ground".
struct TableWords {
    std::string table;
    std::vector<store::KeyWords> keys;
};
std::vector<TableWords> suite_keys();

// The sets of cells of a population's strings, in order: its grounds, then its fixed scenes. The
// same file gives the same scenes to the byte. Throws SceneFileError, BadScene.
std::vector<CellSet> sets_of(const Population&, const std::vector<Ground>&);
std::vector<store::Key<Ground>> ground_keys();

// Writes the scenes into the folder before anything runs. Throws UsageError where one lies there
// that differs, for its cells are of another string.
void freeze(const Suite&, const std::filesystem::path& folder, bool resume);

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

// The suite spread out to its jobs: each a scheme at its settings on one scene.
// `plugins` are files whose contents count as part of the program. The suite must outlive the plan.
// Throws UsageError, SceneFileError, BadScene, Refusal.
// `advised`: whose settings are cells as well.
struct Advised {  // on a scene of a set that measures it
    const CellSet* set;
    std::string asked, scene;  // as the set has it; its name
    compare::Advice advice;
};
study::Plan plan_of(const Suite&, const compare::Catalogue&,
                    const std::vector<std::string>& plugins, std::span<const Advised> = {});
std::vector<Advised> advice_of(const Suite&, const compare::Catalogue&, const store::Listener&);
// Of each scene what was advised, and whether it held; a line each.
std::string verdicts_on(std::span<const Advised>, const study::Cells&);

// ---- What a suite can measure of a cell: errors and cost as compare has them, a spectrogram, and
// its sound.

struct Facet {
    const char *name, *meaning;
};
std::span<const Facet> facets();

// A cell's samples and its reference's lie in its record, and become sounds/*.wav and sounds.csv.
void keep_sounds(const study::Ran&, study::Record&);
void write_sounds(const std::filesystem::path& folder, const study::Plan&,
                  const std::vector<study::Record>&);

// ---- What a population finds out beside its cells, and the tables of it (strings.cpp).

// Of a string, once: how much a change of the obstacle's height is amplified, and how far advice
// errs, as JSON.
std::string examined(const study::Point&, const study::Truth*, const compare::Catalogue&);

// strings.csv:  a row per string: its dimensionless numbers, reference, uncertainty, outcome
// outcomes.csv: a row per string and variant: the outcome within 10, 1 and 0.1 %
// advice.csv:   a row per string and tolerance: what `run --within` takes, and its true error
// fronts.csv:   measured: the cheapest cells of each variant, with error and cost
struct StringTables {
    store::Table strings, outcomes, advice, fronts;
    std::string text;  // for the terminal
};
StringTables string_tables(const Suite&, const study::Plan&, const std::vector<study::Record>&);

}  // namespace jvari::bench::suite

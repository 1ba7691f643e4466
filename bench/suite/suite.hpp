// Suite files: TOML with a list of comparisons. suite_file.cpp and sweep.cpp declare the keys
// and the possible measurements; `jvari list keys` shows them.
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

namespace measured {  // names of facets that several files use
inline constexpr const char *errors = "errors", *cost = "cost", *spectrogram = "spectrogram",
                            *sound = "sound", *share = "share", *advice = "advice",
                            *outcome = "outcome";
}

struct SweptKey {
    // key of a scene, "string.0.tension"; on a map also "rate" [Hz], "modes", "duration" [s],
    // "amplitude" (of initial shapes and plucks) and "option:[SCHEME:]NAME"
    std::string key;
    std::vector<std::string> values;  // in TOML syntax, or for an option in the scheme's syntax
    std::vector<double> at;           // the values as numbers; empty if any value is no number
    bool whole = false;               // true for modes, and for options given in whole numbers
};
struct VariedOption {
    compare::SchemeOption option;  // without a value
    std::vector<std::string> values;
};

struct CellSet
    // Request for each scene in the set, with each number of modes, option and swept value.
    // `search` applies only to a set that measures errors.
    : compare::CompareRequest {
    std::vector<std::string> scenes;
    // tap for the errors; the request's tap would leave the other taps out of the run
    std::string tap;
    std::vector<VariedOption> varied;
    std::vector<SweptKey> sweep;
    std::vector<std::string> measure{measured::errors};  // names of facets
    std::vector<Tap> taps;                               // additional to the scene's taps
    double effort = 1;             // factor for the references' limits (study::run_truth)
    std::optional<Scene> drawn{};  // string from a population; if set, no scene is read
    // A set that measures outcomes is a map of one scene over one or two swept keys: x, which has
    // the boundaries, and y (maps.hpp). Its `set` holds at every point.
    std::string name, theory;  // theory: a known boundary; "": none
    int refine = 0;            // bisections of each boundary
    bool reproduce = true;     // false: failures are not minimised
    bool measures(std::string_view facet) const;
};

// Key `sweep` of a set, and the keys and rules of a map (sweep.cpp).
bool is_option(const std::string& key);  // "option:NAME"
store::Kind<std::vector<SweptKey>> swept_keys();
std::vector<store::Key<CellSet>> map_keys();
void must_be_a_map(const CellSet&, const store::Entry&);

// ---- Population: strings drawn from ranges for a scene's keys, and fixed strings. Each string
// becomes its own set of cells (population.cpp).

struct DrawnKey {
    std::string key;                   // key of a scene
    std::vector<std::string> choices;  // in TOML syntax; none: a range
    double from = 0, to = 0;
    bool log = false;  // true: equal ratios are equally likely
};
struct Ground {  // strings of one kind
    std::string name, scene;
    int number = 0;
    std::vector<DrawnKey> draw;
};
struct Population : CellSet {  // `scenes`: the fixed strings
    int seed = 0;
    double periods = 8;                // periods of the first mode, after the last pluck
    std::vector<double> multiples{1};  // factors on the number of modes below 20 kHz
    std::vector<std::string> measure{measured::errors, measured::cost, measured::share};
};

// ---- A suite.

struct Suite {
    std::string name, question, source;
    std::vector<CellSet> sets;  // a population has one for each string
    std::vector<CellSet> maps;  // sets that measure outcomes
    std::optional<Population> population;
    std::vector<Ground> grounds;
};

// Reads a file, or a suite from the library by its name. Throws SceneFileError "suite.toml:12:
// cells.0.raets: unknown key; did you mean rates?".
Suite read_suite(const std::string& file_or_library_name);
Suite parse_suite(std::string_view text, const std::string& file_name);

// Keys for each table in a suite file: "", "cells", "population", "ground".
struct TableWords {
    std::string table;
    std::vector<store::KeyWords> keys;
};
std::vector<TableWords> suite_keys();

// Sets of cells for a population's strings, in order: first the grounds, then the fixed scenes. The
// same file gives the same scenes to the byte. Throws SceneFileError, BadScene.
std::vector<CellSet> sets_of(const Population&, const std::vector<Ground>&);
std::vector<store::Key<Ground>> ground_keys();

// Writes the scenes into the folder before anything runs. Throws UsageError if the folder has a
// different scene with the same name, because the cells there belong to another string.
void freeze(const Suite&, const std::filesystem::path& folder, bool resume);

// Sorted names of the suites in the library: the directory $JVARI_SUITES, else the directory in the
// sources, else the installed one.
std::vector<std::string> library_suites();

// Point of a suite: the request to compare for one scene in the set, with one choice among modes,
// options and swept values. points_of returns them in the order of the file; on a map, x varies
// first.
struct SuitePoint {
    const CellSet* set;
    compare::CompareRequest request;
    std::vector<std::pair<std::string, std::string>> swept{};  // key, value
    double amplitude = 1;                                      // factor on starts and plucks
};
std::vector<SuitePoint> points_of(const std::vector<CellSet>&);

// Plan of a suite: its jobs, each a scheme with its settings on one scene. Contents of the files in
// `plugins` count toward the program's identity. The sets must outlive the plan. Throws
// UsageError, SceneFileError, BadScene, Refusal. `advised`: advised settings, added to the cells.
struct Advised {  // advice on a scene in a set that measures advice
    const CellSet* set;
    std::string scene_words, scene;  // the scene in the words of the set, and by name
    compare::Advice advice;
};
study::Plan plan_of(const std::vector<CellSet>&, const compare::Catalogue&,
                    const std::vector<std::string>& plugins, std::span<const Advised> = {});
std::vector<Advised> advice_of(const Suite&, const compare::Catalogue&, const store::Listener&);
// Verdicts on the advice for each scene, a line each.
std::string verdicts_on(std::span<const Advised>, const study::Cells&);

// ---- Facets, the possible measurements on a cell: errors and cost (the same figures that compare
// gives), a spectrogram, and the sound.

struct Facet {
    const char *name, *meaning;
};
std::span<const Facet> facets();

// Stores the samples of a cell and its reference in the record; write_sounds turns them into
// sounds/*.wav and sounds.csv.
void keep_sounds(const study::Ran&, study::Record&);
void write_sounds(const std::filesystem::path& folder, const study::Plan&,
                  const std::vector<study::Record>&);

// ---- Results of a population beside its cells, and their tables (strings.cpp).

// Examines a string once, for JSON: the amplification of a change in the obstacle's height, and the
// error of the advice.
std::string examined(const study::Point&, const study::Truth*, const compare::Catalogue&);

// Tables of a population:
//   strings.csv   a row per string: its dimensionless numbers, reference, uncertainty, outcome
//   outcomes.csv  a row per string and variant: the outcome within 10, 1 and 0.1 %
//   advice.csv    a row per string and tolerance: the settings from `run --within`, and their true
//                 error
//   fronts.csv    measured times: the cheapest cells in each variant, with error and cost
struct StringTables {
    store::Table strings, outcomes, advice, fronts;
    std::string text;  // for the terminal
};
StringTables string_tables(const Suite&, const study::Cells&, const std::vector<study::Record>&);

}  // namespace jvari::bench::suite

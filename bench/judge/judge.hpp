// Schemes from outside: the problem as a file, traces that other programs made, and any program as
// a scheme.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/compare/compare.hpp"
#include "bench/study/truth.hpp"

namespace jvari::bench::judge {

// ---- A scene's problem as JSON, for scripts: the arrays of schemes/open/jvari_scheme.h under the
// same names, and the reference trace with what it is known to. docs/own-scheme/README.md has
// shape, unit and equation of each.

struct Exported {
    Scene scene;
    Settings settings;
};
// Of request.rates.front(), its modes and its tap rate. Throws UsageError, Refusal, BadScene.
Exported exported(const compare::CompareRequest&);

study::Truth reference_of(const compare::CompareRequest&, const Exported&,
                          const compare::Catalogue&, const store::Listener&);

std::string problem_json(const Exported&, const study::Truth*);  // nullptr: without a reference

// ---- Traces that other programs wrote, on the rows of a scene.
//
//   .csv  a line of names, then a line a row: time_s, a column for each tap by its name, and
//         energy_stored_J, energy_supplied_J and energy_dissipated_J where there are all three.
//         Further columns are not looked at.
//   .wav  one tap in its own unit; its sample rate is the tap rate.

// `rows`: as many as a whole run has; fewer are a trace that stops early. Throws UsageError: other
// instants, more rows, a tap that is missing, a line that is cut off, what is no number.
Trace read_trace(const std::filesystem::path&, const Scene&, double tap_rate, long rows);

// Throws UsageError where an array of a tap has more rows than the scene, or other arrays have
// other lengths.
void check_rows(const Trace&, const std::string& what, long rows);

// The same, and where it has fewer rows: such a trace cannot be judged whole.
void must_be_whole(const Trace&, const std::string& what, long rows);

// "": every tap is a number in every row; else where the first is that is none. Its scheme failed
// there, at that rate.
std::string no_number_in(const Trace&);

// ---- A trace that another program made, as a scheme: whatever is asked of schemes is asked of it.

// Gives its rows; beyond them, NaN, so that a run ends there as diverged.
std::unique_ptr<Scheme> played(std::shared_ptr<const Trace>);

constexpr Features every_feature{(1u << feature_count) - 1};

// ---- Any program as a scheme, by files: COMMAND problem.json trace.csv reads the problem, as
// `jvari export` writes it without its reference, and writes the rows that read_trace reads. It is
// called once for each scene and setting.

// Makes it a scheme, whose name is that of its file ("octave-cli mine.m": mine), and returns the
// path of its guest. What it computes is known again by the command and the files that it names, as
// the shell reads it: scripts, data, and programs on the PATH.
std::string enter_external(const std::string& command);

// With what such a program says of itself, called with the one word "represents": lines
// "represents: damping, thread" and "balance: exact", as jvari_scheme.h has them. As it is where it
// says nothing within 10 s, or ends with another exit code than 0. Throws UsageError: other words.
Descriptor declared(const Descriptor&);

// ---- Traces of one scheme that another program ran, one for each of its sample rates, judged as
// `compare` judges schemes of its own.

using Costs = std::map<double, double>;  // by sample rate [Hz]: computing time per second of sound

struct Candidate {
    std::string name = "mine";                              // in tables and pictures
    std::map<double, std::shared_ptr<const Trace>> traces;  // by sample rate [Hz]
    Costs costs;                                            // as reported; none: not known
    // of its files: what its results depend on
    std::string contents;
};

// The rows that traces are compared on [Hz], and how many they are: 44100 where it divides all
// rates, else the lowest.
struct Rows {
    double rate;
    long count;
};
Rows rows_for(const compare::CompareRequest&, const Scene&);

// The request's schemes run beside the candidate, at its rates. Throws as compare does; UsageError
// for a name that is taken.
compare::Comparison judge(Candidate, compare::CompareRequest,
                          const std::vector<std::string>& plugins, const store::Listener&,
                          study::Kept&);

// Gives cells of a scheme that is not timed the cost that somebody reports, and marks them by the
// option cost=as_reported; those at other rates, or with modes that were added, keep none.
void report_costs(compare::Comparison&, const std::string& scheme, const Costs&);
void must_be_untimed(const Descriptor&);  // throws UsageError for a scheme that is timed

bool is_candidate(const study::Cell&);  // a cell of the trace that is judged
// in words: of each rate, against what ran beside it, and the observed order
std::string verdict_of(const compare::Comparison&);

}  // namespace jvari::bench::judge

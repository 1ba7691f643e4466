// External schemes: the problem in a file, traces made by other programs, and any program used as a
// scheme.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/compare/compare.hpp"
#include "bench/study/truth.hpp"

namespace jvari::bench::judge {

// ---- A scene's problem in JSON, for scripts. The arrays have the same names as in
// schemes/open/jvari_scheme.h; the reference trace comes with its uncertainty.
// docs/own-scheme/README.md has shape, unit and equation for each array.

struct Exported {
    Scene scene;
    Settings settings;
};
// Uses request.rates.front(), and modes and tap rate from the request. Throws UsageError, Refusal,
// BadScene.
Exported exported(const compare::CompareRequest&);

study::Truth reference_of(const compare::CompareRequest&, const Exported&,
                          const compare::Catalogue&, const store::Listener&);

std::string problem_json(const Exported&, const study::Truth*);  // nullptr: without a reference

// ---- Traces written by other programs, on the rows of a scene.
//
//   .csv  a line of names, then a line for each row: time_s, a column for each tap by name, and
//         optionally energy_stored_J, energy_supplied_J and energy_dissipated_J, all three.
//         Further columns are ignored.
//   .wav  one tap in its own unit; its sample rate is the tap rate.

// `rows`: the rows of a whole run; a shorter trace stops early. Throws UsageError: other instants,
// more rows, a missing tap, a truncated line, an invalid number.
Trace read_trace(const std::filesystem::path&, const Scene&, double tap_rate, long rows);

// Throws UsageError if the array for a tap has more rows than the scene, or if other arrays have
// other lengths.
void check_rows(const Trace&, const std::string& what, long rows);

// Also throws for fewer rows: such a trace cannot be judged whole.
void must_be_whole(const Trace&, const std::string& what, long rows);

// Returns "" if every tap is a number in every row, otherwise the place with the first invalid
// value: the scheme failed there, at this rate.
std::string no_number_in(const Trace&);

// ---- A trace by another program as a scheme: all commands for schemes accept it.

// Plays its rows and then NaN, so that a longer run ends there as diverged.
std::unique_ptr<Scheme> played(std::shared_ptr<const Trace>);

constexpr Features every_feature{(1u << feature_count) - 1};

// ---- Any program as a scheme, by files: COMMAND problem.json trace.csv reads the problem, in the
// format of `jvari export` without the reference, and writes rows for read_trace. It is called once
// for each scene and setting.

// Registers the program as a scheme, named after the file ("octave-cli mine.m": mine), and returns
// the guest's path. The command, and the files in the command, identify results: scripts, data, and
// programs on the PATH. Words are split like in a shell.
std::string enter_external(const std::string& command);

bool is_external(const Descriptor&);  // a program registered by enter_external

// Adds the program's own declarations. It is called with the one word "represents" and prints lines
// "represents: damping, thread" and "balance: exact", in the terms of jvari_scheme.h. The
// descriptor stays unchanged if the program prints nothing within 10 s, or has an exit code other
// than 0. Throws UsageError: other words.
Descriptor declared(const Descriptor&);

// ---- Traces of a scene by another program, for one or more sample rates, judged in the same way
// as the schemes in `compare`.

using Costs = std::map<double, double>;  // computing time per second of sound, by sample rate [Hz]

struct Candidate {
    std::string name = "mine";                              // in tables and pictures
    std::map<double, std::shared_ptr<const Trace>> traces;  // traces by sample rate [Hz]
    Costs costs;                                            // reported costs; empty: unknown
    // Contents of the files, which determine the results.
    std::string contents;
};

// Common rows for comparing traces: rate [Hz] and count. The rate is 44100 if it divides all sample
// rates, otherwise the lowest sample rate.
struct Rows {
    double rate;
    long count;
};
Rows rows_for(const compare::CompareRequest&, const Scene&);

// Runs the request's schemes beside the candidate, at the same rates. Throws like compare;
// UsageError for a name already in use.
compare::Comparison judge(Candidate, compare::CompareRequest,
                          const std::vector<std::string>& plugins, const store::Listener&,
                          study::Kept&);

// Sets a reported cost for the cells of an untimed scheme, and marks them by the option
// cost=as_reported. Cells at other rates, or with added modes, get no cost.
void report_costs(compare::Comparison&, const std::string& scheme, const Costs&);
void must_be_untimed(const Descriptor&);  // throws UsageError for a timed scheme

bool is_candidate(const study::Cell&);  // cell of the judged trace
// Describes each rate, the comparison with other schemes, and the observed order.
std::string verdict_of(const compare::Comparison&);

}  // namespace jvari::bench::judge

// Reference solution for the cells: how a study chooses and runs it.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/store/system/listener.hpp"
#include "bench/study/certificate_library.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::study {

struct ReferenceChoice {
    const Descriptor* scheme;
    Settings settings;
    std::string note;  // reason for this choice; "" if the rule gives it or the user asked for it
    // ratio of the highest rate to the coarsest, for a scheme that stands in; 0: a real reference
    int oversampled = 0;
    // Runs from an earlier program may be used (kept_run). True only if the reference is part
    // of this program, not of a plugin.
    bool kept = false;
    // folder for all runs in a study; "": kept_runs_folder(), and only for runs worth keeping
    std::filesystem::path kept_in{};
    std::string name() const {
        return (oversampled ? "oversampled " : "") + std::string(scheme->name);
    }
};

// For a scheme that stands in: the coarsest rate of its three is the cells' highest rate.
constexpr int oversampling = 4;

// Chooses the references, in order of authority. Every caller that needs a reference calls this
// function. `named` alone is returned if given, whatever features it represents. Otherwise the
// result lists every reference that represents the scene, then the program's schemes that may stand
// in. If no scheme may, `stand_in` is taken; if nullptr, nothing stands in. `at`: the cells'
// settings, at their highest rate.
std::vector<ReferenceChoice> references_of(const Scene&, const Settings& at,
                                           const Descriptor* named, const Descriptor* stand_in);

// Number of modes from which a reference is doubled: the cells' number (0: all modes below 20 kHz),
// limited by the rows. Rows at 44.1 kHz hold the modes below 20 kHz. Rows at another rate hold the
// same share of their rate, whatever the unit of time. If no mode lies below 20 kHz, the function
// returns all modes that the rows hold.
int modes_to_begin_with(const Scene&, double tap_rate, int cells);
int modes_held(const String&, double rate);  // number of modes that rows of this rate hold

// Runs a reference, whose trace has each tap twice if it can (heard_too).
Run run_heard(const Descriptor&, const Scene&, const Settings&, const RunOptions&);

struct TimeLimit {  // limit for processor time [s]
    double seconds = HUGE_VAL;
    // After this time, a run is ended if at its pace it would exceed `seconds`.
    double judged_after = HUGE_VAL;
};

struct Reference {
    ReferenceChoice choice;
    Run run, moved;  // moved: the same run, started a relative 1e-12 apart
    Trust trust;     // uncertainty, from the certificate or from the scheme's own estimate
};
// Runs the first choice that represents the scene and starts. Its two runs go side by side if
// `jobs` is not 1. Among schemes that may stand in, the smallest own error estimate goes first.
// Throws Refusal if no choice runs, and PastItsLimit if either run exceeds the limit. A reference
// that is too slow has no replacement, because the errors would then depend on the machine.
//
// `alone`: runs the first choice that reaches its end, once; `moved` and `trust` stay empty.
Reference run_reference(const std::vector<ReferenceChoice>&, const Scene&, int jobs,
                        const store::Listener&, TimeLimit = {}, bool alone = false);

// ---- Runs of references, kept from one program to the next: a reference may take minutes, while a
// scheme takes milliseconds.
//
// Each run has a file, named by a hash of everything that affects its numbers: scene, reference and
// settings, sources, compiler, flags and vector instructions. The file appears by rename. The
// reader checks key, checksum and sizes before using a file. Runs under half a second are not kept,
// unless the caller keeps all runs in a study.

// Folder $JVARI_CACHE, else jvari in $XDG_CACHE_HOME, else ~/.cache/jvari. The user may empty the
// folder at any time. An empty JVARI_CACHE gives "", and nothing is kept.
std::filesystem::path kept_runs_folder();

std::string run_key(const Descriptor&, const Scene&, const Settings&);

// throws UsageError
void write_run(const std::filesystem::path&, const std::string& key, const Run&);
std::optional<Run> read_run(const std::filesystem::path&,
                            // nothing if the file is incomplete or has another key than `key`
                            const std::string& key) noexcept;

constexpr double worth_keeping = 0.5;  // [s] of stepping

// Returns the kept run if there is one; else calls `make` and keeps the result. Waits for another
// process or thread that is making the same run. Keeps nothing in a folder without write access,
// and no run shorter than `least` [s] anywhere.
Run kept_run(const std::filesystem::path& folder, const std::string& key,
             const std::function<Run()>& make, double least = worth_keeping);

// Time limit for a run with a size that nobody asked for. The run has a minute to show that it ends
// within ten. Both times are multiplied by `effort`.
inline TimeLimit first_run(double at_most, double effort = 1) {
    return {std::min(at_most, 600 * effort), 60 * effort};
}

}  // namespace jvari::bench::study

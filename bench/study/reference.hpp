// Which solution cells are measured against, and its run.
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
    std::string note;  // why this one, "" where it is the rule or was asked for
    // a scheme, and the multiple of the coarsest rate of three; 0: a reference
    int oversampled = 0;
    // its run may be one of before (kept_run.hpp): the reference is of this program and not of a
    // plugin
    bool kept = false;
    // a study's own folder, for all of its runs; "": kept_runs_folder(), for those worth keeping
    std::filesystem::path kept_in{};
    std::string name() const {
        return (oversampled ? "oversampled " : "") + std::string(scheme->name);
    }
};

constexpr int oversampling = 4;  // of a scheme that stands in: the coarsest of its three rates is
                                 // the highest cell's

// The one chooser of references, in order of authority: `named` alone, whatever it represents; else
// every reference that represents the scene, and behind them the schemes that may stand in. Of
// those in the program; where none of them may, `stand_in`, and where that is nullptr nothing
// stands in at all. `at`: the cells' settings, at their highest rate.
std::vector<ReferenceChoice> references_of(const Scene&, const Settings& at,
                                           const Descriptor* named, const Descriptor* stand_in);

// Modes from which a reference is doubled: as many as the cells carry (0: those below 20 kHz), but
// none that the rows cannot hold. Rows of 44.1 kHz hold those below 20 kHz, others the same share
// of their rate, whatever the unit of time. Where no mode lies below 20 kHz, all that rows hold.
int modes_to_begin_with(const Scene&, double tap_rate, int cells);
int modes_held(const String&, double rate);  // by rows of this rate

struct TimeLimit {  // of processor [s]
    double seconds = HUGE_VAL;
    double judged_after = HUGE_VAL;  // from then on a run ends that at its pace would take longer
};

struct Reference {
    ReferenceChoice choice;
    Run run, moved;  // moved: started 1e-12 apart
    Trust trust;     // what its certificate, or its own estimate, says of it
};
// The first of the choices that represents the scene and gets going, its two runs side by side
// where `jobs` are not 1; of the schemes that may stand in the one that estimates its own error
// least goes first. Throws Refusal where none does, and PastItsLimit where one of the two runs
// computes for longer than its limit: another in its place would make the errors a matter of
// the machine.
//
// `alone`: the first that reaches its end, by one run; `moved` and `trust` are empty.
Reference run_reference(const std::vector<ReferenceChoice>&, const Scene&, int jobs,
                        const store::Listener&, TimeLimit = {}, bool alone = false);

// ---- Runs of references, kept from one program to the next: a reference may take minutes where a
// scheme takes milliseconds.
//
// A file per run, named by a hash of everything that its numbers depend on: scene, reference and
// settings, sources, compiler, flags and vector instructions. It appears by rename and is believed
// only where it is whole: its key, its checksum and its sizes are looked at. Nothing is kept of a
// run of less than half a second, unless the caller keeps all of its study's.

// $JVARI_CACHE, else jvari in $XDG_CACHE_HOME, else ~/.cache/jvari;
// may be emptied at any time. "", for nowhere, where JVARI_CACHE is empty.
std::filesystem::path kept_runs_folder();

std::string run_key(const Descriptor&, const Scene&, const Settings&);

// throws UsageError
void write_run(const std::filesystem::path&, const std::string& key, const Run&);
std::optional<Run> read_run(const std::filesystem::path&,
                            // nothing where it is not whole or not of `key`
                            const std::string& key) noexcept;

constexpr double worth_keeping = 0.5;  // [s] of stepping

// The run that is kept there, else what `make` gives, which is kept from then on; waits for another
// process or thread that makes it. A folder that cannot be written to keeps nothing, and nowhere is
// a run kept of less than `least` [s].
Run kept_run(const std::filesystem::path& folder, const std::string& key,
             const std::function<Run()>& make, double least = worth_keeping);

// Limit of a reference's run whose size nobody asked for: a minute to show that it ends within ten,
// both times `effort`.
inline TimeLimit first_run(double at_most, double effort = 1) {
    return {std::min(at_most, 600 * effort), 60 * effort};
}

}  // namespace jvari::bench::study

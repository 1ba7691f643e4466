// Everything a result depends on besides the scene: the program, its compiler and the machine.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "schemes/trace.hpp"

namespace jvari::bench::store {

struct Sources {  // of this build: provenance.cpp
    const char *commit, *run_sources, *cell_sources;
};
extern const Sources build_sources;

struct Machine {
    // commit: git describe at build time, "unknown" outside git
    std::string version, commit;
    // hashes: run_sources covers all sources that determine a run's numbers, cell_sources also the
    // measuring sources
    std::string run_sources, cell_sources;
    std::string compiler, flags, build;  // build: CMake's build type
    std::string vectors;                 // instruction set chosen by the kernels
    std::string cpu, system;
    int cores;
};
const Machine& machine();

// Identity of a run's program and loaded plugins, in JSON: everything numbers depend on besides
// scene and settings. This is sources, compiler, flags, build type, vector instructions, and the
// plugins' contents. A record with a different identity comes from another program. Commit and
// version are not included: an edit in the documentation may change them, and two builds with
// uncommitted changes share them.
std::string run_identity(const Machine& = machine());
// Identity of a cell's program.
std::string program_identity(const std::vector<std::string>& plugins, const Machine& = machine());

// Conditions that timings additionally depend on. `name` is the same for all machines of the same
// kind with the same program; costs are comparable only under the same name.
struct Stamp {
    std::string name;      // "AMD EPYC 7763, 2 cores, AVX2, GNU 12.2.0 -O3 -ffp-contract=off"
    std::string host, at;  // at: now_utc
    double load = nan;     // average number of running processes over a minute, NaN if unknown
    std::string governor;  // frequency governor of the processors: "performance"; "" if unknown
};
Stamp stamp_now();
nlohmann::ordered_json json_of(const Stamp&);
Stamp stamp_of(const nlohmann::ordered_json&);  // throws std::exception if invalid

// Provenance for the start of a manifest: all members above, the date and the loaded plugins (file,
// hash, compiler, flags) in a single object.
nlohmann::ordered_json made_by();
std::string now_utc();  // "2016-05-04T12:00:00Z"

}  // namespace jvari::bench::store

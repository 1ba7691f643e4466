// What a result depends on beside its scene: the program, its compiler and the machine.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace jvari::bench::store {

struct Machine {
    // commit: git describe when built, "unknown" outside git
    std::string version, commit;
    // hashes of the sources that a run's numbers depend on, and of those that measure it too
    std::string run_sources, cell_sources;
    std::string compiler, flags, build;  // build: CMake's build type
    std::string vectors;                 // the instructions that the kernels chose
    std::string cpu, system;
    int cores;
};
const Machine& machine();

// What numbers depend on beside scene and settings, as JSON: sources, compiler, flags, build type,
// vector instructions, plugins by their contents. What was recorded by another is not this
// program's. Commit and version say nothing here: they may change with a word of the documentation,
// and two builds of uncommitted changes share them.
// of a run, with the plugins loaded
std::string run_identity(const Machine& = machine());
// of a cell
std::string program_identity(const std::vector<std::string>& plugins, const Machine& = machine());

// What a clock's figures depend on beside that. `name` is the same on machines of one kind with one
// program: costs compare there alone.
struct Stamp {
    std::string name;      // "AMD EPYC 7763, 2 cores, AVX2, GNU 12.2.0 -O3 -ffp-contract=off"
    std::string host, at;  // at: now_utc
    // the average number of running processes over a minute, "" where it is not known
    std::string load;
    std::string governor;  // of the clock of its processors: "performance"; "" likewise
};
Stamp stamp_now();
nlohmann::ordered_json json_of(const Stamp&);
Stamp stamp_of(const nlohmann::ordered_json&);  // throws std::exception where it is none

// All of it, the date and the plugins loaded (file, hash, compiler, flags) as an object: what a
// manifest begins with.
nlohmann::ordered_json made_by();
std::string now_utc();  // "2016-05-04T12:00:00Z"

}  // namespace jvari::bench::store

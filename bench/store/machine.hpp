// What a result depends on beside its scene: the program, its compiler and the machine.
#pragma once

#include <string>
#include <vector>

namespace jvari::bench::store {

struct Machine {
    std::string version, commit;         // commit: git describe when built, "unknown" outside git
    std::string compiler, flags, build;  // build: CMake's build type
    std::string cpu, system;
    int cores;
};
const Machine& machine();

// JSON: version, commit, build type, plugins by their contents. What was recorded by another is not this program's.
std::string program_identity(const std::vector<std::string>& plugins, const Machine& = machine());

// All of it, the date and the plugins loaded (file, hash, compiler, flags) as a JSON object: what a manifest begins with.
std::string made_by();
std::string now_utc();  // "2016-05-04T12:00:00Z"

}  // namespace jvari::bench::store

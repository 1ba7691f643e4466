// Minimised reproducers: a scene file <scheme>-<outcome>.toml for each way in which a scheme fails, and index.csv that says how to run it
// and what becomes of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/map/map_run.hpp"

namespace jvari::bench::map {

struct Reproducer {
    std::string file;  // within its folder
    Trial trial;
    study::Judgement expected;
};

// Of each scheme and outcome that is neither sound nor refused, the failure that took the fewest steps, among maps that reproduce theirs.
// What was minimised is kept beside the points, so that processes that share a folder minimise each once.
std::vector<Reproducer> reproducers_of(const MapRun&, const compare::Catalogue&, const MapRequest&, const store::Listener&);

void write_failures(const std::filesystem::path& folder, const std::vector<Reproducer>&);
std::vector<Reproducer> read_failures(const std::filesystem::path& folder, const compare::Catalogue&);

}  // namespace jvari::bench::map

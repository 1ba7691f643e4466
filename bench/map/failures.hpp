// Minimised reproducers: a scene file <scheme>-<outcome>.toml for each way in which a scheme fails,
// and index.csv that says how to run it and what becomes of it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/map/map_run.hpp"
#include "bench/map/trial.hpp"

namespace jvari::bench::map {

struct Reproducer {
    std::string file;  // within its folder
    Trial trial;
    study::Judgement expected;
};

// Of each scheme and outcome that is neither sound nor without a run (refused, error), the failure
// that took the fewest steps, among maps that reproduce theirs.
// What was minimised is kept beside the points, so that processes that share a folder minimise each
// once.
std::vector<Reproducer> reproducers_of(const MapRun&, const compare::Catalogue&, const MapRequest&,
                                       const store::Listener&);

void write_failures(const std::filesystem::path& folder, const std::vector<Reproducer>&);
std::vector<Reproducer> read_failures(const std::filesystem::path& folder,
                                      const compare::Catalogue&);

// ---- A trial that fails, made as small as it still fails in the same way: delta debugging over
// what a scene and its settings are made of.
//
// Taken away one by one, in turn, until nothing more can be (scenes/reduction.hpp): strings,
// barriers, polarisation, pluck or initial shape (one of the two stays), thread, losses, bending
// stiffness, contact losses, an exponent other than 1; then duration, modes or the grid's intervals
// are shortened by halves, quarters ... down to single rows and modes.
// What is left is minimal step by step, not the smallest of all.

// in the way that is to be kept; what it throws counts as no
using Fails = std::function<bool(const Trial&)>;

Trial minimised(Trial, const Fails&);

}  // namespace jvari::bench::map

// A suite dealt out to processes that share nothing but a folder, on one machine or on many.
//
// A part is what one process does as a whole: the numbers of a cell; the clock of a set, for its cells are timed in one interleaved run on
// one machine; a row of a map, whose boundaries are found between its own points. Who does what follows from the suite and the number of
// shards alone, so that no process has to ask another.
#pragma once

#include <string>
#include <vector>

#include "bench/map/map_run.hpp"
#include "bench/suite/suite_run.hpp"

namespace jvari::bench::suite {

struct Shard {
    int number = 1, of = 1;  // 1 ... of
};
Shard shard_of(const std::string& text);  // "3/20"; throws UsageError

struct Parts {
    const SuitePlan& plan;
    std::vector<map::MapRow> rows;
    std::vector<store::Rows> clocks;
};
Parts parts_of(const SuitePlan&, const std::vector<map::Map>&, const compare::Catalogue&);

// plan.csv: part (what addresses it), kind, what, seconds (roughly, on one core). A shard compares it with its own: another program, or one
// that chose other vector instructions, has other numbers.
store::Table parts_table(const Parts&, const std::string& program);

struct Share {
    SuiteWork work;
    std::vector<map::MapRow> rows;
};
// Parts are dealt in turn, the longest first. Clocks go to the last shards, at most half of them, so that those can have a machine each to
// themselves.
Share share_of(const Parts&, const Shard&);
int clock_shards(const Parts&, int of);  // how many of the last shards have clocks

}  // namespace jvari::bench::suite

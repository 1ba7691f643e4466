// What a cell of a suite came to, as it is kept: one file per cell, DIR/cells/<id>.json, written by rename.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/compare/compare.hpp"
#include "bench/store/records.hpp"
#include "bench/suite/spectrogram_levels.hpp"
#include "bench/suite/suite_clock.hpp"
#include "bench/suite/suite_plan.hpp"

namespace jvari::bench::suite {

struct SuiteRecord {
    store::Table row;                  // one row, the columns of compare's cells.csv
    std::string reference;             // name, "" where there was none
    bool ran = false;                  // up to its end or to a failure: it can be timed
    bool timed = false;                // its row has a clock's figures: they are kept apart from it (suite_clock.hpp)
    double duration = 0, seconds = 0;  // simulated, and wall time of the accuracy run [s]
    long steps = 0;
    Levels levels;                             // of the spectrogram; none where it was not asked for
    std::map<std::string, store::Table> rows;  // of each facet that makes rows and was asked for
    store::Stamp stamp;                        // of the machine that ran it
};

struct Against {  // what a cell was measured against; nothing is known of a reference that there was not
    compare::Errors floor;
    trust::Trust trust, model_trust;
    int modes = 0;
    std::string truth;  // as Comparison has it
};
SuiteRecord record_of(const PlannedCell&, const compare::Cell& measured, const Against&);
void add_clock(SuiteRecord&, const PlannedCell&, const KeptClock&);

std::string json_of(const SuiteRecord&, const std::string& identity);
// Nothing where there is no such file, it is of another cell, its checksum is not its own, or it cannot be read.
std::optional<SuiteRecord> read_record(const std::filesystem::path&, const std::string& identity);

// One row per cell in the order of the plan: which cell, scene, swept keys and options, then the columns of compare, the front aside.
store::Table table_of(const SuitePlan&, const std::vector<SuiteRecord>&);

// The rows of one facet over all cells, each behind what names its cell: cell, scene, swept keys, scheme, options, rate, modes.
store::Table rows_of(const std::string& facet, const SuitePlan&, const std::vector<SuiteRecord>&);

}  // namespace jvari::bench::suite

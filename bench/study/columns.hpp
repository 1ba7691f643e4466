// The columns of cells.csv, each declared once: its name, its unit, what it means, what it says of
// a record, and how far it may move. Tables, errors.csv and cost.csv, `jvari diff` and `jvari list
// columns` follow from that.
#pragma once

#include <string>
#include <vector>

#include "bench/study/job.hpp"

namespace jvari::bench::study {

// how a number may differ between two programs that are right (bench/diff/rules.hpp)
enum class Rule {
    name,         // of the cell, in one study alone: not compared
    text,         // the same or not
    closed_form,  // or a count that the settings fix
    error,        // has a noise floor
    floor,        // a noise floor
    instant,      // [s]
    step,         // of a run
    ledger,       // a residual of the energy balance
    force,        // of a contact, that may be 0 [N]
    depth,        // likewise [m]
    motion,       // follows the motion, and has no noise floor of its own
    fact,         // of a scheme
    clock         // of a machine: it stands in cost.csv
};

struct Column {
    // with {m} for a measure's column, {d} for one where less is better, {M} for one in the model,
    // {w} for a window of the certificate, {f} for a fact, {t} for a tap: a column for each
    const char* name;
    const char* unit;
    Rule rule;
    const char* meaning;  // "" where the column before it says it
};
const std::vector<Column>& columns();
// of a name as it stands in a table; `name` where there is no such column
Rule rule_of(const std::string& column);

// A row for each job, in the order of the plan: cell, scene, swept keys, then columns().
store::Table table_of(const Plan&, const std::vector<Record>&);
store::Table errors_only(const store::Table& cells);  // what repeats bit for bit on one program
// what a clock said, and which cell it said it of
store::Table cost_only(const store::Table& cells);

// The rows of one facet over all jobs, each behind what names its cell: cell, scene, swept keys,
// scheme, options, rate, modes.
store::Table rows_of(const std::string& facet, const Plan&, const std::vector<Record>&);

}  // namespace jvari::bench::study

// A cell as tables have it: what a run says of itself, its errors on each tap, and what the clock
// said. In memory numbers are numbers; on disk a folder has
//   cells.csv   a row per cell, to look at: its names, headline errors and costs
//   facts.csv   a row per cell: what a run says of itself and repeats bit for bit on one program
//   errors.csv  a row per cell, tap and measure; likewise
//   cost.csv    a row per cell: what the clock said
// The last three are read back. cells.csv follows from them, and is not.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bench/study/job.hpp"

namespace jvari::bench::study {

struct Figure {  // an error, and what is known of it
    double value = nan;
    double floor = nan;        // of noise: of the reference started 1e-12 apart
    double certificate = nan;  // the uncertainty of the reference for the scene
    // against a reference with as many modes as the scheme, and how far that solves its model
    double in_model = nan, certificate_in_model = nan;
};
// as errors.csv calls them
constexpr std::pair<const char*, double Figure::*> figure_parts[] = {
    {"value", &Figure::value},
    {"floor", &Figure::floor},
    {"certificate", &Figure::certificate},
    {"in_model", &Figure::in_model},
    {"certificate_in_model", &Figure::certificate_in_model}};

struct TabledCell {
    std::string cell, scene;
    std::vector<std::pair<std::string, std::string>> swept;  // key, value
    std::string scheme, options, status, flags, machine, load, governor, untimed, below_floor,
        reference, reason, cause, reference_doubling, headline_nut, headline_bridge;
    double rate = nan, modes = nan;
    double cost_s_per_s = nan, cost_lower = nan, cost_upper = nan, processor_s_per_s = nan,
           processor_lower = nan, processor_upper = nan, wall_seconds = nan,
           wall_seconds_lower = nan, wall_seconds_upper = nan, ns_per_step = nan,
           times_real_time = nan, worst_block_of_deadline = nan, repeats = nan, pareto = nan;
    double energy_residual_per_step = nan, energy_residual_accumulated = nan,
           smallest_contact_force = nan, deepest_penetration = nan, dofs = nan, state_bytes = nan,
           steps = nan, failed_step = nan, failed_at_s = nan, reference_modes = nan,
           free_from_s = nan, reference_horizon_s = nan;
    std::vector<std::pair<std::string, double>> facts;
    std::vector<std::string> taps;
    std::vector<std::vector<Figure>> figures;  // by tap, by measure

    // `tap` "": the headline's
    const Figure& figure(std::size_t measure, const std::string& tap = "") const;
    double fact(const std::string& name) const;  // NaN where it has none
    std::string variant() const { return store::variant_name(scheme, options); }
    bool same_series(const TabledCell& o) const {  // but for rate and modes
        return scene == o.scene && swept == o.swept && scheme == o.scheme && options == o.options;
    }
    std::string problem() const;  // its scene and what is swept of it: "string, tension = 30"
    // "modal_two_point compliance=matched, 133 modes at 88.2 kHz"; of a grid, which takes its nodes
    // from the rate, without them
    std::string run() const;
};
using Cells = std::vector<TabledCell>;

// how a number may differ between two programs that are right (bench/suite/difference_rules.cpp)
enum class Rule {
    name,         // of the cell, in one study alone, or what follows from the rest: not compared
    text,         // the same or not
    closed_form,  // or a count that the settings fix
    instant,      // [s]
    step,         // of a run
    ledger,       // a residual of the energy balance
    force,        // of a contact, that may be 0 [N]
    depth,        // likewise [m]
    clock         // of a machine: it stands in cost.csv
};

struct Column {
    const char* name;
    const char* unit;
    Rule rule;
    std::variant<std::string TabledCell::*, double TabledCell::*> field;
    const char* meaning;   // "" where the column before it says it
    bool in_cells = true;  // it stands in cells.csv too
    std::string text(const TabledCell&) const;
};
const std::vector<Column>& columns();  // but `cell` and what is swept

Cells cells_of(const Plan&, const std::vector<Record>&);  // in the order of the plan

enum class Contents { cells, facts, cost, everything };  // the last: of all three, but taps
store::Table table_of(const Cells&, Contents);
store::Table errors_table(const Cells&);

// Of a folder of results; none where there is no facts.csv. `whole`: throws UsageError where
// cost.csv has other cells.
Cells read_cells(const std::filesystem::path& folder, bool whole);

// ---- Cells gathered by what they have in common: the series that fits and charts are made of.

using Rows = std::vector<std::size_t>;
Rows all_rows(const Cells&);
std::vector<std::string> swept_keys(const Cells&);

// `rows` in groups with the same key(row), in the order in which they come.
template <class Key>
std::vector<Rows> alike(const Rows& rows, Key key) {
    std::vector<std::pair<std::string, Rows>> groups;
    for (const std::size_t row : rows) {
        const std::string name = key(row);
        auto it = std::ranges::find(groups, name, &std::pair<std::string, Rows>::first);
        if (it == groups.end()) it = groups.insert(groups.end(), {name, {}});
        it->second.push_back(row);
    }
    std::vector<Rows> all;
    for (auto& [name, group] : groups) all.push_back(std::move(group));
    return all;
}
std::vector<Rows> by_problem(const Cells&, const Rows&);

}  // namespace jvari::bench::study

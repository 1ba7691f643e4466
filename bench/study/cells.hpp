// Cells in the form of tables: a run's own figures, its errors on each tap, and its measured times.
// Memory holds numbers; a folder on disk has
//   cells.csv   a row per cell, to look at: names, headline errors and costs
//   facts.csv   a row per cell: the run's own figures, the same bit for bit with one program
//   errors.csv  a row per cell, tap and measure; also the same bit for bit
//   cost.csv    a row per cell: measured times
// The program reads back the last three. cells.csv follows from them and is not read. In
// results.json (store::Folder) the table of cells has what the first, second and last have.
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bench/study/job.hpp"

namespace jvari::bench::study {

struct Figure {  // error with its uncertainty
    double value = nan;
    double floor = nan;        // noise floor: error of the reference started 1e-12 apart
    double certificate = nan;  // uncertainty of the reference for the scene
    // error against a reference with the scheme's number of modes, and the accuracy to which this
    // reference solves its model
    double in_model = nan, certificate_in_model = nan;
};
// names in errors.csv
constexpr std::pair<const char*, double Figure::*> figure_parts[] = {
    {"value", &Figure::value},
    {"floor", &Figure::floor},
    {"certificate", &Figure::certificate},
    {"in_model", &Figure::in_model},
    {"certificate_in_model", &Figure::certificate_in_model}};

// Fact of a cell beside those of its run: Truth::limit_hz [Hz].
constexpr const char* reference_limit = "reference_limit_hz";

struct TabledCell {
    std::string cell, scene;
    std::vector<std::pair<std::string, std::string>> swept;  // key, value
    store::Options options;
    std::string scheme, status, flags, machine, governor, untimed, below_floor, reference, reason,
        cause, reference_doubling, headline_nut, headline_bridge;
    double rate = nan, modes = nan;
    double cost_s_per_s = nan, cost_lower = nan, cost_upper = nan, processor_s_per_s = nan,
           processor_lower = nan, processor_upper = nan, wall_seconds = nan,
           wall_seconds_lower = nan, wall_seconds_upper = nan, ns_per_step = nan,
           times_real_time = nan, worst_block_of_deadline = nan, repeats = nan, load = nan;
    std::optional<bool> pareto;
    double energy_residual_per_step = nan, energy_residual_accumulated = nan,
           smallest_contact_force = nan, deepest_penetration = nan, dofs = nan, state_bytes = nan,
           steps = nan, failed_step = nan, failed_at_s = nan, reference_modes = nan,
           free_from_s = nan, reference_horizon_s = nan;
    std::vector<std::pair<std::string, double>> facts;
    std::vector<std::string> taps;
    std::vector<std::vector<Figure>> figures;  // by tap, by measure

    // `tap` "": the headline's
    const Figure& figure(std::size_t measure, const std::string& tap = "") const;
    double fact(const std::string& name) const;  // NaN if absent
    std::string variant() const {
        return store::variant_name(scheme, store::options_text(options));
    }
    bool same_series(const TabledCell& o) const {  // same but for rate and modes
        return scene == o.scene && swept == o.swept && scheme == o.scheme && options == o.options;
    }
    std::string problem() const;  // scene and swept values: "string, tension = 30"
    // "modal_two_point compliance=matched, 133 modes at 88.2 kHz". A grid takes its nodes from the
    // rate, so its text has no modes.
    std::string run() const;
};
using Cells = std::vector<TabledCell>;

// Tolerance class of a number that two correct programs may give differently
// (bench/suite/difference_rules.cpp).
enum class Rule {
    // not compared: a name, a value known in one study only, or a value that follows from the
    // others
    name,
    text,         // equal or not
    closed_form,  // closed form, or a count that the settings fix
    instant,      // [s]
    step,         // step of a run
    ledger,       // residual of the energy balance
    force,        // contact force, may be 0 [N]
    depth,        // depth of a contact, may be 0 [m]
    clock         // time of a machine, in cost.csv
};

struct Column {
    const char* name;
    const char* unit;
    Rule rule;
    std::variant<std::string TabledCell::*, double TabledCell::*, std::optional<bool> TabledCell::*,
                 store::Options TabledCell::*>
        field;
    const char* meaning;   // "" if the column before has the meaning
    bool in_cells = true;  // true: also in cells.csv
    store::Field value(const TabledCell&) const;
    void read(TabledCell&, const store::Field&) const;
};
const std::vector<Column>& columns();  // all columns except `cell` and the swept keys

Cells cells_of(const Plan&, const std::vector<Record>&);  // in the order of the plan

// everything: the columns of all three, without taps
enum class Contents { cells, facts, cost, everything };
store::Table table_of(const Cells&, Contents);
store::Table errors_table(const Cells&);

// Reads a folder of results; empty if it has no cells. `whole`: throws UsageError if cost.csv has
// other cells.
Cells read_cells(const store::Folder&, bool whole);

// ---- Groups of cells that share properties: the series behind fits and charts.

using Rows = std::vector<std::size_t>;
Rows all_rows(const Cells&);
std::vector<std::string> swept_keys(const Cells&);

// Groups `rows` by key(row), in the order of first appearance.
template <class Key>
std::vector<Rows> alike(const Rows& rows, Key key) {
    using Name = std::decay_t<decltype(key(std::size_t{}))>;
    std::vector<std::pair<Name, Rows>> groups;
    for (const std::size_t row : rows) {
        const Name name = key(row);
        auto it = std::ranges::find(groups, name, &std::pair<Name, Rows>::first);
        if (it == groups.end()) it = groups.insert(groups.end(), {name, {}});
        it->second.push_back(row);
    }
    std::vector<Rows> all;
    for (auto& [name, group] : groups) all.push_back(std::move(group));
    return all;
}
std::vector<Rows> by_problem(const Cells&, const Rows&);

}  // namespace jvari::bench::study

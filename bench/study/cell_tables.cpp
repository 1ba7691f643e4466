// The columns of cells.csv, facts.csv and cost.csv, each declared once; errors.csv; and cells read
// back from them.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/cells.hpp"

namespace jvari::bench::study {

namespace {
using C = TabledCell;
using Texts = std::vector<std::string>;

constexpr bool elsewhere = false;  // not in cells.csv

std::size_t place_of(const Texts& names, const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}
}  // namespace

const std::vector<Column>& columns() {
    static const std::vector<Column> all = {
        {"scene", "", Rule::text, &C::scene, "the scene"},
        {"scheme", "", Rule::text, &C::scheme, "the scheme"},
        {"options", "", Rule::text, &C::options, "its options, where they are not the default"},
        {"rate", "Hz", Rule::closed_form, &C::rate,
         "steps per second; empty for a scheme in continuous time"},
        {"modes", "", Rule::closed_form, &C::modes,
         "modes of the first string; interior nodes of a grid"},
        {"status", "", Rule::text, &C::status,
         "`ok`, `diverged`, `not_converged`, `refused`, `past_time_limit`, `error` or "
         "`not_needed`"},
        {"flags", "", Rule::text, &C::flags,
         "what the run's own figures say against it: `adhesion`, `psi_gap`, `energy`, "
         "`modes_above_nyquist`"},
        {"cost_s_per_s", "1", Rule::clock, &C::cost_s_per_s,
         "computing time per second of sound: median of the timed runs"},
        {"cost_lower", "1", Rule::clock, &C::cost_lower, "its quartiles"},
        {"cost_upper", "1", Rule::clock, &C::cost_upper, ""},
        {"processor_s_per_s", "1", Rule::clock, &C::processor_s_per_s,
         "the same in processor time. A slow-down that all samples of a round at one rate share "
         "counts as drift of the machine and is subtracted"},
        {"processor_lower", "1", Rule::clock, &C::processor_lower, "", elsewhere},
        {"processor_upper", "1", Rule::clock, &C::processor_upper, "", elsewhere},
        {"wall_seconds", "s", Rule::clock, &C::wall_seconds, "of the whole run"},
        {"wall_seconds_lower", "s", Rule::clock, &C::wall_seconds_lower, "", elsewhere},
        {"wall_seconds_upper", "s", Rule::clock, &C::wall_seconds_upper, "", elsewhere},
        {"ns_per_step", "ns", Rule::clock, &C::ns_per_step, "`wall_seconds` over the steps"},
        {"times_real_time", "1", Rule::clock, &C::times_real_time, "1 / `cost_s_per_s`"},
        {"worst_block_of_deadline", "1", Rule::clock, &C::worst_block_of_deadline,
         "worst-case load: computing time of the slowest block of 64 rows over the time that those "
         "rows sound, the best of all timed runs. Above 1 a player would stutter"},
        {"repeats", "", Rule::clock, &C::repeats, "how many samples the clock took"},
        {"machine", "", Rule::clock, &C::machine,
         "what timed it: costs compare on one kind of machine alone"},
        {"load", "", Rule::clock, &C::load, "of that machine while it did"},
        {"governor", "", Rule::clock, &C::governor, "of its processors' clock"},
        {"untimed", "", Rule::clock, &C::untimed, "why no clock is asked of the scheme"},
        {"pareto", "", Rule::clock, &C::pareto,
         "1: no other run is surely better in headline error and cost"},
        {"below_floor", "", Rule::name, &C::below_floor,
         "the headline errors that are no larger than their noise floor: a tie with every other "
         "such cell"},
        {"energy_residual_per_step", "1", Rule::ledger, &C::energy_residual_per_step,
         "how far the energy ledger is from closing, relative to the largest stored energy"},
        {"energy_residual_accumulated", "1", Rule::ledger, &C::energy_residual_accumulated, ""},
        {"smallest_contact_force", "N", Rule::force, &C::smallest_contact_force,
         "a negative force pulls"},
        {"deepest_penetration", "m", Rule::depth, &C::deepest_penetration,
         "how far the string went into the barrier"},
        {"dofs", "", Rule::closed_form, &C::dofs, "doubles of state"},
        {"state_bytes", "bytes", Rule::closed_form, &C::state_bytes, "the same in bytes",
         elsewhere},
        {"steps", "", Rule::closed_form, &C::steps, "steps taken"},
        {"failed_step", "", Rule::step, &C::failed_step, "where it failed", elsewhere},
        {"failed_at_s", "s", Rule::instant, &C::failed_at_s, "", elsewhere},
        {"headline_nut", "", Rule::text, &C::headline_nut,
         "the tap of the headline errors, but third octaves", elsewhere},
        {"headline_bridge", "", Rule::text, &C::headline_bridge, "the tap of third octaves",
         elsewhere},
        {"reference", "", Rule::text, &C::reference, "what the errors are measured against"},
        {"reason", "", Rule::text, &C::reason, "of a refusal or a failure"},
        {"cause", "", Rule::text, &C::cause, "what explains most of its headline error", elsewhere},
        {"reference_modes", "", Rule::closed_form, &C::reference_modes, "modes of the reference",
         elsewhere},
        {"free_from_s", "s", Rule::closed_form, &C::free_from_s,
         "where the windows of the errors begin: the end of the last pluck, 0 without one"},
        {"reference_horizon_s", "s", Rule::instant, &C::reference_horizon_s,
         "until when the reference stays within 10 % of itself, started a relative 1e-12 apart",
         elsewhere},
        {"reference_doubling", "", Rule::text, &C::reference_doubling,
         "how far its modes were doubled", elsewhere},
    };
    return all;
}

store::Field Column::value(const TabledCell& c) const {
    if (const auto* words = std::get_if<std::string C::*>(&field)) return c.*(*words);
    if (const auto* number = std::get_if<double C::*>(&field)) return c.*(*number);
    if (const auto* options = std::get_if<store::Options C::*>(&field))
        return store::options_text(c.*(*options));
    const std::optional<bool> holds = c.*std::get<std::optional<bool> C::*>(field);
    return holds ? store::Field(*holds) : store::Field();
}

void Column::read(TabledCell& c, const store::Field& from) const {
    if (const auto* words = std::get_if<std::string C::*>(&field)) c.*(*words) = from.text();
    else if (const auto* number = std::get_if<double C::*>(&field)) c.*(*number) = from.number();
    else if (const auto* options = std::get_if<store::Options C::*>(&field))
        c.*(*options) = store::options_in(from.text());
    else if (!from.empty()) c.*std::get<std::optional<bool> C::*>(field) = from.number() == 1;
}

// ---- Tables

namespace {
Texts fact_names(const Cells& cells) {
    Texts names;
    for (const TabledCell& c : cells)
        for (const auto& [name, value] : c.facts)
            if (place_of(names, name) == names.size()) names.push_back(name);
    return names;
}

bool belongs(const Column& c, Contents to) {
    const std::string name = c.name;
    if (name == "scene" || name == "scheme" || name == "options" || name == "rate" ||
        name == "modes" || name == "status")
        return true;
    return to == Contents::everything ||
           (to == Contents::cells ? c.in_cells : (c.rule == Rule::clock) == (to == Contents::cost));
}
}  // namespace

store::Table table_of(const Cells& cells, Contents contents) {
    store::Table t{{"cell"}, std::vector<std::vector<store::Field>>(cells.size())};
    for (std::size_t i = 0; i < cells.size(); ++i) t.rows[i].emplace_back(cells[i].cell);
    const auto add = [&](const std::string& name, const auto& value) {
        t.columns.push_back(name);
        for (std::size_t i = 0; i < cells.size(); ++i) t.rows[i].push_back(value(cells[i]));
    };
    for (const Column& column : columns()) {
        if (belongs(column, contents))
            add(column.name, [&](const TabledCell& c) { return column.value(c); });
        const std::string name = column.name;
        if (name == "scene")
            for (const std::string& key : swept_keys(cells))
                add(key, [&](const TabledCell& c) {
                    const auto own = std::ranges::find(c.swept, key,
                                                       &std::pair<std::string, std::string>::first);
                    return own == c.swept.end() ? store::Field()
                                                : store::Field::as_written(own->second);
                });
        if (name == "flags" && (contents == Contents::cells || contents == Contents::everything))
            for (std::size_t m = 0; m < measures().size(); ++m)
                add(measures()[m].column,
                    [m](const TabledCell& c) -> store::Field { return c.figure(m).value; });
    }
    if (contents == Contents::facts || contents == Contents::everything)
        for (const std::string& name : fact_names(cells))
            add("fact_" + name, [&](const TabledCell& c) -> store::Field { return c.fact(name); });
    return t;
}

store::Table errors_table(const Cells& cells) {
    store::Table t{{"cell", "tap", "measure"}, {}};
    for (const auto& [name, part] : figure_parts) t.columns.emplace_back(name);
    for (const TabledCell& c : cells)
        for (std::size_t tap = 0; tap < c.taps.size(); ++tap)
            for (std::size_t m = 0; m < measures().size(); ++m) {
                std::vector<store::Field> row{c.cell, c.taps[tap], measures()[m].column};
                for (const auto& [name, part] : figure_parts)
                    row.emplace_back(c.figures[tap][m].*part);
                if (std::any_of(row.begin() + 3, row.end(),
                                [](const store::Field& v) { return !v.empty(); }))
                    t.rows.push_back(std::move(row));
            }
    return t;
}

// ---- Read back

namespace {
void fill(TabledCell& c, const store::Table& t, std::size_t row) {
    for (const Column& column : columns())
        if (t.column(column.name) >= 0) column.read(c, t.at(row, column.name));
}

bool is_swept(const std::string& column) {  // column between scene and scheme
    return column != "cell" && !column.starts_with("fact_") &&
           std::ranges::find(columns(), column, &Column::name) == columns().end();
}

Cells cells_in(const store::Table& facts) {
    Cells cells(facts.rows.size());
    const int from = facts.column("scene"), to = facts.column("scheme");
    for (std::size_t i = 0; i < cells.size(); ++i) {
        TabledCell& c = cells[i];
        c.cell = facts.text(i, "cell");
        fill(c, facts, i);
        for (int k = from + 1; from >= 0 && k < to; ++k)
            if (!facts.rows[i][k].empty() && is_swept(facts.columns[k]))
                c.swept.emplace_back(facts.columns[k], facts.rows[i][k].text());
        for (std::size_t k = 0; k < facts.columns.size(); ++k) {
            if (!facts.columns[k].starts_with("fact_")) continue;
            if (const double x = facts.rows[i][k].number(); !std::isnan(x))
                c.facts.emplace_back(facts.columns[k].substr(5), x);
        }
    }
    return cells;
}
}  // namespace

Cells read_cells(const store::Folder& folder, bool whole) {
    const auto with = [&](const char* name, std::initializer_list<const char*> required) {
        store::Table t = folder.table(name);
        for (const char* column : required)
            if (!t.columns.empty() && t.column(column) < 0)
                throw store::UsageError(fmt::format(
                    "{}: found no column {}; make the results again", folder.file(name), column));
        return t;
    };
    // In results.json the table of cells has the facts and the costs.
    const char* const own = folder.is_one_file() ? "cells" : "facts";
    const store::Table facts = with(own, {"cell", "scheme", "rate", "status", "flags"});
    if (facts.columns.empty()) return {};
    if (facts.rows.empty())
        throw store::UsageError(folder.file(own) +
                                ": it has no row below its header; make the results again");
    Cells cells = cells_in(facts);
    std::map<std::string, TabledCell*> named;
    for (TabledCell& c : cells)
        if (!named.emplace(c.cell, &c).second)
            throw store::UsageError(
                fmt::format("{}: row {}: found the cell {} for the second time, expected one row "
                            "per cell",
                            folder.file(own), &c - cells.data() + 1, c.cell));
    const auto refuse = [&](const char* table, const std::string& cell) {
        throw store::UsageError(
            fmt::format("{}: found the cell {}, which {} has not", folder.file(table), cell,
                        std::filesystem::path(folder.file(own)).filename().string()));
    };
    const store::Table errors = with("errors", {"cell", "tap", "measure", "value", "floor"}),
                       cost = with("cost", {"cell", "scheme", "rate"});
    for (std::size_t i = 0; i < errors.rows.size(); ++i) {
        const auto found = named.find(errors.text(i, "cell"));
        if (found == named.end()) refuse("errors", errors.text(i, "cell"));
        TabledCell& c = *found->second;
        const std::string name_of_tap = errors.text(i, "tap");
        const std::size_t m = measure(errors.text(i, "measure")),
                          tap = place_of(c.taps, name_of_tap);
        if (m == measures().size()) continue;
        if (tap == c.taps.size()) {
            c.taps.push_back(name_of_tap);
            c.figures.emplace_back(measures().size());
        }
        for (const auto& [name, part] : figure_parts)
            c.figures[tap][m].*part = errors.number(i, name);
    }
    for (std::size_t i = 0; i < cost.rows.size(); ++i) {
        const auto found = named.find(cost.text(i, "cell"));
        const bool same = found != named.end() && found->second->scheme == cost.text(i, "scheme") &&
                          found->second->rate == cost.at(i, "rate");
        if (same) fill(*found->second, cost, i);
        else if (whole) refuse("cost", cost.text(i, "cell"));
    }
    return cells;
}

}  // namespace jvari::bench::study

#include "bench/diff/difference.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "bench/diff/costs.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::diff {

namespace {
std::vector<Pair> in_both(const Named& before, const Named& after, Only& only) {
    std::vector<Pair> pairs;
    for (const auto& [name, row] : before)
        if (const auto other = after.find(name); other != after.end())
            pairs.push_back({name, row, other->second});
        else only.before.push_back(name);
    for (const auto& [name, row] : after)
        if (!before.contains(name)) only.after.push_back(name);
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& a, const Pair& b) { return a.before < b.before; });
    return pairs;
}

// Those of `before` that are compared: an error whose column is gone is an error that is no longer
// known.
std::vector<std::string> compared_columns(const store::Table& before, const store::Table& after) {
    std::vector<std::string> names;
    for (const std::string& name : before.columns)
        if (!is_cost(name) && !is_skipped(name) && (after.column(name) >= 0 || is_judged(name)))
            names.push_back(name);
    return names;
}

// A column that a table of one row more would have, empty wherever there is none, is no difference:
// only those that say something count.
void columns_alone(const store::Table& a, const store::Table& b, std::vector<std::string>& only) {
    for (const std::string& name : a.columns) {
        if (b.column(name) >= 0 || is_cost(name) || is_skipped(name)) continue;
        const int k = a.column(name);
        if (std::any_of(a.rows.begin(), a.rows.end(),
                        [k](const auto& row) { return !row[k].empty(); }))
            only.push_back(name);
    }
}

void compare_cells(const Folder& a, const Folder& b, Difference& d) {
    const bool with_modes = modes_name(a.cells) || modes_name(b.cells);
    // comparisons of before had no such column
    const bool with_scene = a.cells.column("scene") >= 0 && b.cells.column("scene") >= 0;
    const auto pairs = in_both(named_cells(a.cells, with_modes, with_scene),
                               named_cells(b.cells, with_modes, with_scene), d.cells);
    d.cells_in_both = static_cast<int>(pairs.size());
    columns_alone(a.cells, b.cells, d.columns.before);
    columns_alone(b.cells, a.cells, d.columns.after);
    for (const char* column : {"status", "flags"})
        if (a.cells.column(column) >= 0 && b.cells.column(column) < 0)
            d.findings.push_back(
                {Turn::worse, "every cell", column, "known", "", "the column is gone"});
    const auto columns = compared_columns(a.cells, b.cells);
    int other_truth = 0;
    std::string how;
    for (const Pair& p : pairs) {
        bool same_truth = true, same_digits = true;
        for (const std::string& column : columns) {
            ++d.compared;
            same_digits =
                same_digits && a.cells.at(p.before, column) == b.cells.at(p.after, column);
            const Turn turn = turn_of(column, a.cells, p.before, b.cells, p.after);
            if (turn == Turn::same) continue;
            d.findings.push_back({turn, p.name, column, a.cells.at(p.before, column),
                                  b.cells.at(p.after, column), ""});
            if (column != "reference" && column != "reference_modes" &&
                column != "reference_doubling")
                continue;
            same_truth = false;
            const std::string change = fmt::format(
                "{} {} -> {}", column, a.cells.at(p.before, column), b.cells.at(p.after, column));
            if (how.size() < 100 && how.find(change) == std::string::npos)
                how += (how.empty() ? "" : ", ") + change;
        }
        other_truth += !same_truth;
        d.to_the_last_digit += same_digits;
    }
    if (other_truth > 0)
        d.references = fmt::format(
            "the references differ in {} of {} cells ({}): there errors are against another "
            "solution",
            other_truth, pairs.size(), how);
    compare_costs(a, b, pairs, d);
}

void compare_dispersion(const store::Table& a, const store::Table& b, Difference& d) {
    const std::vector<std::string> names{"scene", "scheme", "options", "rate", "mode"};
    for (const Pair& p : in_both(named_rows(a, names), named_rows(b, names), d.modes))
        for (const char* column :
             {"own_cents", "own_decay_per_s", "trace_cents", "trace_decay_per_s"}) {
            ++d.compared;
            const Turn turn =
                dispersion_turn(column, a.number(p.before, column), b.number(p.after, column));
            if (turn != Turn::same)
                d.findings.push_back({turn, "mode: " + p.name, column, a.at(p.before, column),
                                      b.at(p.after, column), ""});
        }
}

void compare_maps(const Folder& a, const Folder& b, Difference& d) {
    const std::vector<std::string> names{"map", "scene", "scheme", "x_key", "x", "y_key", "y"};
    for (const Pair& p : in_both(named_rows(a.maps, names), named_rows(b.maps, names), d.points)) {
        ++d.compared;
        const std::string &was = a.maps.at(p.before, "outcome"),
                          &is = b.maps.at(p.after, "outcome");
        const Turn turn = was == is        ? Turn::same
                          : was == "sound" ? Turn::worse
                          : is == "sound"  ? Turn::better
                                           : Turn::moved;
        if (turn != Turn::same)
            d.findings.push_back(
                {turn, "map " + p.name, "outcome", was, is, b.maps.at(p.after, "detail")});
    }
    const std::vector<std::string> lines{"map", "scheme", "x_key", "y_key", "y", "between"};
    for (const Pair& p :
         in_both(named_rows(a.boundaries, lines), named_rows(b.boundaries, lines), d.boundaries)) {
        ++d.compared;
        const auto low = [](const store::Table& t, std::size_t i) { return t.number(i, "x_low"); };
        const auto high = [](const store::Table& t, std::size_t i) {
            return t.number(i, "x_high");
        };
        if (low(a.boundaries, p.before) <= high(b.boundaries, p.after) &&
            low(b.boundaries, p.after) <= high(a.boundaries, p.before))
            continue;
        d.findings.push_back({Turn::moved, "boundary " + p.name, "x_low",
                              a.boundaries.at(p.before, "x_low"), b.boundaries.at(p.after, "x_low"),
                              "the brackets are apart"});
    }
}
}  // namespace

int Difference::count(Turn t) const {
    return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                          [t](const Finding& f) { return f.turn == t; }));
}

int Difference::missing() const {
    return static_cast<int>(cells.before.size() + points.before.size() + modes.before.size());
}

bool Difference::nothing() const {
    for (const auto& [kind, only] : alone())
        if (!only->before.empty() || !only->after.empty()) return false;
    return findings.empty();
}

Difference difference(const Folder& before, const Folder& after) {
    Difference d;
    for (const Folder* f : {&before, &after})
        if (!f->altered.empty())
            d.findings.push_back({Turn::worse, f->name, f->altered, "cells.csv", "errors.csv",
                                  "the two files differ: one was changed"});
    compare_cells(before, after, d);
    compare_dispersion(before.dispersion, after.dispersion, d);
    compare_maps(before, after, d);
    if (d.compared == 0)
        throw store::UsageError(
            fmt::format("{} and {} have no cell, mode or map in common: expected two folders of "
                        "one suite or scene",
                        before.name, after.name));
    return d;
}

}  // namespace jvari::bench::diff

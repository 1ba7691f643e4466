#include "bench/store/cell_rows.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

namespace jvari::bench::store {

std::vector<std::string> naming_columns(const Table& cells) {
    std::vector<std::string> names;
    for (const std::string& name : cells.columns) {
        if (name == "rate") break;
        if (name != "cell") names.push_back(name);
    }
    return names;
}

std::vector<std::string> swept_keys(const Table& cells) {
    const int from = cells.column("scene"), to = cells.column("scheme");
    if (from < 0 || to <= from) return {};
    return {cells.columns.begin() + from + 1, cells.columns.begin() + to};
}

std::vector<Rows> alike(const Table& cells, const Rows& rows,
                        const std::vector<std::string>& columns) {
    std::vector<std::pair<std::vector<std::string>, Rows>> groups;
    for (const std::size_t row : rows) {
        std::vector<std::string> key;
        for (const std::string& name : columns) key.push_back(cells.at(row, name));
        auto it = std::find_if(groups.begin(), groups.end(),
                               [&key](const auto& g) { return g.first == key; });
        if (it == groups.end()) it = groups.insert(groups.end(), {key, {}});
        it->second.push_back(row);
    }
    std::vector<Rows> all;
    for (auto& [key, group] : groups) all.push_back(std::move(group));
    return all;
}

std::vector<Rows> differing_in_rate(const Table& cells, const Rows& rows,
                                    const std::vector<std::string>& naming) {
    std::vector<Rows> all;
    for (const Rows& group : alike(cells, rows, naming)) {
        std::set<std::string> rates;
        for (const std::size_t row : group) rates.insert(cells.at(row, "rate"));
        if (rates.size() == group.size()) all.push_back(group);
        else
            for (Rows& part : alike(cells, group, {"modes"})) all.push_back(std::move(part));
    }
    return all;
}

std::string run_name(const Table& cells, std::size_t row) {
    std::string name = variant_name(cells.at(row, "scheme"), cells.at(row, "options"));
    const bool grid = cells.number(row, "fact_grid_intervals") > 0;
    if (const std::string& modes = cells.at(row, "modes"); !grid && !modes.empty())
        name += ", " + modes + " modes";
    const double rate = cells.number(row, "rate");
    return std::isnan(rate) ? name : name + fmt::format(" at {:.4g} kHz", rate / 1000);
}

Rows all_rows(const Table& t) {
    Rows rows(t.rows.size());
    std::iota(rows.begin(), rows.end(), 0);
    return rows;
}

}  // namespace jvari::bench::store

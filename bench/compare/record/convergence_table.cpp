#include "bench/compare/record/convergence_table.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/convergence.hpp"
#include "bench/compare/bound.hpp"
#include "bench/store/cell_rows.hpp"

namespace jvari::bench::compare {

namespace {
struct Window {
    const char *column, *name;
};
constexpr Window windows[] = {{"error_l2_10ms", "10ms"}, {"error_l2_50ms", "50ms"}, {"error_l2_whole", "whole"}};

std::vector<std::string> taps_of(const store::Table& cells) {
    std::vector<std::string> taps;
    const std::string prefix = std::string(windows[0].column) + "_";
    for (const std::string& name : cells.columns)
        if (name.starts_with(prefix)) taps.push_back(name.substr(prefix.size()));
    return taps;
}
}  // namespace

store::Table convergence_of(const store::Table& cells, const std::string& scene) {
    store::Table t;
    std::vector<std::string> naming = store::naming_columns(cells);
    std::erase(naming, "scene");
    t.columns = {"scene"};
    t.columns.insert(t.columns.end(), naming.begin(), naming.end());
    if (cells.column("options") < 0) t.columns.push_back("options");
    for (const char* name : {"modes", "tap", "window", "order", "half_width", "points", "from_hz", "to_hz"}) t.columns.push_back(name);
    for (const store::Rows& rows : store::differing_in_rate(cells, store::all_rows(cells), store::naming_columns(cells)))
        for (const std::string& tap : taps_of(cells))
            for (const Window& w : windows) {
                const std::string column = std::string(w.column) + "_" + tap;
                std::vector<double> rate, error;
                std::set<std::string> modes;
                for (const std::size_t i : rows) {
                    const double r = cells.number(i, "rate"), e = cells.number(i, column);
                    if (!reached(cells, i) || !(r > 0) || !(e < 1) || !bound_of(cells, i, column).decides()) continue;
                    rate.push_back(r);
                    error.push_back(e);
                    modes.insert(cells.at(i, "modes"));
                }
                if (rate.size() < 2) continue;
                const Order o = observed_order(rate, error);
                if (std::isnan(o.order)) continue;
                const auto [low, high] = std::minmax_element(rate.begin(), rate.end());
                auto& row = t.rows.emplace_back();
                row.push_back(cells.column("scene") < 0 ? scene : cells.at(rows.front(), "scene"));
                for (const std::string& name : naming) row.push_back(cells.at(rows.front(), name));
                if (cells.column("options") < 0) row.emplace_back();
                row.push_back(modes.size() == 1 ? *modes.begin() : "");
                for (const std::string& field : {tap, std::string(w.name), store::text_of(o.order),
                                                 std::isfinite(o.half_width) ? store::text_of(o.half_width) : std::string(),
                                                 std::to_string(o.points), store::text_of(*low), store::text_of(*high)})
                    row.push_back(field);
            }
    return t;
}

}  // namespace jvari::bench::compare

#include "bench/compare/record/fits.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "bench/compare/bound.hpp"
#include "bench/store/cell_rows.hpp"

namespace jvari::bench::compare {

namespace {
struct Window {
    const char *column, *name;
};
constexpr Window windows[] = {
    {"error_l2_10ms", "10ms"}, {"error_l2_50ms", "50ms"}, {"error_l2_whole", "whole"}};

std::vector<std::string> taps_of(const store::Table& cells) {
    std::vector<std::string> taps;
    const std::string prefix = std::string(windows[0].column) + "_";
    for (const std::string& name : cells.columns)
        if (name.starts_with(prefix)) taps.push_back(name.substr(prefix.size()));
    return taps;
}
}  // namespace

store::Table convergence_of(const store::Table& cells) {
    store::Table t;
    t.columns = store::naming_columns(cells);
    const std::vector<std::string> naming = t.columns;
    for (const char* name :
         {"modes", "tap", "window", "order", "half_width", "points", "from_hz", "to_hz"})
        t.columns.push_back(name);
    for (const store::Rows& rows : store::differing_in_rate(cells, store::all_rows(cells), naming))
        for (const std::string& tap : taps_of(cells))
            for (const Window& w : windows) {
                const Fall fall = fall_over_rates(cells, rows, std::string(w.column) + "_" + tap);
                const Order& o = fall.order;
                if (std::isnan(o.order)) continue;
                std::set<std::string> modes;
                double from = HUGE_VAL, to = 0;
                for (const std::size_t i : fall.rows) {
                    modes.insert(cells.at(i, "modes"));
                    from = std::min(from, cells.number(i, "rate"));
                    to = std::max(to, cells.number(i, "rate"));
                }
                auto& row = t.rows.emplace_back();
                for (const std::string& name : naming) row.push_back(cells.at(rows.front(), name));
                for (const std::string& field :
                     {modes.size() == 1 ? *modes.begin() : "", tap, std::string(w.name),
                      store::text_of(o.order),
                      std::isfinite(o.half_width) ? store::text_of(o.half_width) : "",
                      std::to_string(o.points), store::text_of(from), store::text_of(to)})
                    row.push_back(field);
            }
    return t;
}

}  // namespace jvari::bench::compare

#include "bench/compare/record/pareto.hpp"

#include <algorithm>
#include <cmath>

#include "bench/compare/bound.hpp"
#include "bench/store/records.hpp"

namespace jvari::bench::compare {

namespace {
bool sound(const Point& p) { return std::isfinite(p.cost) && std::isfinite(p.error); }
bool tie(const Point& a, const Point& b) {
    return a.cost_lower <= b.cost_upper && b.cost_lower <= a.cost_upper;
}
bool beats(const Point& a, const Point& b) {
    if (!sound(a)) return false;
    if (a.error + a.certificate < b.error - b.certificate) return a.cost <= b.cost || tie(a, b);
    return a.error <= b.error && a.cost < b.cost && !tie(a, b);
}

bool is_clock(const std::string& cost) {  // its quartiles are those of the cost per second of sound
    return cost == "cost_s_per_s" || cost == "ns_per_step";
}

Point point_of(const store::Table& cells, std::size_t row, const std::string& error,
               const std::string& cost) {
    const Bound b = bound_of(cells, row, error);
    const bool known = trusted(cells, row) && b.says() != Bound::Says::unknown;
    const bool clock = is_clock(cost);
    const double median = cells.number(row, "cost_s_per_s"),
                 c = known ? cells.number(row, cost) : store::nan;
    return {
        c, clock ? c * cells.number(row, "cost_lower") / median : c,
        clock ? c * cells.number(row, "cost_upper") / median : c,
        std::isnan(b.error) ? store::nan : std::fmax(b.error, std::fmax(b.floor, b.certificate)),
        std::isnan(b.certificate) ? 0 : b.certificate};
}
}  // namespace

std::vector<bool> pareto_front(std::span<const Point> points) {
    std::vector<bool> front;
    for (const Point& p : points)
        front.push_back(sound(p) &&
                        std::none_of(points.begin(), points.end(),
                                     [&p](const Point& other) { return beats(other, p); }));
    return front;
}

std::vector<bool> pareto_front(const store::Table& cells, const store::Rows& rows,
                               const std::string& error, const std::string& cost) {
    std::vector<Point> points;
    for (const std::size_t row : rows) points.push_back(point_of(cells, row, error, cost));
    return pareto_front(points);
}

store::Table with_front(store::Table cells) {
    std::vector<std::string> problem = store::swept_keys(cells);
    problem.emplace_back("scene");
    std::vector<bool> front(cells.rows.size(), false);
    for (const store::Rows& rows : store::alike(cells, store::all_rows(cells), problem)) {
        const std::vector<bool> own =
            pareto_front(cells, rows, headline_error(cells, rows), "cost_s_per_s");
        for (std::size_t k = 0; k < rows.size(); ++k) front[rows[k]] = own[k];
    }
    const auto at = cells.column("governor") + 1;
    cells.columns.insert(cells.columns.begin() + at, "pareto");
    for (std::size_t i = 0; i < cells.rows.size(); ++i)
        cells.rows[i].insert(cells.rows[i].begin() + at, front[i] ? "1" : "0");
    return cells;
}

}  // namespace jvari::bench::compare

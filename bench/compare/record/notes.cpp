#include "bench/compare/record/notes.hpp"

#include <fmt/core.h>
#include <cmath>
#include <vector>

#include "analysis/statistics.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double calm = 0.2;
}

double median_spread(const store::Table& cells) {
    std::vector<double> spreads;
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {
        const double spread = 0.5 * (cells.number(i, "cost_upper") - cells.number(i, "cost_lower")) / cells.number(i, "cost_s_per_s");
        if (std::isfinite(spread)) spreads.push_back(spread);
    }
    return spreads.empty() ? store::nan : spread_of(spreads).median;
}

std::string busy_text(const store::Table& cells) {
    const double spread = median_spread(cells);
    if (!(spread > calm)) return "";
    return fmt::format(
        "the machine was busy: half of the costs scatter by {:.0f} % and more between their quartiles; read them as orders of magnitude",
        100 * spread);
}

}  // namespace jvari::bench::compare

#include "analysis/statistics.hpp"

#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "schemes/trace.hpp"

namespace jvari {

Spread spread_of(std::span<const double> values) {
    std::vector<double> sorted;
    std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
                 [](double v) { return std::isfinite(v); });
    if (sorted.empty()) return {0, nan, nan, nan};
    std::sort(sorted.begin(), sorted.end());
    const auto quantile = [&](double f) {
        return gsl_stats_quantile_from_sorted_data(sorted.data(), 1, sorted.size(), f);
    };
    return {static_cast<int>(sorted.size()), quantile(0.5), quantile(0.25), quantile(0.75)};
}

}  // namespace jvari

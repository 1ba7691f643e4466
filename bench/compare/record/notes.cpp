#include "bench/compare/record/notes.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include "analysis/statistics.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/diagnosis.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double calm = 0.2;
constexpr double harmed = 1.2;  // times the error of own compliance
constexpr const char *own = "compliance=own", *matched = "compliance=matched";
}  // namespace

double median_spread(const store::Table& cells) {
    std::vector<double> spreads;
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {
        const double spread = 0.5 *
                              (cells.number(i, "cost_upper") - cells.number(i, "cost_lower")) /
                              cells.number(i, "cost_s_per_s");
        if (std::isfinite(spread)) spreads.push_back(spread);
    }
    return spreads.empty() ? store::nan : spread_of(spreads).median;
}

std::string busy_text(const store::Table& cells) {
    const double spread = median_spread(cells);
    if (!(spread > calm)) return "";
    return fmt::format(
        "the machine was busy: half of the costs scatter by {:.0f} % and more between their "
        "quartiles; read them as orders of magnitude",
        100 * spread);
}

std::string harm_text(const store::Table& cells) {
    std::vector<std::string> same = store::naming_columns(cells), taps;
    std::erase(same, "options");
    same.insert(same.end(), {"rate", "modes"});
    const std::string window = headline_error(cells, store::all_rows(cells)) + "_";
    for (const std::string& name : cells.columns)
        if (name.starts_with(window)) taps.push_back(name.substr(window.size()));
    int pairs = 0, worse = 0;
    double most = 0;
    std::string worst;
    for (const store::Rows& alike : store::alike(cells, store::all_rows(cells), same))
        for (const std::size_t i : alike)
            for (const std::size_t j : alike) {
                std::string options = cells.at(i, "options");
                const auto at = options.find(matched);
                if (at == std::string::npos || !trusted(cells, i) || !trusted(cells, j)) continue;
                if (options.replace(at, std::string(matched).size(), own) != cells.at(j, "options"))
                    continue;
                ++pairs;
                bool any = false;
                for (const std::string& tap : taps) {
                    const Bound is = bound_of(cells, i, window + tap),
                                was = bound_of(cells, j, window + tap);
                    if (!(is.least() > harmed * was.most())) continue;
                    any = true;
                    if (is.error / was.error <= most) continue;
                    most = is.error / was.error;
                    worst = fmt::format("{} of {} by {}", tap, percent(is.error),
                                        store::run_name(cells, i));
                    worst += fmt::format(", where own compliance has {}", percent(was.error));
                }
                worse += any;
            }
    if (worse == 0) return "";
    return fmt::format(
        "in {} of {} runs matched compliance errs more than 1.2 times as much as own at a tap, "
        "most at {}. Own errors of modes "
        "and step may cancel: twice the rate, or the modes, tells (docs/compliance-matching.md)",
        worse, pairs, worst);
}

std::vector<std::string> warnings_of(const store::Table& cells) {
    std::vector<std::string> all{busy_text(cells), harm_text(cells)};
    std::erase(all, "");
    return all;
}

}  // namespace jvari::bench::compare

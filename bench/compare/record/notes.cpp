#include "bench/compare/record/notes.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <vector>

#include "schemes/contact/matching_facts.hpp"

namespace jvari::bench::compare {

std::string matching_note(const store::Table& t) {
    std::string text;
    for (const MatchingLimit& limit : matching_limits) {
        const std::string name = limit.fact.name;
        double most = limit.most;
        std::string loudest;
        for (const std::string& column : t.columns) {
            if (!column.starts_with("fact_") || !column.ends_with(name)) continue;  // with several strings string.<k>. stands between
            for (std::size_t i = 0; i < t.rows.size(); ++i) {
                if (!(t.number(i, column) > most)) continue;
                most = t.number(i, column);
                loudest = store::variant_name(t.at(i, "scheme"), t.at(i, "options")) + " at " + t.at(i, "rate") + " Hz";
            }
        }
        if (loudest.empty()) continue;
        text += fmt::format(
            "{}compliance=matched may be less accurate here than own: {}\n    ({} {:.2g} with {}; above {:.2g} it counts). "
            "Compare with compliance=own.",
            text.empty() ? "" : "\n", limit.cause, name, most, loudest, limit.most);
    }
    return text;
}

namespace {
constexpr double calm = 0.2;
}

double median_spread(const store::Table& cells) {
    std::vector<double> spreads;
    for (std::size_t i = 0; i < cells.rows.size(); ++i) {
        const double spread = 0.5 * (cells.number(i, "cost_upper") - cells.number(i, "cost_lower")) / cells.number(i, "cost_s_per_s");
        if (std::isfinite(spread)) spreads.push_back(spread);
    }
    if (spreads.empty()) return std::nan("");
    const auto middle = spreads.begin() + static_cast<std::ptrdiff_t>(spreads.size() / 2);
    std::nth_element(spreads.begin(), middle, spreads.end());
    return *middle;
}

std::string busy_text(const store::Table& cells) {
    const double spread = median_spread(cells);
    if (!(spread > calm)) return "";
    return fmt::format(
        "the machine was busy: half of the costs scatter by {:.0f} % and more between their quartiles; read them as orders of magnitude",
        100 * spread);
}

}  // namespace jvari::bench::compare

#include "bench/compare/target.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/errors.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double most_without_unit = 0.5;  // a larger tolerance more likely means per cent

std::string name_of(const std::string& column) {
    for (const auto& [of, name] : {std::pair{"stft_db", "stft"},
                                   {"error_l2_heard", "heard"},
                                   {"centroid_relative", "centroid"},
                                   {"decay_db", "decay"}})
        if (column == of) return name;
    return column.starts_with("error_") ? column.substr(6) : column;
}
}  // namespace

std::vector<Target> targets() {
    std::vector<Target> all;
    for (std::size_t k = 0; k < study::measures().size(); ++k)
        if (const study::Measure& m = study::measures()[k]; m.less_is_better)
            all.push_back({k, 0, name_of(m.column), m.title, m.unit == "1" ? "%" : m.unit});
    return all;
}

Target target_of(const std::string& name, const std::string& within) {
    const std::vector<Target> all = targets();
    const auto found = std::ranges::find(all, name, &Target::name);
    if (found == all.end()) {
        std::vector<std::string> names;
        for (const Target& t : all) names.push_back(t.name);
        throw store::UsageError("--of " + store::unknown("measure", name, names));
    }
    Target target = *found;
    // end of the number; 0: there is none
    const auto end = within.find_last_of("0123456789.") + 1;
    const double x = store::number_of(within.substr(0, end));
    std::string unit = within.substr(end);
    unit.erase(0, std::min(unit.find_first_not_of(' '), unit.size()));
    const bool relative = target.unit == "%";
    if (const auto other = std::ranges::find(all, unit, &Target::unit);
        unit != target.unit && other != all.end())
        throw store::UsageError(fmt::format("--within {}: that is a tolerance of {}: add --of {}",
                                            within, other->name, other->name));
    if (!std::isfinite(x) || !(x > 0) || (!unit.empty() && unit != target.unit))
        throw store::UsageError(fmt::format("--within {}: expected a tolerance of {}, as 1{}",
                                            within, name, target.unit));
    if (relative && unit.empty() && x > most_without_unit)
        throw store::UsageError(fmt::format(
            "--within {}: without a unit this is {:.4g} %; say {}%, or {:.4g}% where that is meant",
            within, 100 * x, within, 100 * x));
    target.most = unit == "%" ? x / 100 : x;
    return target;
}

std::string Target::text(double error, const char* unknown) const {
    if (std::isnan(error)) return unknown;
    return fmt::format("{:.2g} {}", unit == "%" ? 100 * error : error, unit);
}

}  // namespace jvari::bench::compare

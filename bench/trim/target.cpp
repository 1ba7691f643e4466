#include "bench/trim/target.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "bench/store/usage.hpp"
#include "bench/study/errors.hpp"

namespace jvari::bench::trim {

namespace {
constexpr double most_without_unit = 0.5;  // a larger tolerance is more likely meant in per cent

std::string name_of(const std::string& column) {
    for (const auto& [of, name] : {std::pair{"stft_db", "stft"}, {"centroid_relative", "centroid"}, {"decay_db", "decay"}})
        if (column == of) return name;
    return column.starts_with("error_") ? column.substr(6) : column;
}
}  // namespace

const std::vector<Measure>& measures() {
    static const std::vector<Measure> all = [] {
        std::vector<Measure> named;
        for (std::size_t k = 0; k < study::measures().size(); ++k) {
            const study::Measure& m = study::measures()[k];
            const std::string title = m.title.substr(0, m.title.find(" ["));  // without its unit
            if (m.less_is_better) named.push_back({name_of(m.column), title, m.unit == "1" ? "%" : m.unit, k, m.window});
        }
        return named;
    }();
    return all;
}

Target target_of(const std::string& name, const std::string& within) {
    const auto found = std::ranges::find(measures(), name, &Measure::name);
    if (found == measures().end()) {
        std::vector<std::string> names;
        for (const Measure& m : measures()) names.push_back(m.name);
        throw store::UsageError("--of " + store::unknown("measure", name, names));
    }
    double x = 0;
    const char* end = within.data() + within.size();
    const auto [stop, error] = std::from_chars(within.data(), end, x);
    std::string unit(stop, end);
    unit.erase(0, unit.find_first_not_of(' ') == std::string::npos ? unit.size() : unit.find_first_not_of(' '));
    const bool relative = found->unit == "%";
    if (error != std::errc() || !std::isfinite(x) || !(x > 0) || (!unit.empty() && unit != found->unit))
        throw store::UsageError(
            fmt::format("--within {}: expected a tolerance of {}, as {}", within, found->name, relative ? "1%" : "1" + found->unit));
    if (relative && unit.empty() && x > most_without_unit)
        throw store::UsageError(fmt::format("--within {}: without a unit this is {:.4g} %; say {}%, or {:.4g}% where that is meant", within,
                                            100 * x, within, 100 * x));
    return {&*found, unit == "%" ? x / 100 : x};
}

std::string text_of(const Measure& m, double error) {
    if (std::isnan(error)) return "-";
    return fmt::format("{:.2g} {}", m.unit == "%" ? 100 * error : error, m.unit);
}

std::string certainty_text(const Measure& m, double certificate) {
    return std::isnan(certificate) ? "unknown" : text_of(m, certificate);
}

}  // namespace jvari::bench::trim

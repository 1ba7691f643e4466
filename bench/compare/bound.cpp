#include "bench/compare/bound.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "analysis/cheapest.hpp"

namespace jvari::bench::compare {

namespace {
// a certificate of a tenth of the error leaves its first digit
constexpr double small_share = 0.1;
constexpr double nothing_is_right = 1;  // relative L2 of silence
// the headline first
constexpr const char* l2_columns[] = {"error_l2_50ms", "error_l2_10ms", "error_l2_whole"};

// error_l2_50ms_nut: certificate_l2_50ms_nut
std::string column_of(const char* what, const std::string& error_column) {
    return what + error_column.substr(std::min(error_column.size(), std::string("error").size()));
}
}  // namespace

double Bound::most() const { return at_most(error, certificate); }

double Bound::least() const { return at_least(error, certificate); }

Bound::Says Bound::says() const {
    if (std::isnan(error)) return Says::nothing;
    if (std::isinf(error) || certificate <= small_share * error) return Says::measured;
    if (std::isnan(certificate)) return Says::unsure;
    return most() < nothing_is_right ? Says::at_most : Says::unknown;
}

double Bound::shown() const {
    return says() == Says::measured || says() == Says::unsure ? error : most();
}

bool Bound::decides() const { return error > 0 && !(error <= floor) && !(error <= certificate); }

std::string after_pluck(const store::Table& cells, std::size_t row) {
    return cells.number(row, "free_from_s") > 0 ? " after the last pluck" : "";
}

Bound bound_of(const store::Table& cells, std::size_t row, const std::string& error_column) {
    Bound b;
    b.error = cells.number(row, error_column);
    b.floor = cells.number(row, "floor_" + error_column);
    const bool waveform =
        error_column.starts_with("error_l2_") || error_column.starts_with("error_in_model_l2_");
    b.certificate = waveform ? cells.number(row, column_of("certificate", error_column)) : 0;
    return b;
}

std::string error_text(const Bound& b, const char* format) {
    switch (b.says()) {
        case Bound::Says::nothing: return "-";
        case Bound::Says::measured: return fmt::format(fmt::runtime(format), b.error);
        case Bound::Says::unsure: return fmt::format(fmt::runtime(format), b.error) + "?";
        case Bound::Says::at_most: return "\u2264" + fmt::format(fmt::runtime(format), b.most());
        case Bound::Says::unknown: break;
    }
    return "not known";
}

bool reached(const store::Table& cells, std::size_t row) {
    return cells.at(row, "status") == "ok" || cells.at(row, "status") == "not_needed";
}

bool trusted(const store::Table& cells, std::size_t row) {
    return cells.at(row, "status") == "ok" && cells.at(row, "flags").empty();
}

std::string headline_error(const store::Table& cells, const store::Rows& rows) {
    for (const char* column : l2_columns)
        if (std::any_of(rows.begin(), rows.end(),
                        [&](std::size_t i) { return std::isfinite(cells.number(i, column)); }))
            return column;
    return "error_l2_whole";
}

Fall fall_over_rates(const store::Table& cells, const store::Rows& rows,
                     const std::string& error_column) {
    Fall fall;
    std::vector<double> rates, errors;
    for (const std::size_t i : rows) {
        const Bound b = bound_of(cells, i, error_column);
        const bool all_wrong = error_column.starts_with("error_") && !(b.error < nothing_is_right);
        if (!reached(cells, i) || !(cells.number(i, "rate") > 0) || all_wrong || !b.decides())
            continue;
        rates.push_back(cells.number(i, "rate"));
        errors.push_back(b.error);
        fall.rows.push_back(i);
    }
    fall.order = observed_order(rates, errors);
    return fall;
}

store::Table with_bounds(store::Table cells) {
    for (const char* column : {"error_l2_10ms", "error_l2_50ms", "error_l2_whole"}) {
        std::vector<std::string> texts;
        for (std::size_t i = 0; i < cells.rows.size(); ++i) {
            const Bound b = bound_of(cells, i, column);
            const bool known =
                b.says() == Bound::Says::measured || b.says() == Bound::Says::at_most;
            texts.push_back(known ? store::text_of(b.most()) : "");
        }
        cells.columns.push_back(column_of("bound", column));
        for (std::size_t i = 0; i < cells.rows.size(); ++i) cells.rows[i].push_back(texts[i]);
    }
    return cells;
}

}  // namespace jvari::bench::compare

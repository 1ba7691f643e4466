#include "bench/compare/bound.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/cheapest.hpp"

namespace jvari::bench::compare {

namespace {
// A tenth leaves the first digit of an error certain.
constexpr double small_share = 0.1;
constexpr double nothing_is_right = 1;  // relative L2 error for silence
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

Bound bound_of(const study::TabledCell& c, std::size_t measure, const std::string& tap) {
    const study::Figure& f = c.figure(measure, tap);
    return {f.value, study::is_waveform(measure) ? f.certificate : 0, f.floor};
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

std::string after_pluck(const study::TabledCell& c) {
    return c.free_from_s > 0 ? " after the last pluck" : "";
}

bool reached(const study::TabledCell& c) { return c.status == "ok" || c.status == "not_needed"; }

bool trusted(const study::TabledCell& c) { return c.status == "ok" && c.flags.empty(); }

std::size_t headline_error(const study::Cells& cells, const study::Rows& rows) {
    for (const char* column : {"error_l2_50ms", "error_l2_10ms"}) {
        const std::size_t m = study::measure(column);
        if (std::ranges::any_of(
                rows, [&](std::size_t i) { return std::isfinite(cells[i].figure(m).value); }))
            return m;
    }
    return study::measure("error_l2_whole");
}

Fall fall_over_rates(const study::Cells& cells, const study::Rows& rows, std::size_t measure,
                     const std::string& tap) {
    Fall fall;
    std::vector<double> rates, errors;
    for (const std::size_t i : rows) {
        const Bound b = bound_of(cells[i], measure, tap);
        const bool all_wrong = study::is_waveform(measure) && !(b.error < nothing_is_right);
        if (!reached(cells[i]) || !(cells[i].rate > 0) || all_wrong || !b.decides()) continue;
        rates.push_back(cells[i].rate);
        errors.push_back(b.error);
        fall.rows.push_back(i);
    }
    fall.order = observed_order(rates, errors);
    return fall;
}

nlohmann::ordered_json json_of(const study::Cells& cells) {
    using Json = nlohmann::ordered_json;
    Json rows = store::rows_json(study::table_of(cells, study::Contents::everything));
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const study::TabledCell& c = cells[i];
        for (std::size_t m = 0; m < study::measures().size(); ++m) {
            if (!study::is_waveform(m)) continue;
            const Bound b = bound_of(c, m);
            const bool known =
                b.says() == Bound::Says::measured || b.says() == Bound::Says::at_most;
            rows[i]["bound" + study::measures()[m].column.substr(5)] = known ? b.most() : nan;
        }
        Json& errors = rows[i]["errors"] = Json::object();
        for (const std::string& tap : c.taps)
            for (std::size_t m = 0; m < study::measures().size(); ++m) {
                Json& of = errors[tap][study::measures()[m].column];
                for (const auto& [name, part] : study::figure_parts)
                    of[name] = c.figure(m, tap).*part;
            }
    }
    return rows;
}

}  // namespace jvari::bench::compare

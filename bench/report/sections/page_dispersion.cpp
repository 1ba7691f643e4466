// Pitch and decay of each mode against the true ones (dispersion.csv): lines by the scheme's own relation, points by the estimate from its
// trace. One rate at a time.
#include <algorithm>

#include "bench/report/sections/page_sections.hpp"

namespace jvari::bench::report {

namespace {
constexpr std::size_t most_rows = 12000;

std::string relative(double x, double truth) {
    return store::text_of(x / truth - 1);
}

store::Table drawn_rows(const store::Table& t) {
    store::Table rows{{"problem", "rate", "series", "mode", "frequency_hz", "own_cents", "trace_cents", "own_decay", "trace_decay"}, {}};
    for (std::size_t i = 0; i < t.rows.size() && rows.rows.size() < most_rows; ++i) {
        const double decay = t.number(i, "decay_per_s");
        rows.rows.push_back({t.at(i, "problem"), t.at(i, "rate"), t.at(i, "series"), t.at(i, "mode"), t.at(i, "frequency_hz"),
                             t.at(i, "own_cents"), t.at(i, "trace_cents"), relative(t.number(i, "own_decay_per_s"), decay),
                             relative(t.number(i, "trace_decay_per_s"), decay)});
    }
    return rows;
}

Filling filling_of(const store::Table& rows, const std::string& problem, const std::string& rate) {
    return {problem + ": dispersion",
            "at " + rate + " Hz; lines: the scheme's own relation, points: estimated from its trace",
            distinct(rows, "series"),
            {},
            {{"rows", rows_of(rows, {"problem", "rate", "series"},
                              {"mode", "frequency_hz", "own_cents", "trace_cents", "own_decay", "trace_decay"})}},
            {{"problem_field", json_text(problem)}, {"rate_field", json_text(rate)}}};
}
}  // namespace

Section dispersion_section(const Results& r) {
    Section s{"dispersion", "Dispersion"};
    if (r.dispersion.rows.empty()) return s;
    const store::Table rows = drawn_rows(r.dispersion);
    const auto problems = distinct(rows, "problem"), rates = distinct(rows, "rate");
    Chart c{"distance of each mode's pitch and decay from the true ones", "", false, problem_menu(problems), {}};
    Menu by_rate{"rate", "rate_field", {}};
    for (const std::string& rate : rates) by_rate.choices.emplace_back(json_text(rate), rate + " Hz");
    if (rates.size() > 1) c.menus.push_back(by_rate);
    c.menus.push_back({"of", "quantity_field", {{"\"cents\"", "pitch"}, {"\"decay\"", "decay rate"}}});
    c.spec = chart_of("dispersion.json", filling_of(rows, problems.front(), rates.front()), Medium::page);
    for (std::size_t k = 0; k < std::min(problems.size(), most_twins); ++k) {
        const store::Table own = rows_where(rows, "problem", problems[k]);
        c.twins.push_back({twin_file("dispersion", problems[k], problems),
                           chart_of("dispersion.json", filling_of(own, problems[k], own.at(0, "rate")), Medium::print)});
    }
    s.charts.push_back(std::move(c));
    s.notes = {
        "Lines: by the scheme's own relation. Points: estimated from its trace. Distances without their sign; hover for it. What is nearer "
        "than "
        "1e-5 cents or 1e-8 of the decay rate lies on the lower edge."};
    if (rows.rows.size() < r.dispersion.rows.size())
        s.left_out.push_back("The chart holds the first " + std::to_string(rows.rows.size()) + " of " +
                             std::to_string(r.dispersion.rows.size()) + " rows of dispersion.csv.");
    return s;
}

}  // namespace jvari::bench::report

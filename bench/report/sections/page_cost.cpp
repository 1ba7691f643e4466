// Time per step against modes, contacts and rate, and what each element of a scene adds (scaling.csv).
#include <algorithm>
#include <cmath>

#include "bench/report/sections/page_sections.hpp"
#include "bench/store/cell_rows.hpp"

namespace jvari::bench::report {

namespace {
store::Table elements_of(const store::Table& t) {
    store::Table elements = t;
    std::erase_if(elements.rows, [&t](const auto& row) { return std::isnan(store::number_of(row[t.column("extra_ns")])); });
    for (auto& row : elements.rows) row[t.column("series")] = row[t.column("what")];  // coloured by the element
    return elements;
}

// A scheme that was held at several rates or numbers of modes has a line for each.
store::Table told_apart(store::Table t) {
    for (const store::Rows& rows : store::alike(t, store::all_rows(t), {"problem", "series", "what"}))
        if (store::alike(t, rows, {"at"}).size() > 1)
            for (const std::size_t row : rows) t.rows[row][t.column("series")] += ", " + t.at(row, "at");
    return t;
}

// What is scaled: those with two values of x in one series.
std::vector<std::string> scaled_in(const store::Table& t) {
    std::vector<std::string> whats;
    for (const std::string& what : distinct(t, "what")) {
        const store::Table own = rows_where(t, "what", what);
        bool several = false;
        for (const std::string& series : distinct(own, "series"))
            several = several || distinct(rows_where(own, "series", series), "x").size() > 1;
        if (several) whats.push_back(what);
    }
    return whats;
}

Chart scaling_chart(const store::Table& t, const std::vector<std::string>& whats) {
    const auto problems = distinct(t, "problem");
    const auto filling = [&](const store::Table& rows, const std::string& problem, const std::string& what) {
        return Filling{problem + ": cost against " + what,
                       "median and quartiles of the time per step",
                       distinct(rows, "series"),
                       {},
                       {{"rows", rows_of(rows, {"problem", "series", "what"},
                                         {"x", "ns_per_step", "ns_lower", "ns_upper", "exponent", "exponent_half_width"})}},
                       {{"problem_field", json_text(problem)}, {"what_field", json_text(what)}}};
    };
    Chart c{"time per step against modes, contacts or rate", "", false, problem_menu(problems), {}};
    Menu menu{"against", "what_field", {}};
    for (const std::string& what : whats) menu.choices.emplace_back(json_text(what), what);
    c.menus.push_back(std::move(menu));
    c.spec = chart_of("scaling.json", filling(t, problems.front(), whats.front()), Medium::page);
    for (const std::string& problem : problems)
        for (const std::string& what : whats) {
            const store::Table own = rows_where(rows_where(t, "problem", problem), "what", what);
            if (own.rows.empty() || c.twins.size() >= most_twins) continue;
            c.twins.push_back(
                {twin_file("scaling-" + what, problem, problems), chart_of("scaling.json", filling(own, problem, what), Medium::print)});
        }
    return c;
}

Chart element_chart(const store::Table& t) {
    const auto problems = distinct(t, "problem");
    const auto filling = [](const store::Table& rows, const std::string& problem) {
        return Filling{
            problem + ": what each element adds",
            "median and quartiles; linear within the grey band of \u00b110 ns, logarithmic beyond",
            distinct(rows, "series"),
            {},
            {{"rows", rows_of(rows, {"problem", "series", "scheme"}, {"extra_ns", "extra_lower", "extra_upper", "ns_per_step"})}},
            {{"problem_field", json_text(problem)}}};
    };
    Chart c{"extra time per step of each element of the scene",
            chart_of("elements.json", filling(t, problems.front()), Medium::page),
            false,
            problem_menu(problems),
            {}};
    for (std::size_t k = 0; k < std::min(problems.size(), most_twins); ++k)
        c.twins.push_back({twin_file("elements", problems[k], problems),
                           chart_of("elements.json", filling(rows_where(t, "problem", problems[k]), problems[k]), Medium::print)});
    return c;
}
}  // namespace

Section cost_section(const Results& r) {
    Section s{"cost", "Cost"};
    if (r.scaling.rows.empty()) return s;
    const store::Table scaling = told_apart(r.scaling), elements = elements_of(r.scaling);
    if (const auto whats = scaled_in(scaling); !whats.empty()) s.charts.push_back(scaling_chart(scaling, whats));
    if (!elements.rows.empty()) s.charts.push_back(element_chart(elements));
    s.notes = {
        "Measured times on the machine named below. Bars are quartiles: where two bars touch, neither is faster. No bar means that the "
        "times "
        "did not vary visibly."};
    if (!elements.rows.empty())
        s.notes.emplace_back(
            "The axis of extra time is linear within the grey band of \u00b110 ns, and logarithmic beyond it, each way. So what saves "
            "time, "
            "what adds nothing and what adds much stand on one axis.");
    s.table = without_names(r.scaling);
    return s;
}

}  // namespace jvari::bench::report

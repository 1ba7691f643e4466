#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>

#include "bench/store/fresh_file.hpp"
#include "bench/study/judgement.hpp"
#include "bench/suite/maps.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::suite {

namespace {
constexpr double most_points = 1e6;  // for a map: each point is a run

bool is_option(const std::string& key) { return key.rfind("option:", 0) == 0; }

// Keys for all points, or for an axis.
const std::map<std::string, store::Kind<double>>& plain_numbers() {
    static const std::map<std::string, store::Kind<double>> all = {
        {"rate", store::positive("Hz")},
        {"duration", store::positive("s")},
        {"amplitude", store::positive()}};
    return all;
}

std::string value_text(const store::Entry& e, const std::string& axis) {
    if (is_option(axis)) return e.option_text();
    if (axis == "modes") return std::to_string(store::count().read(e));
    if (const auto plain = plain_numbers().find(axis); plain != plain_numbers().end())
        return number_text(plain->second.read(e));
    return e.toml();
}

// ---- An axis

std::vector<store::Key<MapAxis>> axis_keys() {
    return {store::needed(
                "key", &MapAxis::key, store::text(),
                "rate, modes, duration, amplitude, option:[SCHEME:]NAME, or a key of the scene"),
            {{"values", "values that ascend", "from ... to", "along the axis"},
             [](MapAxis& a, const store::Entry& e) {
                 for (const store::Entry& one : e.items())
                     a.values.push_back(value_text(one, a.key));
             }},
            store::key("from", &MapAxis::from, store::positive(), "the first value", ""),
            store::key("to", &MapAxis::to, store::positive(), "the last", ""),
            store::key("points", &MapAxis::points, store::count(),
                       "how many, spaced by equal ratios", "")};
}

// Computes the values between `from` and `to`.
void spread(MapAxis& a, const store::Entry& e) {
    for (const char* name : {"from", "to", "points"}) e.need(name);
    if (a.points < 2) e.need("points").refuse("2 or more");
    if (a.points > most_points) e.need("points").refuse(fmt::format("at most {}", most_points));
    if (!(a.to > a.from)) e.need("to").refuse("more than from");
    for (int i = 0; i < a.points; ++i) {
        const double x =
            i + 1 == a.points
                ? a.to
                : a.from * std::pow(a.to / a.from, static_cast<double>(i) / (a.points - 1));
        // 1e6 instead of 999999.9999999998
        const double tidy = std::strtod(fmt::format("{:.12g}", x).c_str(), nullptr);
        a.values.push_back(a.key == "modes" ? std::to_string(std::lround(tidy))
                                            : number_text(tidy));
    }
}

void finish(MapAxis& a, const store::Entry& e) {
    const bool listed = e.at("values").has_value();
    if (listed)
        for (const char* other : {"from", "to", "points"})
            if (const auto x = e.at(other)) x->refuse("either values or from, to and points");
    if (!listed) spread(a, e);
    for (const std::string& text : a.values)
        if (const auto x = number_of(text); x && std::isfinite(*x)) a.at.push_back(*x);
    if (a.at.size() < a.values.size()) a.at.clear();
    if (std::adjacent_find(a.at.begin(), a.at.end(), std::greater_equal<>()) != a.at.end())
        e.need(listed ? "values" : "points").refuse("numbers that ascend");
    const auto digits = [](const std::string& t) {
        return t.find_first_not_of("0123456789") == std::string::npos;
    };
    a.whole = a.key == "modes" ||
              (is_option(a.key) && std::all_of(a.values.begin(), a.values.end(), digits));
}

store::Kind<MapAxis> axis() { return store::table(axis_keys(), finish); }

// ---- A map

store::Key<Map> plain(const char* name, const std::string& says, const char* absent,
                      const char* meaning) {
    return {{name, says, absent, meaning},
            [name = std::string(name)](Map& m, const store::Entry& e) {
                m.fixed.emplace_back(name, value_text(e, name));
            }};
}
store::Key<Map> plain(const char* name, const char* absent, const char* meaning) {
    return plain(name, plain_numbers().at(name).says, absent, meaning);
}

std::vector<store::Key<Map>> map_keys() {
    return {
        store::needed("name", &Map::name, store::name_of_file(), "what it is called"),
        store::needed("scene", &Map::scene, store::text(), "a file, or a name of the library"),
        store::key("schemes", &Map::schemes, store::several(store::text()), "what is run",
                   "all that represent the scene"),
        store::needed("x", &Map::x, axis(), "the axis along which boundaries are sought"),
        store::key("y", &Map::y, axis(), "the other axis", "one row"),
        plain("rate", "44100 Hz", "of all points"),
        plain("modes", store::count().says, "the scheme's", "of all points"),
        plain("duration", "the scene's", "of all points"),
        plain("amplitude", "1", "scales starts and plucks"),
        {{"options", "a table: [SCHEME:]NAME = value", "", "of schemes"},
         [](Map& m, const store::Entry& e) {
             for (const auto& [name, value] : e.members())
                 m.fixed.emplace_back("option:" + name, value.option_text());
         }},
        {{"set", "a table: key = value", "", "any key of the scene"},
         [](Map& m, const store::Entry& e) {
             for (const auto& [name, value] : e.members()) m.fixed.emplace_back(name, value.toml());
         }},
        store::key("reference", &Map::reference, store::text(),
                   "what the runs are judged by, or \"none\"",
                   "the highest that represents the scene"),
        store::key("reference_modes", &Map::reference_modes, store::count(),
                   "of the reference at every point", "those of the point"),
        store::key("refine", &Map::refine, store::count(), "bisections of each boundary along x"),
        store::key("reproduce", &Map::reproduce, store::yes_or_no(),
                   "false: its failures are not minimised, as those of rounding, which differ on "
                   "another machine"),
        store::key("theory", &Map::theory, store::word("theory", theories()),
                   "a boundary that is known")};
}

void hold_together(Map& m, const store::Entry& e) {
    const double points = static_cast<double>(m.x.values.size()) *
                          static_cast<double>(std::max<std::size_t>(1, m.y.values.size())) *
                          static_cast<double>(std::max<std::size_t>(1, m.schemes.size()));
    if (points > most_points)
        e.fail(fmt::format("found {} points, expected at most {}", points, most_points));
    for (const auto& [key, value] : m.fixed)
        for (const char* axis : {"x", "y"})
            if (key == (*axis == 'x' ? m.x : m.y).key)
                e.need(axis).need("key").refuse("a key that is not set for all points as well");
    if (!m.x.at.empty()) return;
    for (const char* along_x : {"refine", "theory"})
        if (const auto v = e.at(along_x)) v->refuse("an axis x of numbers");
}
}  // namespace

store::Kind<std::vector<Map>> maps() {
    return store::tables("map", store::table(map_keys(), hold_together));
}

store::Table maps_table(const MapRun& run) {
    store::Table t{{"map", "scene", "scheme", "x_key", "x", "y_key", "y", "outcome", "detail",
                    "reference", "largest_over_bound", "energy_gain", "pull", "error"},
                   {}};
    for (const JudgedPoint& p : run.points) {
        const study::Summary& s = p.tried.record.cell.summary;
        const bool ran = p.tried.record.cell.ran();
        const auto number = [ran](double x) { return ran ? x : nan; };
        t.rows.push_back({p.at.map->name, p.at.map->scene, p.at.scheme->name, p.at.map->x.key,
                          store::Field::as_written(p.at.x), p.at.map->y.key,
                          store::Field::as_written(p.at.y), name_of(p.tried.judgement.verdict),
                          p.tried.judgement.detail, ran ? p.tried.record.against.reference : "",
                          number(s.largest_over_bound), number(s.energy_gain),
                          number(study::pull_of(s.smallest_contact_force, s.largest_contact_force)),
                          number(p.tried.error)});
    }
    return t;
}

store::Table boundaries_table(const MapRun& run, const Reproducers& reproducers) {
    store::Table t;
    t.columns = {"map",        "scheme",          "x_key",  "y_key",  "y",
                 "between",    "x_low",           "x_high", "theory", "relative_difference",
                 "reproducer", "theory_holds_for"};
    for (const Boundary& b : run.boundaries) {
        std::string file;
        for (const study::Verdict side : {b.low, b.high})
            if (const auto r =
                    b.map->reproduce ? reproducers.find({b.scheme->name, side}) : reproducers.end();
                r != reproducers.end())
                file = r->second;
        t.rows.push_back(
            {b.map->name, b.scheme->name, b.map->x.key, b.map->y.key, store::Field::as_written(b.y),
             fmt::format("{}|{}", name_of(b.low), name_of(b.high)),
             store::Field::as_written(b.x_low), store::Field::as_written(b.x_high), b.theory,
             b.relative_difference(), file, std::isnan(b.theory) ? "" : motion_of(b.map->theory)});
    }
    return t;
}

std::string maps_text(const MapRun& run) {
    std::string text;
    for (std::size_t i = 0; i < run.points.size();) {
        const PointPlace& first = run.points[i].at;
        std::map<study::Verdict, int> count;
        for (; i < run.points.size() && run.points[i].at.map == first.map &&
               run.points[i].at.scheme == first.scheme;
             ++i)
            ++count[run.points[i].tried.judgement.verdict];
        text += fmt::format("  {:<28} {:<42}", first.map->name, first.scheme->name);
        for (const auto& [verdict, n] : count) text += fmt::format(" {} {}", name_of(verdict), n);
        text += "\n";
    }
    for (const Boundary& b : run.boundaries)
        if (!std::isnan(b.theory))
            text += fmt::format(
                "  {:<28} {:<42} {}|{} at {} = {:.5g}{}{}, theory {:.5g}: {:+.2g} %\n    theory "
                "holds for {}\n",
                b.map->name, b.scheme->name, name_of(b.low), name_of(b.high), b.map->x.key,
                0.5 * (store::number_of(b.x_low) + store::number_of(b.x_high)),
                b.y.empty() ? "" : ", " + b.map->y.key + " = ", b.y, b.theory,
                100 * b.relative_difference(), motion_of(b.map->theory));
    return text + fmt::format("{} points, {} boundaries: {} run, {} read back\n", run.points.size(),
                              run.boundaries.size(), run.ran, run.read_back);
}

RecordedMaps run_and_record_maps(const std::vector<Map>& maps, const compare::Catalogue& catalogue,
                                 const MapRequest& request, const store::Listener& listener) {
    if (maps.empty()) return {};
    const MapRun run = run_maps(maps, catalogue, request, listener);
    RecordedMaps recorded{{}, maps_text(run)};
    if (request.folder.empty()) return recorded;
    const auto write = [&](const std::string& name, const std::string& content) {
        store::write_fresh(request.folder / name, content);
        recorded.files.push_back((request.folder / name).string());
    };
    write("maps.csv", store::csv(maps_table(run)));
    const std::vector<Reproducer> failures = reproducers_of(run, catalogue, request, listener);
    Reproducers files_of;
    for (const Reproducer& f : failures)
        files_of[{f.trial.scheme->name, f.expected.verdict}] = "failures/" + f.file;
    write_failures(request.folder / "failures", failures);
    write("boundaries.csv", store::csv(boundaries_table(run, files_of)));
    return recorded;
}

}  // namespace jvari::bench::suite

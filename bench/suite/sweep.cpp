// Swept keys of a set, and what a set that is a map may say.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "bench/suite/maps.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::suite {

namespace {
constexpr int most_values = 1'000'000;  // each is a run

struct Range {  // values spaced by equal ratios
    double from = 0, to = 0;
    int points = 0;
};

store::Kind<Range> range() {
    return store::table(
        std::vector{store::needed("from", &Range::from, store::positive(), "the first value"),
                    store::needed("to", &Range::to, store::positive(), "the last"),
                    store::needed("points", &Range::points, store::whole(2, most_values),
                                  "how many, spaced by equal ratios")});
}

std::vector<double> spread(const Range& r, const store::Entry& e) {
    if (!(r.to > r.from)) e.need("to").refuse("more than from");
    std::vector<double> values;
    for (int i = 0; i < r.points; ++i) {
        const double x =
            i + 1 == r.points
                ? r.to
                : r.from * std::pow(r.to / r.from, static_cast<double>(i) / (r.points - 1));
        // 1e6 instead of 999999.9999999998
        values.push_back(std::strtod(fmt::format("{:.12g}", x).c_str(), nullptr));
    }
    return values;
}

SweptKey swept(const std::string& key, const store::Entry& e) {
    SweptKey k;
    k.key = key;
    if (e.is_array()) {
        for (const store::Entry& one : e.items()) {
            if (key == "modes") store::count().read(one);
            if (key == "rate" || key == "duration" || key == "amplitude")
                store::positive().read(one);
            k.values.push_back(is_option(key) ? one.option_text() : one.toml());
            if (const auto x = number_of(k.values.back())) k.at.push_back(*x);
        }
    } else if (e.is_text() || e.number()) {
        e.refuse("an array of the values to vary, or { from, to, points }");
    } else {
        for (const double x : spread(range().read(e), e)) {
            k.at.push_back(key == "modes" ? std::round(x) : x);
            k.values.push_back(number_text(k.at.back()));
        }
    }
    if (k.at.size() < k.values.size()) k.at.clear();
    k.whole = key == "modes" ||
              (is_option(key) && std::ranges::all_of(k.values, [](const std::string& t) {
                   return t.find_first_not_of("0123456789") == std::string::npos;
               }));
    return k;
}

// Whether a map has the key at all points.
bool holds_everywhere(const CellSet& map, const std::string& key) {
    const auto begins = [&key](const std::string& text) { return text.starts_with(key + "="); };
    const auto is = [&key](const VariedOption& o) {
        return key ==
               "option:" + (o.option.scheme.empty() ? "" : o.option.scheme + ":") + o.option.name;
    };
    return (key == "rate" && !map.rates.empty()) || (key == "modes" && !map.modes.empty()) ||
           (key == "duration" && map.duration) || std::ranges::any_of(map.set, begins) ||
           std::ranges::any_of(map.varied, is);
}
}  // namespace

bool is_option(const std::string& key) { return key.starts_with("option:"); }

store::Kind<std::vector<SweptKey>> swept_keys() {
    return store::by_name<SweptKey>(
        "a table: key = [values], or { from, to, points } for values spaced by equal ratios",
        swept);
}

std::vector<store::Key<CellSet>> map_keys() {
    return {store::key("name", &CellSet::name, store::name_of_file(), "what a map is called", ""),
            {{"set", "a table: key = value", "", "any key of the scene, on all points of a map"},
             [](CellSet& s, const store::Entry& e) {
                 for (const auto& [key, value] : e.members())
                     s.set.push_back(key + "=" + value.toml());
             }},
            store::key("refine", &CellSet::refine, store::count(),
                       "bisections of each boundary of a map along its first swept key"),
            store::key("reproduce", &CellSet::reproduce, store::yes_or_no(),
                       "false: failures of a map are not minimised, as those of rounding, which "
                       "differ on another machine"),
            store::key("theory", &CellSet::theory, store::word("theory", theories()),
                       "a boundary of a map that is known", "none")};
}

void must_be_a_map(const CellSet& s, const store::Entry& e) {
    const bool map = s.measures(measured::outcome);
    const auto none_of = [&e](std::initializer_list<const char*> keys, const char* expected) {
        for (const char* key : keys)
            if (const auto v = e.at(key)) v->fail(expected);
    };
    if (!map)
        return none_of({"name", "set", "refine", "reproduce", "theory"},
                       "expected measure = \"outcome\" beside it");
    none_of({"search", "tap_rate", "repeats", "tap", "taps"}, "expected no such key on a map");
    if (s.measure.size() > 1) e.need("measure").fail("expected outcome alone");
    e.need("name");
    const std::pair<const char*, std::size_t> single[] = {
        {"scenes", s.scenes.size()}, {"rates", s.rates.size()}, {"modes", s.modes.size()}};
    for (const auto& [key, count] : single)
        if (count > 1) e.need(key).refuse("one value on a map");
    for (const VariedOption& o : s.varied)
        if (o.values.size() > 1) e.need("options").fail("expected one value of each on a map");
    const store::Entry sweep = e.need("sweep");
    if (s.sweep.empty() || s.sweep.size() > 2) sweep.fail("expected one or two keys on a map");
    for (const SweptKey& k : s.sweep) {
        const store::Entry values = sweep.need(k.key);
        if (holds_everywhere(s, k.key))
            values.fail("expected a key that is not set for all points as well");
        if (std::ranges::adjacent_find(k.at, std::greater_equal<>()) != k.at.end())
            values.fail("expected numbers that ascend");
    }
    if (s.sweep.front().at.empty())
        none_of({"refine", "theory"}, "expected numbers as the first swept key");
}

}  // namespace jvari::bench::suite

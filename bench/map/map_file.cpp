#include "bench/map/map_file.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cstdlib>
#include <functional>
#include <optional>

#include "bench/map/map_theory.hpp"
#include "bench/store/table_reader.hpp"

namespace jvari::bench::map {

namespace {
constexpr const char* plain_keys[] = {"rate", "modes", "duration", "amplitude"};
constexpr double most_points = 1e6;  // of a map: each is a run

bool is_option(const std::string& key) {
    return key.rfind("option:", 0) == 0;
}

std::optional<double> number_in(const std::string& text) {
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(x)) return std::nullopt;
    return x;
}

std::string value_text(const store::SuiteReader& read, const Value& v, const std::string& axis, const std::string& key) {
    if (is_option(axis)) return read.option_text(v, key);
    if (axis == "modes") return std::to_string(read.count(v, key));
    for (const char* plain : plain_keys)
        if (axis == plain) return number_text(read.positive(v, key));
    return read.toml(v, key);
}

MapAxis axis_of(const store::SuiteReader& read, const Value& v, const std::string& within) {
    read.table(v, within);
    read.only(v, within + ": ", {"key", "values", "from", "to", "points"});
    MapAxis a;
    const auto need = [&](const char* name) -> const Value& {
        if (const Value* x = v.find(name)) return *x;
        throw SceneFileError(read.place(v) + ": " + within + ": the key " + name + " is missing");
    };
    a.key = read.text(need("key"), within + ".key");
    if (const Value* values = v.find("values")) {
        for (const char* other : {"from", "to", "points"})
            if (const Value* x = v.find(other)) read.refuse(*x, within + "." + other, "either values or from, to and points");
        a.values = read.several(*values, within + ".values",
                                [&](const Value& one, const std::string& k) { return value_text(read, one, a.key, k); });
    } else {
        const double from = read.positive(need("from"), within + ".from"), to = read.positive(need("to"), within + ".to");
        const int points = read.count(need("points"), within + ".points");
        if (points < 2) read.refuse(need("points"), within + ".points", "2 or more");
        if (points > most_points) read.refuse(need("points"), within + ".points", fmt::format("at most {}", most_points));
        if (!(to > from)) read.refuse(need("to"), within + ".to", "more than from");
        for (int i = 0; i < points; ++i) {
            const double x = i + 1 == points ? to : from * std::pow(to / from, static_cast<double>(i) / (points - 1));
            const double tidy = std::strtod(fmt::format("{:.12g}", x).c_str(), nullptr);  // 1e6, and not 999999.9999999998
            a.values.push_back(a.key == "modes" ? std::to_string(std::lround(tidy)) : number_text(tidy));
        }
    }
    for (const std::string& text : a.values)
        if (const auto x = number_in(text)) a.at.push_back(*x);
    if (a.at.size() < a.values.size()) a.at.clear();
    if (std::adjacent_find(a.at.begin(), a.at.end(), std::greater_equal<>()) != a.at.end())
        read.refuse(need(v.find("values") ? "values" : "points"), within + ".values", "numbers that ascend");
    const auto digits = [](const std::string& t) { return t.find_first_not_of("0123456789") == std::string::npos; };
    a.whole = a.key == "modes" || (is_option(a.key) && std::all_of(a.values.begin(), a.values.end(), digits));
    return a;
}

Map map_of(const store::SuiteReader& read, const Value& v, const std::string& within) {
    read.table(v, within);
    read.only(v, within + ": ",
              {"name", "scene", "schemes", "x", "y", "duration", "amplitude", "rate", "modes", "options", "set", "reference",
               "reference_modes", "theory", "refine", "reproduce"});
    Map m;
    for (const char* name : {"name", "scene", "x"})
        if (!v.find(name)) throw SceneFileError(read.place(v) + ": " + within + ": the key " + name + " is missing");
    m.name = read.text(*v.find("name"), within + ".name");
    if (m.name.empty() || m.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") != std::string::npos)
        read.refuse(*v.find("name"), within + ".name", "lower-case letters, digits, _ and -: files are called by it");
    m.scene = read.text(*v.find("scene"), within + ".scene");
    m.x = axis_of(read, *v.find("x"), within + ".x");
    if (const Value* y = v.find("y")) m.y = axis_of(read, *y, within + ".y");
    if (const Value* s = v.find("schemes"))
        m.schemes = read.several(*s, within + ".schemes", [&](const Value& one, const std::string& k) { return read.text(one, k); });
    const double points = static_cast<double>(m.x.values.size()) * static_cast<double>(std::max<std::size_t>(1, m.y.values.size())) *
                          static_cast<double>(std::max<std::size_t>(1, m.schemes.size()));
    if (points > most_points)
        throw SceneFileError(fmt::format("{}: {}: found {} points, expected at most {}", read.place(v), within, points, most_points));
    for (const char* plain : plain_keys)
        if (const Value* x = v.find(plain)) m.fixed.emplace_back(plain, value_text(read, *x, plain, within + "." + plain));
    if (const Value* t = v.find("options"))
        for (const auto& [name, value] : read.table(*t, within + ".options"))
            m.fixed.emplace_back("option:" + name, read.option_text(value, within + ".options." + name));
    if (const Value* t = v.find("set"))
        for (const auto& [name, value] : read.table(*t, within + ".set"))
            m.fixed.emplace_back(name, read.toml(value, within + ".set." + name));
    for (const auto& [key, value] : m.fixed)
        for (const char* axis : {"x", "y"})
            if (key == (*axis == 'x' ? m.x : m.y).key)
                read.refuse(*v.find(axis)->find("key"), within + "." + axis + ".key", "a key that is not set for all points as well");
    if (const Value* x = v.find("reference")) m.reference = read.text(*x, within + ".reference");
    if (const Value* x = v.find("reference_modes")) m.reference_modes = read.count(*x, within + ".reference_modes");
    if (const Value* x = v.find("refine")) m.refine = read.count(*x, within + ".refine");
    if (m.refine > 0 && m.x.at.empty()) read.refuse(*v.find("refine"), within + ".refine", "an axis x of numbers");
    if (const Value* x = v.find("reproduce")) {
        const auto* asked = std::get_if<bool>(&x->content);
        if (!asked) read.refuse(*x, within + ".reproduce", "true or false");
        m.reproduce = *asked;
    }
    if (const Value* x = v.find("theory")) {
        m.theory = read.text(*x, within + ".theory");
        if (!is_theory(m.theory))
            throw SceneFileError(read.place(*x) + ": " + within + ".theory: " + store::unknown("theory", m.theory, theories()));
        if (m.x.at.empty()) read.refuse(*x, within + ".theory", "an axis x of numbers");
    }
    return m;
}
}  // namespace

std::vector<Map> maps_of(const store::SuiteReader& read, const Value& root) {
    std::vector<Map> maps;
    const Value* v = root.find("map");
    if (!v) return maps;
    const auto* tables = std::get_if<Array>(&v->content);
    if (!tables) read.refuse(*v, "map", "[[map]] tables");
    for (std::size_t i = 0; i < tables->size(); ++i) {
        maps.push_back(map_of(read, (*tables)[i], "map." + std::to_string(i)));
        for (std::size_t k = 0; k < i; ++k)
            if (maps[k].name == maps[i].name)
                read.refuse(*(*tables)[i].find("name"), "map." + std::to_string(i) + ".name", "a name of its own");
    }
    return maps;
}

}  // namespace jvari::bench::map

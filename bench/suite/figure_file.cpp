#include "bench/suite/figure_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/store/table_reader.hpp"

namespace jvari::bench::suite {

namespace {
constexpr double any = -std::numeric_limits<double>::infinity();

struct Entry {  // a value and the way to it
    const store::SuiteReader* read;
    const Value* value;
    std::string key;

    [[noreturn]] void refuse(const std::string& expected) const { read->refuse(*value, key, expected); }
    const TomlTable& table() const { return read->table(*value, key); }
    const TomlTable& table(const std::vector<std::string>& known) const {
        const TomlTable& t = table();
        read->only(*value, key + ": ", known);
        return t;
    }
    std::optional<Entry> at(const char* name) const {
        const Value* v = value->find(name);
        return v ? std::optional(Entry{read, v, key + "." + name}) : std::nullopt;
    }
    Entry need(const char* name) const {
        if (auto e = at(name)) return *e;
        throw SceneFileError(read->place(*value) + ": " + key + ": the key " + name + " is missing");
    }
    std::string text() const { return read->text(*value, key); }
    std::string word(const std::vector<std::string>& known, const char* what) const {
        const std::string w = text();
        if (std::find(known.begin(), known.end(), w) != known.end()) return w;
        throw SceneFileError(read->place(*value) + ": " + key + ": " + store::unknown(what, w, known));
    }
    double number(double least = any) const {
        const auto* whole = std::get_if<std::int64_t>(&value->content);
        const auto* real = std::get_if<double>(&value->content);
        const double x = whole ? static_cast<double>(*whole) : real ? *real : NAN;
        if (!std::isfinite(x) || x < least) refuse(least == any ? "a number" : "a number not below " + number_text(least));
        return x;
    }
    double positive() const {
        const double x = number();
        if (!(x > 0)) refuse("a number > 0");
        return x;
    }
    int count(int most, int least = 1) const {
        const auto* n = std::get_if<std::int64_t>(&value->content);
        if (!n || *n < least || *n > most) refuse("a whole number from " + std::to_string(least) + " to " + std::to_string(most));
        return static_cast<int>(*n);
    }
    bool truth() const {
        if (const auto* b = std::get_if<bool>(&value->content)) return *b;
        refuse("true or false");
    }
    std::vector<Entry> items() const {  // one value or an array of at least one
        const auto* array = std::get_if<Array>(&value->content);
        if (!array) return {*this};
        if (array->empty()) refuse("at least one value");
        std::vector<Entry> all;
        for (std::size_t i = 0; i < array->size(); ++i) all.push_back({read, &(*array)[i], key + "." + std::to_string(i)});
        return all;
    }
    std::vector<std::string> texts() const {
        std::vector<std::string> all;
        for (const Entry& e : items()) all.push_back(e.text());
        return all;
    }
    std::array<double, 2> range(double least = any) const {
        const auto* array = std::get_if<Array>(&value->content);
        if (!array || array->size() != 2) refuse("two numbers, [from, to]");
        const auto both = items();
        const std::array<double, 2> r{both[0].number(least), both[1].number(least)};
        if (!(r[0] < r[1])) refuse("[from, to] with from < to");
        return r;
    }
    std::string scalar() const {  // as it stands in a csv file
        if (const auto* s = std::get_if<std::string>(&value->content)) return *s;
        return number_text(number());
    }
};

std::string dump(const Value& v) {
    std::string text;
    if (const auto* table = std::get_if<TomlTable>(&v.content)) {
        for (const Member& m : *table) text += (text.empty() ? "" : ",") + m.key + "=" + dump(m.value);
        return "{" + text + "}";
    }
    if (const auto* array = std::get_if<Array>(&v.content)) {
        for (const Value& one : *array) text += (text.empty() ? "" : ",") + dump(one);
        return "[" + text + "]";
    }
    if (const auto* s = std::get_if<std::string>(&v.content)) return quote(*s);
    return v.found();
}

Tap tap_of(const Entry& e) {
    e.table({"name", "quantity", "string", "position"});
    std::vector<std::string> quantities;
    for (int q = 0; q <= static_cast<int>(Quantity::driving_force); ++q) quantities.emplace_back(name_of(static_cast<Quantity>(q)));
    const std::string quantity = e.need("quantity").word(quantities, "quantity");
    Tap t{e.need("name").text(), Quantity::displacement, std::nullopt, 0};
    t.quantity = static_cast<Quantity>(std::find(quantities.begin(), quantities.end(), quantity) - quantities.begin());
    if (const auto x = e.at("string")) t.string = x->count(1000, 0);
    if (const auto x = e.at("position")) t.position = x->number(0);
    return t;
}

FigureAxis axis_of(const Entry& e) {
    FigureAxis a;
    if (std::holds_alternative<std::string>(e.value->content)) {
        a.column = a.title = e.text();
        return a;
    }
    e.table({"column", "to", "title", "factor", "log", "domain"});
    a.column = a.title = e.need("column").text();
    if (const auto x = e.at("to")) a.to = x->text();
    if (const auto x = e.at("title")) a.title = x->text();
    if (const auto x = e.at("factor")) a.factor = x->number();
    if (const auto x = e.at("log")) a.log = x->truth();
    if (const auto x = e.at("domain")) a.domain = x->range();
    return a;
}

Figure figure_of(const Entry& e) {
    e.table({"name", "paper", "kind", "title", "statement", "table", "x", "y", "colour", "panels", "across", "free", "where", "labels",
             "width", "height"});
    const std::vector<std::string> kinds = {"lines", "points", "band", "spectrogram"};
    Figure f;
    f.name = e.need("name").text();
    if (f.name.empty() || f.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos)
        e.need("name").refuse("small letters, digits and -: it names a file");
    f.title = e.need("title").text();
    if (const auto x = e.at("paper")) f.paper = x->text();
    if (const auto x = e.at("statement")) f.statement = x->text();
    const std::string kind = e.need("kind").word(kinds, "kind");
    f.kind = static_cast<FigureKind>(std::find(kinds.begin(), kinds.end(), kind) - kinds.begin());
    if (f.kind == FigureKind::spectrogram) {
        for (const char* none : {"table", "x", "y"})
            if (const auto x = e.at(none)) x->refuse("nothing: a spectrogram is drawn from the cells that measure it");
    } else {
        f.table = e.need("table").word({"cells", "ensemble", "trace", "extent", "profile", "envelope", "centroid"}, "table");
        f.x = axis_of(e.need("x"));
        f.y = axis_of(e.need("y"));
        if ((f.kind == FigureKind::band) == f.y.to.empty())
            e.need("y").refuse(f.kind == FigureKind::band ? "{ column = LOW, to = HIGH }" : "no column `to`: only a band has one");
    }
    if (const auto x = e.at("colour")) f.colour = x->texts();
    if (const auto x = e.at("panels")) f.panels = x->texts();
    if (const auto x = e.at("across")) f.across = x->count(20);
    if (const auto x = e.at("free")) f.free = x->truth();
    if (const auto x = e.at("width")) f.width = x->count(4000);
    if (const auto x = e.at("height")) f.height = x->count(4000);
    if (const auto where = e.at("where"))
        for (const Member& m : where->table()) {
            auto& [column, values] = f.where.emplace_back(m.key, std::vector<std::string>());
            for (const Entry& one : Entry{e.read, &m.value, where->key + "." + m.key}.items()) values.push_back(one.scalar());
        }
    if (const auto labels = e.at("labels"))
        for (const Member& m : labels->table()) f.labels.emplace_back(m.key, Entry{e.read, &m.value, labels->key + "." + m.key}.text());
    return f;
}
}  // namespace

std::vector<Figure> figures_of(const store::SuiteReader& read, const Value& root) {
    std::vector<Figure> all;
    const Value* figures = root.find("figure");
    if (!figures) return all;
    const auto* array = std::get_if<Array>(&figures->content);
    if (!array) read.refuse(*figures, "figure", "[[figure]] tables");
    for (std::size_t i = 0; i < array->size(); ++i) {
        const Entry e{&read, &(*array)[i], "figure." + std::to_string(i)};
        all.push_back(figure_of(e));
        for (std::size_t k = 0; k < i; ++k)
            if (all[k].name == all[i].name) e.need("name").refuse("a name of its own");
    }
    return all;
}

FigureFacets figure_facets_of(const store::SuiteReader& read, const Value& set, const std::string& within) {
    const Entry e{&read, &set, within};
    FigureFacets f;
    if (const auto taps = e.at("taps"))
        for (const Entry& one : taps->items()) f.taps.push_back(tap_of(one));
    if (const auto x = e.at("trace")) {
        x->table({"taps", "windows"});
        f.trace = TraceRows{x->need("taps").texts(), {}};
        for (const Entry& window : x->need("windows").items()) f.trace->windows.push_back(window.range(0));
    }
    if (const auto x = e.at("extent")) {
        x->table({"taps", "intervals"});
        f.extent = ExtentRows{x->need("taps").texts(), x->need("intervals").count(100'000)};
    }
    if (const auto x = e.at("profile")) {
        x->table({"instants", "from", "to", "positions"});
        f.profile = ProfileRows{{}, x->need("from").number(0), x->need("to").positive(), x->need("positions").count(2000)};
        for (const Entry& instant : x->need("instants").items()) f.profile->instants.push_back(instant.number(0));
        if (!(f.profile->from < f.profile->to)) x->need("to").refuse("more than from");
    }
    if (const auto x = e.at("envelope")) {
        x->table({"taps", "width_hz", "to_hz", "points"});
        f.envelope = EnvelopeRows{x->need("taps").texts(), x->need("width_hz").positive(), x->need("to_hz").positive(),
                                  x->need("points").count(100'000)};
    }
    if (const auto x = e.at("centroid")) {
        x->table({"taps", "window", "hop", "from_hz", "to_hz"});
        f.centroid =
            CentroidRows{x->need("taps").texts(), x->need("window").positive(), x->need("hop").positive(),
                         x->at("from_hz") ? x->need("from_hz").number(0) : 0, x->at("to_hz") ? x->need("to_hz").positive() : HUGE_VAL};
    }
    const std::pair<const char*, bool> facets[] = {
        {"trace", f.trace.has_value()},       {"extent", f.extent.has_value()},     {"profile", f.profile.has_value()},
        {"envelope", f.envelope.has_value()}, {"centroid", f.centroid.has_value()},
    };
    std::vector<std::string> measured;
    if (const auto x = e.at("measure")) measured = x->texts();
    for (const auto& [name, said] : facets) {
        const bool asked = std::find(measured.begin(), measured.end(), name) != measured.end();
        if (asked && !said)
            throw SceneFileError(read.place(set) + ": " + within + ": measure asks for " + name + ", the table " + name + " is missing");
        if (said && !asked) e.need(name).refuse(std::string("\"") + name + "\" in measure beside it");
    }
    for (const char* key : {"taps", "trace", "extent", "profile", "envelope", "centroid"})
        if (const auto x = e.at(key)) f.identity += std::string(key) + "=" + dump(*x->value) + ";";
    return f;
}

}  // namespace jvari::bench::suite

#include "bench/suite/difference.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::suite {

namespace {
using Json = nlohmann::ordered_json;

// ---- Names of rows

// Rows by name: scene, swept keys, scheme, options and rate; also modes if a table has several at
// one rate. If several rows have the same name, the second becomes "... #2".
using Named = std::map<std::string, std::size_t>;

std::string counted(std::map<std::string, int>& seen, const std::string& text) {
    const int n = ++seen[text];
    return n == 1 ? text : fmt::format("{} #{}", text, n);
}

std::string cell_text(const study::TabledCell& c) {
    std::string text = c.scene;
    for (const auto& [key, value] : c.swept) text += " " + key + "=" + value;
    text += " " + c.variant();
    return text + (std::isnan(c.rate) ? "" : fmt::format(" {} Hz", c.rate));
}

// True if two cells differ only in modes.
bool modes_name(const study::Cells& cells) {
    std::map<std::string, int> seen;
    return std::ranges::any_of(
        cells, [&seen](const study::TabledCell& c) { return ++seen[cell_text(c)] > 1; });
}

Named named_cells(const study::Cells& cells, bool with_modes) {
    Named named;
    std::map<std::string, int> seen;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double modes = cells[i].modes;
        named[counted(seen, cell_text(cells[i]) + (with_modes && !std::isnan(modes)
                                                       ? fmt::format(", {} modes", modes)
                                                       : ""))] = i;
    }
    return named;
}

Named named_rows(const store::Table& t, const std::vector<std::string>& columns) {
    Named named;
    std::map<std::string, int> seen;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        std::string text;
        for (const std::string& name : columns) {
            const double x = t.number(i, name);  // 1e+05 is 100000
            const std::string value = std::isnan(x) ? t.text(i, name) : number_text(x);
            if (!value.empty()) text += (text.empty() ? "" : " ") + value;
        }
        named[counted(seen, text)] = i;
    }
    return named;
}

// Findings for cells.csv if its text contradicts the files from which cells.csv follows: somebody
// altered a file.
std::vector<Finding> altered(const Results& f) {
    if (f.shown.columns.empty()) return {};
    std::vector<Finding> all;
    const auto add = [&](const std::string& cell, const std::string& column,
                         const store::Field& follows, const store::Field& found) {
        all.push_back({Turn::worse, f.name + "/cells.csv " + cell, column, follows, found,
                       "altered: it follows from the other files"});
    };
    const store::Table follows = study::table_of(f.cells, study::Contents::cells);
    if (f.shown.rows.size() != follows.rows.size()) {
        add("", "rows", follows.rows.size(), f.shown.rows.size());
        return all;
    }
    for (const std::string& column : follows.columns) {
        if (f.shown.column(column) < 0) {
            add("", column, "there", "gone");
            continue;
        }
        for (std::size_t i = 0; i < f.cells.size(); ++i)
            if (const store::Field& is = f.shown.at(i, column), &was = follows.at(i, column);
                is != was && is.number() != was.number())
                add(cell_text(f.cells[i]), column, was, is);
    }
    return all;
}

// ---- The changes

std::vector<Pair> in_both(const Named& before, const Named& after, Only& only) {
    std::vector<Pair> pairs;
    for (const auto& [name, row] : before)
        if (const auto other = after.find(name); other != after.end())
            pairs.push_back({name, row, other->second});
        else only.before.push_back(name);
    for (const auto& [name, row] : after)
        if (!before.contains(name)) only.after.push_back(name);
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& a, const Pair& b) { return a.before < b.before; });
    return pairs;
}

// Names found in cells: facts, taps, swept keys, and measures with a number.
struct Names {
    std::set<std::string> facts, taps, keys, measures;
    explicit Names(const study::Cells& cells) {
        for (const study::TabledCell& c : cells) {
            for (const auto& [name, value] : c.facts) facts.insert(name);
            for (const std::string& tap : c.taps) taps.insert(tap);
            for (const auto& [key, value] : c.swept) keys.insert(key);
            for (const auto& of_tap : c.figures)
                for (std::size_t m = 0; m < of_tap.size(); ++m)
                    for (const auto& [name, part] : study::figure_parts)
                        if (!std::isnan(of_tap[m].*part))
                            measures.insert(study::measures()[m].column);
        }
    }
};

struct CellDifference {
    bool same_digits = true;
    std::vector<std::string> references;  // differences between the references
};
// Findings for a cell, the headline's errors first. `facts`: from both folders; `measures`: from
// the earlier one.
CellDifference compare_cell(const std::string& name, const study::TabledCell& before,
                            const study::TabledCell& after, const std::vector<std::string>& facts,
                            const std::set<std::string>& measures, Difference& d) {
    CellDifference own;
    const auto add = [&](const std::string& column, Turn turn, const store::Field& was,
                         const store::Field& is) {
        ++d.compared;
        own.same_digits = own.same_digits && was == is;
        if (turn == Turn::same) return;
        d.findings.push_back({turn, name, column, was, is, ""});
        if (column == "reference" || column == "reference_modes" || column == "reference_doubling")
            own.references.push_back(fmt::format("{} {} -> {}", column, was.text(), is.text()));
    };
    const auto add_figures = [&](const std::string& tap) {
        for (const auto& [part_name, part] : study::figure_parts)
            for (std::size_t m = 0; m < study::measures().size(); ++m) {
                const study::Measure& measure = study::measures()[m];
                if (!measures.contains(measure.column) ||
                    tap == (measure.bridge ? before.headline_bridge : before.headline_nut))
                    continue;  // not measured, or same value: the headline's
                add((part == &study::Figure::value ? "" : std::string(part_name) + " of ") +
                        measure.column + (tap.empty() ? "" : " of " + tap),
                    turn_of(part, m, tap, before, after), before.figure(m, tap).*part,
                    after.figure(m, tap).*part);
            }
    };
    for (const study::Column& c : study::columns()) {
        if (c.rule == study::Rule::clock || c.rule == study::Rule::name) continue;
        add(c.name, turn_of(c, before, after), c.value(before), c.value(after));
        if (std::string(c.name) == "flags") add_figures("");
    }
    for (const std::string& fact : facts)
        add("fact_" + fact, turn_of_fact(fact, before, after), before.fact(fact), after.fact(fact));
    for (const std::string& tap : before.taps) add_figures(tap);
    return own;
}

void compare_cells(const Results& a, const Results& b, Difference& d) {
    const bool with_modes = modes_name(a.cells) || modes_name(b.cells);
    const auto pairs =
        in_both(named_cells(a.cells, with_modes), named_cells(b.cells, with_modes), d.cells);
    d.cells_in_both = static_cast<int>(pairs.size());
    const Names were(a.cells), are(b.cells);
    std::vector<std::string> facts;
    std::ranges::set_intersection(were.facts, are.facts, std::back_inserter(facts));
    const auto only = [&](std::set<std::string> Names::*of, const char* kind) {
        for (const auto& [own, other, names] :
             {std::tuple(&were, &are, &d.columns.before), {&are, &were, &d.columns.after}})
            for (const std::string& name : own->*of)
                if (!(other->*of).contains(name)) names->push_back(kind + name);
    };
    only(&Names::keys, "");
    only(&Names::facts, "fact_");
    only(&Names::taps, "errors of ");
    std::ranges::set_difference(are.measures, were.measures, std::back_inserter(d.columns.after));
    int other_truth = 0;
    std::vector<std::string> changes;
    for (const Pair& p : pairs) {
        const CellDifference of =
            compare_cell(p.name, a.cells[p.before], b.cells[p.after], facts, were.measures, d);
        other_truth += !of.references.empty();
        d.to_the_last_digit += of.same_digits;
        for (const std::string& change : of.references)
            if (std::ranges::find(changes, change) == changes.end()) changes.push_back(change);
    }
    if (other_truth > 0)
        d.references = fmt::format(
            "the references differ in {} of {} cells ({}): there errors are against another "
            "solution",
            other_truth, pairs.size(),
            fmt::join(changes.begin(), changes.begin() + std::min<long>(3, std::ssize(changes)),
                      ", "));
    compare_costs(a, b, pairs, d);
}

void compare_maps(const Results& a, const Results& b, Difference& d) {
    const std::vector<std::string> names{"map", "scene", "scheme", "x_key", "x", "y_key", "y"};
    for (const Pair& p : in_both(named_rows(a.maps, names), named_rows(b.maps, names), d.points)) {
        ++d.compared;
        const store::Field &was = a.maps.at(p.before, "outcome"),
                           &is = b.maps.at(p.after, "outcome");
        const Turn turn = was == is        ? Turn::same
                          : was == "sound" ? Turn::worse
                          : is == "sound"  ? Turn::better
                                           : Turn::moved;
        if (turn != Turn::same)
            d.findings.push_back(
                {turn, "map " + p.name, "outcome", was, is, b.maps.text(p.after, "detail")});
    }
    const std::vector<std::string> lines{"map", "scheme", "x_key", "y_key", "y", "between"};
    for (const Pair& p :
         in_both(named_rows(a.boundaries, lines), named_rows(b.boundaries, lines), d.boundaries)) {
        ++d.compared;
        const auto low = [](const store::Table& t, std::size_t i) { return t.number(i, "x_low"); };
        const auto high = [](const store::Table& t, std::size_t i) {
            return t.number(i, "x_high");
        };
        if (low(a.boundaries, p.before) <= high(b.boundaries, p.after) &&
            low(b.boundaries, p.after) <= high(a.boundaries, p.before))
            continue;
        d.findings.push_back({Turn::moved, "boundary " + p.name, "x_low",
                              a.boundaries.at(p.before, "x_low"), b.boundaries.at(p.after, "x_low"),
                              "the brackets are apart"});
    }
}
}  // namespace

std::string Provenance::machine() const {
    return fmt::format("{}, {} cores, {}, {}", cpu, cores, vectors, system);
}

namespace {
Provenance provenance_of(const store::Folder& folder) {
    const Json& m = folder.manifest();
    const auto text = [&](const char* key) {
        const auto found = m.find(key);
        return found == m.end()     ? "unknown"
               : found->is_string() ? found->get<std::string>()
                                    : found->dump();
    };
    return {text("commit"), text("date"),  text("compiler"), text("flags"), text("build"),
            text("cpu"),    text("cores"), text("vectors"),  text("system")};
}
}  // namespace

Results read_results(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error))
        throw store::UsageError(fmt::format("{}: no such folder", path.string()));
    const store::Folder folder{path};
    const Results f{
        path.string(),        provenance_of(folder),      study::read_cells(folder, false),
        folder.table("maps"), folder.table("boundaries"), folder.table("cells")};
    if (f.cells.empty() && f.maps.columns.empty())
        throw store::UsageError(fmt::format("{}: neither facts.csv nor maps.csv", f.name));
    return f;
}

int Difference::count(Turn t) const {
    return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                          [t](const Finding& f) { return f.turn == t; }));
}

int Difference::missing() const {
    return static_cast<int>(cells.before.size() + points.before.size());
}

bool Difference::nothing() const {
    for (const auto& [kind, only] : alone())
        if (!only->before.empty() || !only->after.empty()) return false;
    return findings.empty();
}

Difference difference(const Results& before, const Results& after) {
    Difference d;
    compare_cells(before, after, d);
    compare_maps(before, after, d);
    for (const Results* folder : {&before, &after})
        for (Finding& f : altered(*folder)) d.findings.push_back(std::move(f));
    if (d.compared == 0)
        throw store::UsageError(
            fmt::format("{} and {} have no cell or map in common: expected two folders of "
                        "one suite or scene",
                        before.name, after.name));
    return d;
}

}  // namespace jvari::bench::suite

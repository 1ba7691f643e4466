// jvari list: everything available, and which scheme represents which scene. The text comes from
// the JSON.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/cells.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/controls.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;
using Schemes = std::vector<const Descriptor*>;

const std::vector<std::string> kinds{"schemes", "scenes", "references", "options", "facts",
                                     "taps",    "suites", "keys",       "columns"};

struct ListRequest : Common {
    std::string what;  // "": everything; a list; or a name in a list
};

// ---- Lists as JSON

Json schemes_json(const Schemes& schemes) {
    Json all = Json::array();
    for (const Descriptor* d : schemes) {
        Json approximates = Json::array(), options = Json::array();
        for (const Approximation& a : d->approximates)
            approximates.push_back({{"feature", name_of(a.feature)}, {"fact", a.fact.name}});
        for (const Option& o : d->options) options.push_back(o.name);
        all.push_back({{"name", d->name},
                       {"source", d->source},
                       {"represents", compare::names_in(d->represents)},
                       {"approximates", approximates},
                       {"note", d->note},
                       {"options", options},
                       {"control", is_control(*d)},
                       {"limit", d->limit.name ? Json(d->limit.name) : Json()},
                       {"balance", d->balance == Balance::exact          ? "exact"
                                   : d->balance == Balance::to_tolerance ? "to tolerance"
                                                                         : "none"},
                       {"clock", d->clock == Clock::continuous ? "continuous" : "stepped"}});
    }
    return all;
}

Json pairings_json() {
    Json all = Json::array();
    for (const Pairing& p : pairings())
        all.push_back(
            {{"string", p.string}, {"rule", p.rule}, {"scheme", p.scheme}, {"options", p.options}});
    return all;
}

// Schemes with the same option share the entry.
Json options_json(const Schemes& schemes) {
    Json all = Json::array();
    for (const Descriptor* d : schemes)
        for (const Option& o : d->options) {
            Json one{{"name", o.name},
                     {"default", o.fallback},
                     {"meaning", o.meaning},
                     {"choices", Json::array()},
                     {"schemes", Json::array()}};
            for (const auto& word : o.words()) one["choices"].push_back(word);
            auto same = std::ranges::find_if(all, [&one](Json listed) {
                listed["schemes"] = Json::array();
                return listed == one;
            });
            if (same == all.end()) same = all.insert(all.end(), one);
            (*same)["schemes"].push_back(d->name);
        }
    return all;
}

Json quantity_json(const std::string& names, const std::string& unit, const std::string& meaning) {
    return {{"name", names}, {"unit", unit}, {"meaning", meaning}};
}

Json facts_json() {
    Json all = Json::array();
    for (const FactName& f : facts::table) all.push_back(quantity_json(f.name, f.unit, f.meaning));
    all.push_back(quantity_json("largest_over_bound", "",
                                "largest value of a tap over what the energy of the scene can make "
                                "of it [1]; a run beyond the root of ten has diverged"));
    return all;
}

Json columns_json() {
    Json all = Json::array();
    for (const study::Column& c : study::columns()) {
        const std::string name = c.name;
        if (*c.meaning) all.push_back(quantity_json(name, c.unit, c.meaning));
        else all.back()["name"] = all.back()["name"].get<std::string>() + ", " + name;
        if (name == "flags")
            for (const study::Measure& m : study::measures())
                all.push_back(quantity_json(m.column, m.unit, m.axis()));
    }
    all.push_back(quantity_json(
        "fact_<fact>", "",
        "facts.csv: whatever else the scheme reports of itself (`jvari list facts`)"));
    for (const auto& [name, meaning] :
         {std::pair{"value", "errors.csv, of each tap and measure: the error"},
          {"floor", "noise floor of the error"},
          {"certificate", "the uncertainty of the reference for the scene"},
          {"in_model",
           "the error against a reference with as many modes as the scheme, and matched "
           "compliance where that has it: of scheme and step, without the cut. Empty where no such "
           "reference was run"},
          {"certificate_in_model", "how far that reference solves its model"}})
        all.push_back(quantity_json(name, "as the error", meaning));
    return all;
}

Json taps_json() {
    constexpr std::pair<Quantity, const char*> taps[] = {
        {Quantity::displacement,
         "of the string at a place, or of a mass, positive away from the barrier"},
        {Quantity::velocity, "of the string at a place, or of a mass"},
        {Quantity::nut_force,
         "of the string on its end at x = length, which on a guitar is the saddle"},
        {Quantity::bridge_force,
         "of the barriers, or of a mass, on the string, the mean over a row"},
        {Quantity::thread_force, "of the thread on the string, the mean over a row"},
        {Quantity::driving_force,
         "-(bridge_force + thread_force): of the string on what it touches"}};
    Json all = Json::array();
    for (const auto& [q, meaning] : taps)
        all.push_back(quantity_json(name_of(q), unit_of(q), meaning));
    return all;
}

using Scenes = std::vector<std::pair<std::string, Scene>>;  // library name, scene
Json scenes_json(Scenes& readable) {
    Json all = Json::array();
    for (const std::string& name : library_scenes()) try {
            const Scene& scene = readable.emplace_back(name, read_scene(name, {})).second;
            Json taps = Json::array();
            for (const Tap& tap : scene.taps)
                taps.push_back({{"name", tap.name},
                                {"quantity", name_of(tap.quantity)},
                                {"unit", unit_of(tap.quantity)}});
            all.push_back({{"name", name},
                           {"source", scene.source},
                           {"duration", scene.duration},
                           {"strings", scene.strings.size()},
                           {"needs", compare::names_in(needed_by(scene))},
                           {"taps", taps}});
        } catch (const std::runtime_error& e) {
            all.push_back({{"name", name}, {"error", e.what()}});
        }
    return all;
}

Json matrix_json(const Scenes& scenes, const Schemes& schemes) {
    Json all = Json::array();
    for (const auto& [name, scene] : scenes)
        for (const Descriptor* d : schemes) {
            const Features missing = needed_by(scene) - d->represents;
            all.push_back({{"scene", name},
                           {"scheme", d->name},
                           {"represents", missing.empty()},
                           {"missing", compare::names_in(missing)}});
        }
    return all;
}

// Merges the scenes that a scheme represents into one entry.
Json by_scheme(const Json& matrix) {
    Json scenes = Json::object(), all = Json::array();
    for (const Json& m : matrix)
        if (Json& of = scenes[m["scheme"].get<std::string>()]; m["represents"])
            of.push_back(m["scene"]);
    for (const auto& [scheme, names] : scenes.items())
        all.push_back({{"scheme", scheme}, {"scenes", names}});
    return all;
}

Json suites_json() {
    Json all = Json::array();
    for (const std::string& name : suite::library_suites()) try {
            const suite::Suite suite = suite::read_suite(name);
            all.push_back({{"name", name},
                           {"question", suite.question},
                           {"source", suite.source},
                           {"sets", suite.sets.size()}});
        } catch (const std::runtime_error& e) {
            all.push_back({{"name", name}, {"error", e.what()}});
        }
    return all;
}

Json table_json(const std::vector<store::KeyWords>& keys) {
    Json all = Json::array();
    for (const store::KeyWords& k : keys) {
        all.push_back({{"key", k.name},
                       {"value", k.value},
                       {"needed", k.needed},
                       {"absent", k.absent},
                       {"meaning", k.meaning}});
        if (!k.below.empty()) all.back()["keys"] = table_json(k.below);
    }
    return all;
}

Json keys_json() {  // keys in a suite file
    Json all = Json::object();
    for (const suite::TableWords& t : suite::suite_keys())
        all[t.table.empty() ? "file" : t.table] = table_json(t.keys);
    for (const suite::Facet& f : suite::facets())
        all["measure"].push_back({{"name", f.name}, {"meaning", f.meaning}});
    return all;
}

// ---- Lists as text

std::string field_text(const std::string& key, const Json& value) {
    if (value.is_boolean() || value.is_null()) return value == true ? key : "";
    if (!value.is_structured())
        return value.is_string() ? value.get<std::string>() : store::compact(value);
    std::string text;
    for (const Json& one : value)
        text += (text.empty() ? "" : value.is_array() ? ", " : " ") + field_text(key, one);
    return text;
}

using Rows = std::vector<std::vector<std::string>>;
void add_rows(Rows& rows, const Json& list, const std::string& above) {
    for (const Json& entry : list) {
        std::vector<std::string> row;
        for (const auto& [key, value] : entry.items()) {
            if (key != "keys") row.push_back((row.empty() ? above : "") + field_text(key, value));
            if (key == "source") break;
        }
        rows.push_back(row);
        if (entry.contains("keys")) add_rows(rows, entry["keys"], row.front() + ".");
    }
}

// Prints a line for each entry: the fields up to `source`, in columns. Fields after `source` appear
// only with --json. Keys in a nested table stand below the table, prefixed by the table's name and
// a dot.
std::string text_of(const std::string& title, const Json& list) {
    constexpr std::size_t widest = 32;  // a longer field shifts the rest after it
    std::string text;
    if (list.is_object()) {
        for (const auto& [name, inner] : list.items())
            text += text_of(title + " of " + name, inner);
        return text;
    }
    Rows rows;
    add_rows(rows, list, "");
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t k = 0; k < row.size(); ++k)
            widths[k] = std::max(widths[k], std::min(row[k].size(), widest));
    }
    std::string first;  // printed once above equal ones
    for (auto& row : rows) {
        std::string line;
        if (std::exchange(first, row[0]) == row[0]) row[0] = "";
        for (std::size_t k = 0; k < row.size(); ++k)
            line += fmt::format("  {:<{}}", row[k], widths[k]);
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    if (rows.empty()) return title + "\n  none\n";
    std::vector<std::string> fields;  // fields in the first entry
    for (const auto& [key, value] : list.front().items())
        if (fields.size() < rows.front().size()) fields.push_back(key);
    return fmt::format("{}: {}\n{}", title, fmt::join(fields, ", "), text);
}

// ---- A single thing by name

template <class Visit>  // visits each entry in a list, with the list's name
void each_entry(const std::string& list, const Json& entries, const Visit& visit) {
    for (const auto& [key, entry] : entries.items()) {
        if (entries.is_object()) each_entry(list + " of " + key, entry, visit);
        else visit(list, entry);
        if (entry.is_object() && entry.contains("keys")) each_entry(list, entry["keys"], visit);
    }
}

std::vector<std::string> names_of(const Json& entry) {  // "a, b" are two names
    std::istringstream text(entry.value("name", entry.value("key", "")));
    std::vector<std::string> names;
    for (std::string name; std::getline(text >> std::ws, name, ',');) names.push_back(name);
    return names;
}

// Finds all entries with this name, and adds the list to each. A scheme comes with the scenes it
// represents, a scene with its schemes.
Json named(const Json& lists, const std::string& name) {
    Json found = Json::array();
    std::vector<std::string> known = kinds;
    for (const auto& [list, entries] : lists.items())
        each_entry(list, entries, [&](const std::string& of, const Json& entry) {
            const std::vector<std::string> names = names_of(entry);
            known.insert(known.end(), names.begin(), names.end());
            if (std::ranges::find(names, name) == names.end()) return;
            Json& one = found.emplace_back(entry);
            one["list"] = of;
            const std::string self = of == "scenes" ? "scene" : "scheme",
                              other = of == "scenes" ? "scheme" : "scene";
            if (of == "scenes" || of == "schemes" || of == "references")
                for (const Json& m : lists["matrix"])
                    if (m[self] == name && m["represents"]) one[other + "s"].push_back(m[other]);
        });
    if (found.empty())
        throw store::UsageError(
            store::unknown("list or name", name, nearest(name, known).empty() ? kinds : known));
    return found;
}

std::string described(const Json& found, const std::string& name) {
    std::string text;
    for (const Json& entry : found) {
        text +=
            (text.empty() ? "" : "\n") + name + ", of " + entry["list"].get<std::string>() + "\n";
        for (const auto& [key, value] : entry.items())
            if (const std::string of = field_text(key, value);
                !of.empty() && key != "list" && of != name)
                text += fmt::format("  {:<14}{}\n", key, of);
    }
    return wrapped(text);
}

int list_command(ListRequest r) {
    const Console console(r.json, false);  // --quiet keeps the list, the only output
    const bool one = !r.what.empty() && std::ranges::find(kinds, r.what) == kinds.end();
    const std::string name = one ? std::exchange(r.what, "") : "";
    const compare::Catalogue catalogue;
    Schemes both = catalogue.schemes;
    both.insert(both.end(), catalogue.references.begin(), catalogue.references.end());
    Json json = Json::object();
    Scenes scenes;
    const auto add = [&](const char* key, const char* what, auto list) {
        if (r.what.empty() || r.what == what) json[key] = list();
    };
    add("schemes", "schemes", [&] { return schemes_json(catalogue.schemes); });
    add("pairings", "schemes", pairings_json);
    add("references", "references", [&] { return schemes_json(catalogue.references); });
    add("options", "options", [&] { return options_json(both); });
    add("facts", "facts", facts_json);
    add("scenes", "scenes", [&] { return scenes_json(scenes); });
    add("taps", "taps", taps_json);
    add("suites", "suites", suites_json);
    add("keys", "keys", keys_json);
    add("columns", "columns", columns_json);
    add("matrix", "scenes", [&] { return matrix_json(scenes, both); });
    std::string text;
    if (one) {
        json = {{name, named(json, name)}};
        text = described(json[name], name);
        if (std::ranges::find(kinds, name + "s") != kinds.end())
            text += fmt::format("\n`jvari list {}s` has all of them\n", name);
    } else
        for (const auto& [what, list] : json.items())
            text +=
                (text.empty() ? "" : "\n") +
                (what == "matrix" ? text_of("which scheme represents which scene", by_scheme(list))
                                  : text_of(what, list));
    console.print(text.substr(0, text.find_last_not_of('\n') + 1));
    console.print_json(store::indented(json));
    return exit_code::done;
}
}  // namespace

Act list_verb(CLI::App& program) {
    Verb<ListRequest> v(program, "list", "what exists, and which scheme represents which scene");
    v.option("what", v.r.what, {"WHAT"},
             "schemes, scenes, references, options, facts, taps, suites, keys (of suite files) or "
             "columns (of tables of cells); or the name of one thing, which is described; absent: "
             "all, and the matrix");
    return v.does(list_command,
                  "Example: jvari list schemes; jvari list modal_two_point\n\n"
                  "--json has all that is known.");
}

}  // namespace jvari::bench::command

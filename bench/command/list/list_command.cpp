// jvari list: what exists, and which scheme represents which scene.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/command/console.hpp"
#include "bench/command/list/list_keys.hpp"
#include "bench/command/list/list_seam.hpp"
#include "bench/command/text_table.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/json.hpp"
#include "bench/suite/suite_file.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

struct ListRequest : Common {
    std::string what;  // "": everything
};

using Schemes = std::vector<const Descriptor*>;
struct Shelf {
    std::vector<std::pair<std::string, Scene>> scenes;            // library name, scene
    std::vector<std::pair<std::string, std::string>> unreadable;  // library name, why
};
Shelf library() {
    Shelf shelf;
    for (const std::string& name : library_scenes()) try {
            shelf.scenes.emplace_back(name, read_scene(name, {}));
        } catch (const std::runtime_error& e) { shelf.unreadable.emplace_back(name, e.what()); }
    return shelf;
}

Listing list_scenes(const Shelf& shelf) {
    std::size_t width = 0;
    for (const auto& [name, scene] : shelf.scenes) width = std::max(width, name.size());
    Json all = Json::array();
    std::string text = "scenes\n";
    for (const auto& [name, scene] : shelf.scenes) {
        Json taps = Json::array();
        std::vector<std::string> tap_names;
        for (const Tap& tap : scene.taps) {
            taps.push_back({{"name", tap.name},
                            {"quantity", name_of(tap.quantity)},
                            {"unit", unit_of(tap.quantity)}});
            tap_names.push_back(tap.name);
        }
        const std::vector<std::string> needs = compare::names_in(needed_by(scene));
        all.push_back({{"name", name},
                       {"source", scene.source},
                       {"duration", scene.duration},
                       {"strings", scene.strings.size()},
                       {"needs", needs},
                       {"taps", taps}});
        text += fmt::format("  {:<{}}  {}\n  {:<{}}  {} s; taps {}; needs {}\n", name, width,
                            scene.source, "", width, scene.duration, fmt::join(tap_names, ", "),
                            fmt::join(needs, ", "));
    }
    for (const auto& [name, why] : shelf.unreadable) {
        all.push_back({{"name", name}, {"error", why}});
        text += fmt::format("  {}  cannot be read: {}\n", name, why);
    }
    return {std::move(all), text};
}

Listing list_matrix(const Shelf& shelf, const Schemes& schemes) {
    Json all = Json::array();
    std::size_t width = 0;
    for (const Descriptor* d : schemes) width = std::max(width, std::string(d->name).size());
    for (const auto& [name, scene] : shelf.scenes)
        for (const Descriptor* d : schemes) {
            const Features missing = needed_by(scene) - d->represents;
            all.push_back({{"scene", name},
                           {"scheme", d->name},
                           {"represents", missing.empty()},
                           {"missing", compare::names_in(missing)}});
        }
    std::string text = "which represents which scene\n";
    for (const Descriptor* d : schemes) {
        std::vector<std::string> able;
        for (const auto& [name, scene] : shelf.scenes)
            if (represents(*d, scene)) able.push_back(name);
        text += fmt::format("  {:<{}}  {}\n", d->name, width, fmt::join(able, ", "));
    }
    return {std::move(all), text};
}

Listing list_suites() {
    Json all = Json::array();
    std::string text = "suites\n";
    const std::vector<std::string> names = suite::library_suites();
    std::size_t width = 0;
    for (const std::string& name : names) width = std::max(width, name.size());
    for (const std::string& name : names) try {
            const suite::Suite suite = suite::read_suite(name);
            all.push_back({{"name", name},
                           {"question", suite.question},
                           {"source", suite.source},
                           {"sets", suite.sets.size()}});
            text += fmt::format("  {:<{}}  {}\n", name, width,
                                suite.question.empty() ? suite.source : suite.question);
        } catch (const std::runtime_error& e) {
            all.push_back({{"name", name}, {"error", e.what()}});
            text += fmt::format("  {}  cannot be read: {}\n", name, e.what());
        }
    if (all.empty()) text += "  none\n";
    return {std::move(all), text};
}

int list_command(ListRequest r) {
    const Console console(r.json, false);  // --quiet: the list is all that was asked for
    const compare::Catalogue catalogue;
    Schemes both = catalogue.schemes;
    both.insert(both.end(), catalogue.references.begin(), catalogue.references.end());
    Json json = Json::object();
    std::string text;
    const auto add = [&](const char* what, const Listing& l) {
        json[what] = l.json;
        text += (text.empty() ? "" : "\n") + l.text;
    };
    const auto asked = [&r](const char* what) { return r.what.empty() || r.what == what; };
    if (asked("schemes")) add("schemes", list_descriptors("schemes", catalogue.schemes));
    if (asked("schemes")) add("pairings", list_pairings());
    if (asked("references"))
        add("references", list_descriptors("references", catalogue.references));
    if (asked("options")) add("options", list_options(both));
    if (asked("facts")) add("facts", list_facts());
    const Shelf shelf = asked("scenes") ? library() : Shelf{};
    if (asked("scenes")) add("scenes", list_scenes(shelf));
    if (asked("taps")) add("taps", list_taps());
    if (asked("suites")) add("suites", list_suites());
    if (asked("keys")) add("keys", list_keys());
    if (asked("columns")) add("columns", list_columns());
    if (asked("scenes")) add("matrix", list_matrix(shelf, both));
    text.pop_back();
    console.print(wrapped(text, Console::width()));
    console.print_json(store::indented(json));
    return exit_code::done;
}
}  // namespace

Act list_verb(CLI::App& program) {
    Verb<ListRequest> v(program, "list", "what exists, and which scheme represents which scene");
    v.option("what", v.r.what,
             {"WHAT", CLI::IsMember({"schemes", "scenes", "references", "options", "facts", "taps",
                                     "suites", "keys", "columns"})},
             "schemes, scenes, references, options, facts, taps, suites, keys (of suite files) or "
             "columns (of cells.csv); absent: "
             "all, and the matrix");
    return v.does(list_command, "Example: jvari list schemes");
}

}  // namespace jvari::bench::command

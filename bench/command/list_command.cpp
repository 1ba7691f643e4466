// jvari list: what exists, and which scheme represents which scene.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/command/console.hpp"
#include "bench/command/list_keys.hpp"
#include "bench/command/list_seam.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/indented.hpp"
#include "bench/suite/suite_file.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;

struct ListRequest : Common {
    std::string what;  // "": everything
    bool markdown = false;
};

struct Shelf {  // what is listed
    compare::Catalogue catalogue;
    std::vector<std::pair<std::string, Scene>> scenes;            // library name, scene
    std::vector<std::pair<std::string, std::string>> unreadable;  // library name, why
};

constexpr Quantity quantities[] = {Quantity::displacement, Quantity::velocity,     Quantity::nut_force,
                                   Quantity::bridge_force, Quantity::thread_force, Quantity::driving_force};

Json scenes_json(const Shelf& shelf) {
    Json all = Json::array();
    for (const auto& [name, scene] : shelf.scenes) {
        Json taps = Json::array();
        for (const Tap& tap : scene.taps)
            taps.push_back({{"name", tap.name}, {"quantity", name_of(tap.quantity)}, {"unit", unit_of(tap.quantity)}});
        all.push_back({{"name", name},
                       {"source", scene.source},
                       {"duration", scene.duration},
                       {"strings", scene.strings.size()},
                       {"needs", compare::names_in(needed_by(scene))},
                       {"taps", taps}});
    }
    for (const auto& [name, why] : shelf.unreadable) all.push_back({{"name", name}, {"error", why}});
    return all;
}

Json matrix_json(const Shelf& shelf) {
    Json all = Json::array();
    for (const auto& [name, scene] : shelf.scenes)
        for (const auto* list : {&shelf.catalogue.schemes, &shelf.catalogue.references})
            for (const Descriptor* d : *list) {
                const Features missing = needed_by(scene) - d->represents;
                all.push_back(
                    {{"scene", name}, {"scheme", d->name}, {"represents", missing.empty()}, {"missing", compare::names_in(missing)}});
            }
    return all;
}

const char* meaning_of(Quantity q) {
    switch (q) {
        case Quantity::displacement: return "of the string at a place, positive away from the barrier";
        case Quantity::velocity: return "of the string at a place";
        case Quantity::nut_force: return "of the string on its end at x = length, which on a guitar is the saddle";
        case Quantity::bridge_force: return "of the barriers on the string, the mean over a row";
        case Quantity::thread_force: return "of the thread on the string, the mean over a row";
        case Quantity::driving_force: return "-(bridge_force + thread_force): of the string on what it touches";
    }
    return "";
}

Json taps_json() {
    Json all = Json::array();
    for (Quantity q : quantities) all.push_back({{"name", name_of(q)}, {"unit", unit_of(q)}, {"meaning", meaning_of(q)}});
    return all;
}

std::string scenes_text(const Shelf& shelf) {
    std::size_t width = 0;
    for (const auto& [name, scene] : shelf.scenes) width = std::max(width, name.size());
    std::string text = "scenes\n";
    for (const auto& [name, scene] : shelf.scenes) {
        std::vector<std::string> taps;
        for (const Tap& tap : scene.taps) taps.push_back(tap.name);
        text += fmt::format("  {:<{}}  {}\n  {:<{}}  {} s; taps {}; needs {}\n", name, width, scene.source, "", width, scene.duration,
                            fmt::join(taps, ", "), fmt::join(compare::names_in(needed_by(scene)), ", "));
    }
    for (const auto& [name, why] : shelf.unreadable) text += fmt::format("  {}  cannot be read: {}\n", name, why);
    return text;
}

std::string matrix_text(const Shelf& shelf) {  // schemes down, scenes across
    std::size_t width = 0;
    std::string text = "which represents which scene\n";
    for (const auto* list : {&shelf.catalogue.schemes, &shelf.catalogue.references})
        for (const Descriptor* d : *list) width = std::max(width, std::string(d->name).size());
    for (std::size_t k = 0; k < shelf.scenes.size(); ++k)
        text += fmt::format("  {:<{}}  {}{}\n", "", width, std::string(3 * k, ' '), shelf.scenes[k].first);
    for (const auto* list : {&shelf.catalogue.schemes, &shelf.catalogue.references})
        for (const Descriptor* d : *list) {
            text += fmt::format("  {:<{}}  ", d->name, width);
            for (const auto& [name, scene] : shelf.scenes) text += (needed_by(scene) - d->represents).empty() ? "x  " : ".  ";
            text += '\n';
        }
    return text;
}

std::string taps_text() {
    std::string text = "taps\n";
    for (Quantity q : quantities) text += fmt::format("  {:<14}{:<5}{}\n", name_of(q), unit_of(q), meaning_of(q));
    return text;
}

Json suites_json() {
    Json all = Json::array();
    for (const std::string& name : suite::library_suites()) try {
            const suite::Suite suite = suite::read_suite(name);
            all.push_back({{"name", name}, {"source", suite.source}, {"sets", suite.sets.size()}});
        } catch (const std::runtime_error& e) {
            all.push_back({{"name", name}, {"error", e.what()}});
        }
    return all;
}

std::string suites_text() {
    std::string text = "suites\n";
    const Json all = suites_json();
    for (const Json& suite : all)
        text += fmt::format(
            "  {}  {}\n", suite.at("name").get<std::string>(),
            suite.contains("error") ? "cannot be read: " + suite.at("error").get<std::string>() : suite.at("source").get<std::string>());
    return text + (all.empty() ? "  none\n" : "");
}

int list_command(const ListRequest& r) {
    static const std::set<std::string> in_markdown{"schemes", "options", "facts", "keys", "columns"};
    if (r.markdown && !in_markdown.contains(r.what))
        throw store::UsageError("--markdown goes with `jvari list schemes`, and with options, facts, keys or columns in place of schemes");
    const Console console(r.json, false);  // --quiet: the list is all that was asked for
    Shelf shelf{compare::Catalogue(r.plugins), {}, {}};
    const auto asked = [&r](const char* what) { return r.what.empty() || r.what == what; };
    if (asked("scenes"))
        for (const std::string& name : library_scenes()) try {
                shelf.scenes.emplace_back(name, read_scene(name, {}));
            } catch (const std::runtime_error& e) {
                shelf.unreadable.emplace_back(name, e.what());
            }
    if (r.markdown) {
        std::vector<const Descriptor*> all = shelf.catalogue.schemes;
        all.insert(all.end(), shelf.catalogue.references.begin(), shelf.catalogue.references.end());
        const std::string table = r.what == "options"   ? list_options(shelf.catalogue).markdown
                                  : r.what == "facts"   ? list_facts().markdown
                                  : r.what == "keys"    ? list_keys().markdown
                                  : r.what == "columns" ? list_columns().markdown
                                                        : list_descriptors("", all).markdown;
        console.print(table);
        console.print_json(store::indented({{"markdown", table}}));
        return exit_code::done;
    }
    Json json = Json::object();
    std::string text;
    const auto part = [&](const char* what, const Json& j, const std::string& t) {
        if (!asked(what)) return;
        json[what] = j;
        text += (text.empty() ? "" : "\n") + t;
    };
    const auto listing = [&](const char* what, const Listing& l) { part(what, Json::parse(l.json), l.text); };
    listing("schemes", list_descriptors("schemes", shelf.catalogue.schemes));
    listing("references", list_descriptors("references", shelf.catalogue.references));
    listing("options", list_options(shelf.catalogue));
    listing("facts", list_facts());
    part("scenes", scenes_json(shelf), scenes_text(shelf));
    part("taps", taps_json(), taps_text());
    if (asked("suites")) part("suites", suites_json(), suites_text());
    listing("keys", list_keys());
    listing("columns", list_columns());
    if (asked("scenes")) {
        json["matrix"] = matrix_json(shelf);
        text += "\n" + matrix_text(shelf);
    }
    text.pop_back();
    console.print(text);
    console.print_json(store::indented(json));
    return exit_code::done;
}
}  // namespace

Act list_verb(CLI::App& program) {
    const auto r = std::make_shared<ListRequest>();
    CLI::App* verb = program.add_subcommand("list", "what exists, and which scheme represents which scene");
    verb->add_option("what", r->what,
                     "schemes, scenes, references, options, facts, taps, suites, keys (of suite files) or columns (of cells.csv); absent: "
                     "all, and the matrix")
        ->check(CLI::IsMember({"schemes", "scenes", "references", "options", "facts", "taps", "suites", "keys", "columns"}))
        ->type_name("WHAT")
        ->option_text("");
    verb->add_flag("--markdown", r->markdown,
                   "with `schemes`: the capability table of the README; with `options`, `facts`, `keys` or `columns`: their table");
    verb->footer("Example: jvari list schemes --markdown");
    add_common(*verb, *r);
    return [r] { return list_command(*r); };
}

}  // namespace jvari::bench::command

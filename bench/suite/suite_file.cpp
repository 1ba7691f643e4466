// Reader for suite files, with scenes/document.hpp (the only TOML reader) and declared keys
// (store/keys.hpp).
#include "bench/suite/suite.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "bench/folders.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/usage.hpp"
#include "scenes/installed.hpp"

namespace jvari::bench::suite {

namespace fs = std::filesystem;

namespace {
using store::key;
using store::needed;
namespace fields = compare::fields;

// ---- A set of cells

constexpr double most_cells = 1e6;

store::Kind<std::optional<int>> reference_modes() {
    const auto modes = store::whole(0, store::most_counted);
    const std::string says = modes.says + ", or \"cell\"";
    return {says, [says, modes](const store::Entry& e) -> std::optional<int> {
                if (!e.is_text()) return modes.read(e);
                if (e.text() != "cell") e.refuse(says);
                return {};
            }};
}

VariedOption varied(const std::string& name, const store::Entry& e) {
    VariedOption o{compare::SchemeOption::of(name, ""), {}};
    for (const store::Entry& one : e.items()) o.values.push_back(one.option_text());
    return o;
}

// All facets, or those of a population, which has no maps.
std::vector<std::string> names_of_facets(bool maps = true) {
    std::vector<std::string> all;
    for (const Facet& f : facets())
        if (maps || f.name != std::string_view(measured::outcome)) all.emplace_back(f.name);
    return all;
}

store::Kind<Tap> tap() {
    std::vector<std::pair<std::string, Quantity>> quantities;
    for (int q = 0; q <= static_cast<int>(Quantity::driving_force); ++q)
        quantities.emplace_back(name_of(static_cast<Quantity>(q)), static_cast<Quantity>(q));
    return store::table(std::vector{
        needed("name", &Tap::name, store::text(), "what it is called"),
        needed("quantity", &Tap::quantity, store::one_of("quantity", std::move(quantities)),
               "what is heard"),
        key("string", &Tap::string, store::whole(0, 1000), "which one",
            "of forces, the sum over strings"),
        key("position", &Tap::position, store::not_negative("m"), "of displacement and velocity")});
}

std::vector<store::Key<CellSet>> set_keys() {
    using Set = CellSet;
    const auto request =
        []<class Member>(Member compare::CompareRequest::*member) -> Member Set::* {
        return member;
    };
    const auto field = [](const compare::FieldWords& words, auto member, const auto& kind) {
        return key(words.name, member, kind, words.meaning, words.absent);
    };
    std::vector<store::Key<Set>> keys{
        needed("scenes", &Set::scenes, store::several(store::text()),
               "files, beside the suite or where the program runs, or names of the library"),
        field(fields::schemes, request(&Set::schemes), store::several(store::text())),
        field(fields::rates, request(&Set::rates), store::several(store::positive("Hz"))),
        field(fields::modes, request(&Set::modes), store::several(store::count())),
        key("search", request(&Set::search), store::yes_or_no(),
            "where errors are measured and these are not named, tries more modes, and both forms "
            "of compliance"),
        field(fields::duration, request(&Set::duration), store::positive("s")),
        field(fields::tap_rate, request(&Set::tap_rate), store::positive("Hz")),
        field(fields::repeats, request(&Set::repeats), store::count()),
        key("reference", request(&Set::reference), store::text(), "what errors are against",
            "the highest that represents the scene"),
        field(fields::reference_modes, request(&Set::reference_modes), reference_modes()),
        key("tap", &Set::tap, store::text(), "of the spectrogram and of rows of one tap",
            "the scene's first"),
        key("time_limit_s", request(&Set::time_limit), store::positive("s"),
            "processor time of a cell's accuracy run, and of each of its reference's two", "none"),
        key("options", &Set::varied,
            store::by_name<VariedOption>("a table: [SCHEME:]NAME = values", varied),
            "one value, or several to vary"),
        key("sweep", &Set::sweep, swept_keys(), "any key of the scene, with the values to vary"),
        key("measure", &Set::measure, store::several(store::word("measure", names_of_facets())),
            "what is measured", measured::errors),
        key("taps", &Set::taps, store::several(tap()), "taps beside those of the scene")};
    for (store::Key<Set>& k : map_keys()) keys.push_back(std::move(k));
    return keys;
}

std::vector<store::Key<Population>> population_keys() {
    const auto base = []<class Member>(Member CellSet::*member) -> Member Population::* {
        return member;
    };
    std::vector<store::Key<Population>> keys{
        key("seed", &Population::seed, store::whole(0, store::most_counted),
            "of the strings that are drawn"),
        key("periods", &Population::periods, store::positive(),
            "of the first mode, after the last pluck, that each string runs for"),
        key("modes", &Population::multiples, store::several(store::positive()),
            "as multiples of those below 20 kHz; those above half the rate are left out"),
        key("effort", base(&CellSet::effort), store::positive(),
            "of each reference: 1 are the minutes that compare takes at most", "1"),
        key("scenes", base(&CellSet::scenes), store::several(store::text()),
            "fixed strings beside those that are drawn", "none"),
        key("measure", &Population::measure,
            store::several(store::word("measure", names_of_facets(false))), "what is measured",
            "errors, cost, share")};
    const auto same = [](const std::string& name) {
        return name == "schemes" || name == "rates" || name == "repeats" || name == "reference" ||
               name == "time_limit_s" || name == "options";
    };
    for (store::Key<CellSet>& k : set_keys())
        if (same(k.words.name)) keys.push_back({k.words, k.read});
    return keys;
}

void must_be_few(const CellSet& s, const store::Entry& e) {
    double cells = 1;
    const auto times = [&cells](std::size_t listed) {
        cells *= static_cast<double>(std::max<std::size_t>(1, listed));
    };
    for (const std::size_t listed :
         {s.scenes.size(), s.schemes.size(), s.rates.size(), s.modes.size()})
        times(listed);
    for (const SweptKey& k : s.sweep) times(k.values.size());
    for (const VariedOption& o : s.varied) times(o.values.size());
    if (cells > most_cells)
        e.fail(
            fmt::format("found {} cells, expected at most {}: each is a run", cells, most_cells));
}

void hold_together(CellSet& s, const store::Entry& e) {
    must_be_few(s, e);
    must_be_a_map(s, e);
    s.search = s.search && s.measures(measured::errors);
    if (s.measures(measured::share))
        e.need("measure").fail("found share in [[cells]], expected it in [population]");
    if (s.measures(measured::cost) && !s.measures(measured::errors))
        e.need("measure").fail(
            "found cost without errors, expected both: no speed without an error");
}

store::Kind<std::optional<Population>> population() {
    const auto one = store::table(population_keys());
    return {one.says, [read = one.read](const store::Entry& e) { return std::optional(read(e)); },
            one.below};
}

// ---- A suite

std::vector<store::Key<Suite>> keys_of_suite() {
    return {
        key("name", &Suite::name, store::text(), "what it is called", "the file's"),
        key("question", &Suite::question, store::text(), "what it answers", "none"),
        key("source", &Suite::source, store::text(), "what it follows", "none"),
        key("population", &Suite::population, population(),
            "strings drawn from the grounds, in place of cells"),
        key("ground", &Suite::grounds, store::tables("ground", store::table(ground_keys())),
            "of a population: strings of one kind"),
        key("cells", &Suite::sets, store::tables("cells", store::table(set_keys(), hold_together)),
            "sets of cells: each the product of what it lists")};
}

fs::path library() {
    if (const char* set = std::getenv("JVARI_SUITES"); set && *set) return set;
    std::error_code error;
    if (fs::path own = installed("suites"); !own.empty()) return own;
    return fs::is_directory(JVARI_SOURCE_SUITES, error) ? JVARI_SOURCE_SUITES
                                                        : JVARI_INSTALLED_SUITES;
}
}  // namespace

bool CellSet::measures(std::string_view facet) const {
    return std::find(measure.begin(), measure.end(), facet) != measure.end();
}

std::vector<TableWords> suite_keys() {
    std::vector<TableWords> all(1);
    for (store::KeyWords& k : store::words_of(keys_of_suite())) {
        if (!k.below.empty()) all.push_back({k.name, std::exchange(k.below, {})});
        all.front().keys.push_back(std::move(k));
    }
    return all;
}

Suite parse_suite(std::string_view content, const std::string& file_name) {
    static const auto keys = keys_of_suite();
    const Document document = parse_document(content, file_name, {});
    const store::Entry root(document, document.root, "");
    Suite suite;
    suite.name = fs::path(file_name).stem().string();
    store::read_keys(root, keys, suite);
    if (suite.population && !suite.sets.empty())
        root.need("population").fail("found [[cells]] too, expected a suite of its own");
    if (suite.population && suite.grounds.empty() && suite.population->scenes.empty())
        root.need("population").fail("found no strings, expected [[ground]] tables or scenes");
    if (!suite.grounds.empty() && !suite.population)
        root.need("ground").fail("expected [population] beside it");
    if (suite.sets.empty() && !suite.population)
        root.at("cells").value_or(root).fail(std::string(root.at("cells") ? "" : "cells: ") +
                                             "expected at least one [[cells]]");
    // Search order for a scene's file: first beside the suite's file, then in the working
    // directory. A name from the library is left alone.
    const auto find = [&](std::string& scene) {
        std::error_code error;
        if (const fs::path beside = fs::path(file_name).parent_path() / scene;
            fs::path(scene).is_relative() && fs::is_regular_file(beside, error))
            scene = beside.string();
    };
    for (CellSet& set : suite.sets)
        for (std::string& scene : set.scenes) find(scene);
    for (Ground& g : suite.grounds) find(g.scene);
    if (suite.population) {
        for (std::string& scene : suite.population->scenes) find(scene);
        suite.sets = sets_of(*suite.population, suite.grounds);
    }
    const auto maps =
        std::stable_partition(suite.sets.begin(), suite.sets.end(),
                              [](const CellSet& set) { return !set.measures(measured::outcome); });
    suite.maps.assign(maps, suite.sets.end());
    suite.sets.erase(maps, suite.sets.end());
    return suite;
}

Suite read_suite(const std::string& name) {
    std::error_code error;
    const fs::path shelved = library() / (name + ".toml");
    // A bare name means the library's suite if there is one, even if the working directory has such
    // a file: ./NAME is a file.
    const bool known = name.find('/') == std::string::npos && fs::is_regular_file(shelved, error);
    const bool file = !known && fs::is_regular_file(name, error);
    if (!file && !known)
        throw store::UsageError(store::unknown("suite", name, library_suites()) +
                                " (neither a file nor a suite of the library)");
    const std::string path = file ? name : shelved.string();
    return parse_suite(store::read_whole(path), path);
}

std::vector<std::string> library_suites() { return toml_names(library()); }

}  // namespace jvari::bench::suite

// Reads by scenes/document.hpp, the one reader of TOML there is, so that messages carry file, line and key as those of scenes do.
#include "bench/suite/suite_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "bench/map/map_file.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/table_reader.hpp"
#include "bench/store/usage.hpp"
#include "scenes/installed.hpp"

namespace jvari::bench::suite {

namespace fs = std::filesystem;

namespace {
constexpr std::array facet_names = {"errors", "cost",   "spectrogram", "sound",    "dispersion", "ensemble",
                                    "trace",  "extent", "profile",     "envelope", "centroid"};
constexpr std::array all_facets = {Facet::errors, Facet::cost,   Facet::spectrogram, Facet::sound,    Facet::dispersion, Facet::ensemble,
                                   Facet::trace,  Facet::extent, Facet::profile,     Facet::envelope, Facet::centroid};
static_assert(facet_names.size() == all_facets.size());

CellSet set_of(const store::SuiteReader& read, const Value& v, const std::string& within) {
    read.table(v, within);
    read.only(v, within + ": ", {"scenes",          "schemes", "rates",   "modes",    "duration", "tap_rate", "repeats",      "reference",
                                 "reference_modes", "options", "sweep",   "measure",  "tap",      "elements", "time_limit_s", "taps",
                                 "trace",           "extent",  "profile", "envelope", "centroid"});
    const auto text = [&read](const Value& x, const std::string& k) { return read.text(x, k); };
    const auto number = [&read](const Value& x, const std::string& k) { return read.positive(x, k); };
    const auto count = [&read](const Value& x, const std::string& k) { return read.count(x, k); };
    const auto key = [&within](const char* name) { return within + "." + name; };
    CellSet s;
    s.modes = {0};
    s.measure = {Facet::errors};
    if (!v.find("scenes")) throw SceneFileError(read.place(v) + ": " + within + ": the key scenes is missing");
    s.scenes = read.several(*v.find("scenes"), key("scenes"), text);
    if (const Value* x = v.find("schemes")) s.schemes = read.several(*x, key("schemes"), text);
    if (const Value* x = v.find("rates")) s.rates = read.several(*x, key("rates"), number);
    if (const Value* x = v.find("modes")) s.modes = read.several(*x, key("modes"), count);
    if (const Value* x = v.find("duration")) s.duration = number(*x, key("duration"));
    if (const Value* x = v.find("tap_rate")) s.tap_rate = number(*x, key("tap_rate"));
    if (const Value* x = v.find("repeats")) s.repeats = count(*x, key("repeats"));
    if (const Value* x = v.find("reference")) s.reference = text(*x, key("reference"));
    if (s.modes.size() > 1) s.reference_modes = 0;  // a truth that shrank with the cells would call the fewest modes the best
    if (const Value* x = v.find("reference_modes")) {
        const auto* word = std::get_if<std::string>(&x->content);
        if (word && *word != "cell") read.refuse(*x, key("reference_modes"), "a whole number, 0 or more, or \"cell\"");
        if (word) s.reference_modes.reset();
        else s.reference_modes = read.none_or(*x, key("reference_modes"));
    }
    if (const Value* x = v.find("tap")) s.tap = text(*x, key("tap"));
    if (const Value* x = v.find("time_limit_s")) s.time_limit = number(*x, key("time_limit_s"));
    if (const Value* x = v.find("options"))
        for (const Member& m : read.table(*x, key("options"))) {
            const auto colon = m.key.find(':');
            VariedOption o{
                colon == std::string::npos ? "" : m.key.substr(0, colon), colon == std::string::npos ? m.key : m.key.substr(colon + 1), {}};
            o.values = read.several(m.value, key("options.") + m.key,
                                    [&read](const Value& one, const std::string& k) { return read.option_text(one, k); });
            s.options.push_back(std::move(o));
        }
    if (const Value* x = v.find("sweep"))
        for (const Member& m : read.table(*x, key("sweep"))) {
            const std::string name = key("sweep.") + m.key;
            if (!std::holds_alternative<Array>(m.value.content)) read.refuse(m.value, name, "an array of the values to vary");
            s.sweep.push_back(
                {m.key, read.several(m.value, name, [&read](const Value& one, const std::string& k) { return read.toml(one, k); })});
        }
    const auto word_of = [&read](const char* what, auto all) {  // one of a list of values that have names
        return [&read, what, all](const Value& one, const std::string& k) {
            const std::string word = read.text(one, k);
            std::vector<std::string> known;
            for (const auto value : all) {
                if (word == name_of(value)) return value;
                known.emplace_back(name_of(value));
            }
            throw SceneFileError(read.place(one) + ": " + k + ": " + store::unknown(what, word, known));
        };
    };
    if (const Value* x = v.find("measure")) {
        s.measure = read.several(*x, key("measure"), word_of("measure", facets()));
        if (s.measures(Facet::cost) && !s.measures(Facet::errors))
            throw SceneFileError(read.place(*x) + ": " + key("measure") +
                                 ": found cost without errors, expected both: no speed without an error");
    }
    if (const Value* x = v.find("elements")) {
        s.elements = read.several(*x, key("elements"), word_of("element", compare::elements()));
        if (!s.measures(Facet::cost))
            throw SceneFileError(read.place(*x) + ": " + key("elements") +
                                 ": measure does not ask for cost, which elements are compared by");
    }
    return s;
}

fs::path library() {
    if (const char* set = std::getenv("JVARI_SUITES"); set && *set) return set;
    std::error_code error;
    if (const fs::path own = installed("suites"); !own.empty()) return own;
    return fs::is_directory(JVARI_SOURCE_SUITES, error) ? JVARI_SOURCE_SUITES : JVARI_INSTALLED_SUITES;
}
}  // namespace

std::span<const Facet> facets() {
    return all_facets;
}

const char* name_of(Facet f) {
    return facet_names[static_cast<std::size_t>(f)];
}

bool CellSet::measures(Facet f) const {
    return std::find(measure.begin(), measure.end(), f) != measure.end();
}

Suite parse_suite(std::string_view content, const std::string& file_name) {
    const Document document = parse_document(content, file_name, {});
    const store::SuiteReader read(document);
    read.only(document.root, "", {"name", "source", "cells", "figure", "map"});
    Suite suite;
    suite.name = fs::path(file_name).stem().string();
    if (const Value* x = document.root.find("name")) suite.name = read.text(*x, "name");
    if (const Value* x = document.root.find("source")) suite.source = read.text(*x, "source");
    suite.maps = map::maps_of(read, document.root);
    suite.figures = figures_of(read, document.root);
    const Value* cells = document.root.find("cells");
    if (!cells && !suite.maps.empty()) return suite;
    const auto* sets = cells ? std::get_if<Array>(&cells->content) : nullptr;
    if (!sets || sets->empty())
        throw SceneFileError(read.place(cells ? *cells : document.root) + ": cells: expected at least one [[cells]]");
    for (std::size_t i = 0; i < sets->size(); ++i) {
        suite.sets.push_back(set_of(read, (*sets)[i], "cells." + std::to_string(i)));
        suite.sets.back().figures = figure_facets_of(read, (*sets)[i], "cells." + std::to_string(i));
    }
    return suite;
}

Suite read_suite(const std::string& name) {
    std::error_code error;
    const fs::path shelved = library() / (name + ".toml");
    // a bare name is the library's where it has it, whatever lies where the program runs: ./NAME is a file
    const bool known = name.find('/') == std::string::npos && fs::is_regular_file(shelved, error);
    const bool file = !known && fs::is_regular_file(name, error);
    if (!file && !known)
        throw store::UsageError(store::unknown("suite", name, library_suites()) + " (neither a file nor a suite of the library)");
    const std::string path = file ? name : shelved.string();
    Suite suite = parse_suite(store::read_whole(path), path);
    // a scene's file is looked for beside the suite's, then where the program runs; a name of the library is neither
    const auto find = [&](std::string& scene) {
        if (const fs::path beside = fs::path(path).parent_path() / scene;
            fs::path(scene).is_relative() && fs::is_regular_file(beside, error))
            scene = beside.string();
    };
    for (CellSet& set : suite.sets)
        for (std::string& scene : set.scenes) find(scene);
    for (map::Map& m : suite.maps) find(m.scene);
    return suite;
}

std::vector<std::string> library_suites() {
    return toml_names(library());
}

std::vector<SuitePoint> points_of(const Suite& suite) {
    std::vector<SuitePoint> points;
    for (const CellSet& set : suite.sets)
        for (const std::string& scene : set.scenes)
            for (const int modes : set.modes) {
                compare::CompareRequest base;
                base.scene = scene;
                base.schemes = set.schemes;
                base.controls = true;
                base.rates = set.rates;
                base.modes = modes;
                base.duration = set.duration;
                base.tap_rate = set.tap_rate;
                base.reference = set.reference;
                base.reference_modes = set.reference_modes;
                base.repeats = set.repeats;
                std::vector<compare::CompareRequest> requests{base};
                const auto vary = [&requests](const std::vector<std::string>& values, const auto& apply) {
                    std::vector<compare::CompareRequest> more;
                    for (const compare::CompareRequest& r : requests)
                        for (const std::string& value : values) apply(more.emplace_back(r), value);
                    requests = std::move(more);
                };
                for (const SweptKey& k : set.sweep)
                    vary(k.values, [&k](compare::CompareRequest& r, const std::string& value) { r.set.push_back(k.key + "=" + value); });
                for (const VariedOption& o : set.options)
                    vary(o.values, [&o](compare::CompareRequest& r, const std::string& value) {
                        r.options.push_back({o.scheme, o.name, value});
                    });
                for (const compare::CompareRequest& r : requests) {
                    points.push_back({&set, r});
                    for (const compare::Element e : set.elements) points.push_back({&set, r, e});
                }
            }
    return points;
}

}  // namespace jvari::bench::suite

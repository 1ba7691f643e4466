// Population: strings drawn from ranges for a scene's keys, expanded into sets of cells, and frozen
// in files before anything runs.
//
// Windows are counted in periods of the first mode, for two reasons. A string scaled in time is the
// same problem at a scaled rate. And errors accumulate from contact to contact, with about one
// contact in a period. So strings with any pitch are equally hard. Drawn numbers are rounded to
// four digits, so that the machine's logarithm has no effect.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "analysis/sobol.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/usage.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/pitch.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::suite {

namespace {
namespace fs = std::filesystem;
using store::key;
using store::needed;

constexpr double heard = 20e3;      // [Hz]
constexpr int most_strings = 2000;  // limit for a ground

DrawnKey drawn_key(const std::string& name, const store::Entry& e) {
    const std::string expected =
        "{ from = A, to = B }, log = true beside it where equal ratios are meant, or the values to "
        "choose from";
    DrawnKey k{name, {}};
    const bool range = !e.is_array() && !e.is_text() && !e.number();
    if (!range) {
        for (const store::Entry& one : e.items()) k.choices.push_back(one.toml());
        return k;
    }
    e.only({"from", "to", "log"});
    const auto end = [&](const char* which) {
        const auto x = e.need(which).number();
        if (!x) e.refuse(expected);
        return *x;
    };
    k.from = end("from"), k.to = end("to");
    if (const auto log = e.at("log")) k.log = log->truth();
    if (!(k.from < k.to) || (k.log && !(k.from > 0))) e.refuse(expected);
    return k;
}

std::string value_at(const DrawnKey& k, double u) {
    if (!k.choices.empty())
        return k.choices[static_cast<std::size_t>(u * static_cast<double>(k.choices.size()))];
    const double x = k.log ? k.from * std::pow(k.to / k.from, u) : k.from + (k.to - k.from) * u;
    return fmt::format("{:.4g}", x);
}

// Seed of a ground, by FNV-1a over its name: adding another ground changes nothing.
std::uint64_t seed_of(int seed, const std::string& name) {
    auto hash = 0xcbf29ce484222325u ^ static_cast<std::uint64_t>(seed);
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return hash;
}

// Set of cells for a scene, with the tap of the headline errors and the duration that the
// population requests.
CellSet set_of(const Population& p, Scene scene) {
    CellSet set = p;
    if (scene.taps.empty())
        throw store::UsageError(scene.name + ": found no tap, expected one to judge by");
    scene.taps = {scene.taps.at(static_cast<std::size_t>(study::headline_of(scene).nut))};
    int below = 0;
    for (const String& s : scene.strings) below = std::max(below, modes_below(s, heard));
    scene.duration = free_from(scene) + p.periods / lowest_pitch(scene);
    for (const double multiple : p.multiples)
        set.modes.push_back(
            static_cast<int>(std::lround(std::clamp(multiple * below, 1.0, 1.0 * most_modes))));
    set.scenes = {scene.name};
    set.measure = p.measure;
    set.search = false;
    set.drawn = std::move(scene);
    return set;
}
}  // namespace

std::vector<store::Key<Ground>> ground_keys() {
    return {needed("name", &Ground::name, store::name_of_file(), "what its strings are called"),
            needed("scene", &Ground::scene, store::text(), "the scene whose keys are drawn"),
            needed("number", &Ground::number, store::whole(1, most_strings), "of strings"),
            key("draw", &Ground::draw,
                store::by_name<DrawnKey>("a table: key = { from, to, log } or values", drawn_key),
                "keys of the scene, each with a range or with values to choose from", "none")};
}

std::vector<CellSet> sets_of(const Population& p, const std::vector<Ground>& grounds) {
    std::vector<CellSet> sets;
    for (const Ground& ground : grounds) {
        if (ground.draw.size() > most_dimensions)
            throw store::UsageError(fmt::format("ground {}: found {} keys to draw, expected {}",
                                                ground.name, ground.draw.size(), most_dimensions));
        const auto points = sobol_points(static_cast<int>(ground.draw.size()), ground.number,
                                         seed_of(p.seed, ground.name));
        for (std::size_t i = 0; i < points.size(); ++i) {
            std::vector<std::string> overrides;
            for (std::size_t d = 0; d < ground.draw.size(); ++d)
                overrides.push_back(ground.draw[d].key + "=" +
                                    value_at(ground.draw[d], points[i][d]));
            const std::string name = fmt::format("{}-{:03}", ground.name, i + 1);
            overrides.push_back("name=\"" + name + "\"");
            try {
                sets.push_back(set_of(p, read_scene(ground.scene, overrides)));
            } catch (const BadScene& e) {
                throw store::UsageError(fmt::format("{}: {}", name, e.what()));
            } catch (const SceneFileError& e) {
                throw store::UsageError(fmt::format("{}: {}", name, e.what()));
            }
        }
    }
    for (const std::string& scene : p.scenes) sets.push_back(set_of(p, read_scene(scene)));
    std::set<std::string> names;
    for (const CellSet& set : sets)
        if (!names.insert(set.drawn->name).second)
            throw store::UsageError(set.drawn->name + ": found two strings of this name");
    return sets;
}

void freeze(const Suite& suite, const fs::path& folder, bool resume) {
    if (folder.empty() || !suite.population) return;
    store::make_folder(folder / "scenes");
    for (const CellSet& set : suite.sets) {
        const fs::path file = folder / "scenes" / (set.drawn->name + ".toml");
        const std::string text = write_scene(*set.drawn);
        std::error_code error;
        if (resume && fs::exists(file, error) && store::read_whole(file) != text)
            throw store::UsageError(file.string() +
                                    ": found another string than the suite draws. The population "
                                    "is frozen: choose another folder, or leave out --resume");
        store::write_fresh(file, text);
    }
}

}  // namespace jvari::bench::suite

#include "bench/map/failures.hpp"

#include <fmt/core.h>

#include <sstream>

#include "bench/map/minimise.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::map {

namespace {
namespace fs = std::filesystem;

long steps_of(const JudgedPoint& p) {
    return p.tried.record.cell.summary.steps;
}

std::string scene_text(const Reproducer& r) {
    const Trial& t = r.trial;
    std::string how = fmt::format("--scheme {} --rate {} --tap-rate {} --energy", t.scheme->name, store::text_of(t.settings.sample_rate),
                                  store::text_of(t.settings.tap_rate));
    if (t.settings.modes > 0) how += fmt::format(" --modes {}", t.settings.modes);
    for (const auto& [name, value] : t.settings.options) how += fmt::format(" --option {}={}", name, value);
    return fmt::format("# Minimised by jvari suite: {} is {} here, {}.\n# jvari run {} {}\n{}", t.scheme->name, name_of(r.expected.verdict),
                       r.expected.detail, r.file, how, write_scene(t.scene));
}

bool read_back(const fs::path& folder, const compare::Catalogue& catalogue, Reproducer& into) {
    std::error_code error;
    if (!fs::is_regular_file(folder / "index.csv", error)) return false;  // it is written last
    try {
        into = read_failures(folder, catalogue).at(0);
        return true;
    } catch (const std::exception&) {  // not whole: minimised again
        return false;
    }
}
}  // namespace

std::vector<Reproducer> reproducers_of(const MapRun& run, const compare::Catalogue& catalogue, const MapRequest& request,
                                       const store::Listener& listener) {
    std::map<std::pair<std::string, study::Verdict>, const JudgedPoint*> cheapest;
    for (const JudgedPoint& p : run.points) {
        const study::Verdict v = p.tried.judgement.verdict;
        if (v == study::Verdict::sound || v == study::Verdict::unjudged || v == study::Verdict::refused || !p.at.map->reproduce) continue;
        const JudgedPoint*& kept = cheapest[{p.at.scheme->name, v}];
        if (!kept || steps_of(p) < steps_of(*kept)) kept = &p;
    }
    std::vector<Reproducer> all;
    for (const auto& [key, point] : cheapest)
        all.push_back({fmt::format("{}-{}.toml", key.first, name_of(key.second)), trial_at(point->at), point->tried.judgement});
    store::side_by_side(std::vector<double>(all.size(), 1), request.jobs, listener, "failures", [&](std::size_t i, store::Done& done) {
        Reproducer& r = all[i];
        Trials trials(catalogue);  // nobody else's: a minimisation waits for nothing
        const std::string address = trials.plan_of(r.trial).jobs.front().id + name_of(r.expected.verdict) + request.program;
        const fs::path folder = request.folder.empty() ? fs::path() : request.folder / "points" / store::hash_of(address);
        const store::FileLock lock(folder, "minimises how " + std::string(r.trial.scheme->name) + " fails");
        if (request.resume && read_back(folder, catalogue, r)) return;
        const study::Verdict wanted = r.expected.verdict;
        r.trial = minimised(r.trial, [&](const Trial& t) { return trials(t, done).judgement.verdict == wanted; });
        r.trial.scene.name += "_minimised";
        r.expected = trials(r.trial, done).judgement;
        if (folder.empty()) return;
        write_failures(folder, {r});
    });
    return all;
}

void write_failures(const fs::path& folder, const std::vector<Reproducer>& all) {
    std::error_code error;
    fs::create_directories(folder, error);
    store::must_be_writable(folder / "index.csv");
    store::Table index;
    index.columns = {"file", "scheme", "rate", "modes", "options", "reference", "reference_modes", "outcome", "step", "detail"};
    for (const Reproducer& r : all) {
        store::write_fresh(folder / r.file, scene_text(r));
        const Settings& s = r.trial.settings;
        index.rows.push_back({r.file, r.trial.scheme->name, store::text_of(s.sample_rate), std::to_string(s.modes),
                              store::options_text(s.options), r.trial.reference, std::to_string(r.trial.reference_modes),
                              name_of(r.expected.verdict), std::to_string(r.expected.step), r.expected.detail});
    }
    store::write_fresh(folder / "index.csv", store::csv(index));
}

std::vector<Reproducer> read_failures(const fs::path& folder, const compare::Catalogue& catalogue) {
    const store::Table index = store::read_csv(store::read_whole(folder / "index.csv"));
    std::vector<Reproducer> all;
    for (std::size_t i = 0; i < index.rows.size(); ++i) {
        Reproducer r{index.at(i, "file"),
                     {&catalogue.find(index.at(i, "scheme")),
                      {},
                      {},
                      index.at(i, "reference"),
                      static_cast<int>(index.number(i, "reference_modes"))},
                     {}};
        r.trial.scene = read_scene((folder / r.file).string());
        Settings& s = r.trial.settings;
        s.sample_rate = index.number(i, "rate");
        s.tap_rate = row_rate(s.sample_rate);
        s.modes = static_cast<int>(index.number(i, "modes"));
        std::istringstream options(index.at(i, "options"));
        for (std::string word; options >> word;) s.options.emplace_back(word.substr(0, word.find('=')), word.substr(word.find('=') + 1));
        r.expected = {study::verdict_named(index.at(i, "outcome")), index.at(i, "detail"), static_cast<long>(index.number(i, "step"))};
        all.push_back(std::move(r));
    }
    return all;
}

}  // namespace jvari::bench::map

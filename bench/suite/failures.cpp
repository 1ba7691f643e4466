#include "bench/suite/maps.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <utility>
#include <vector>

#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "scenes/reduction.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/grid/finite_difference.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::suite {

namespace {
namespace fs = std::filesystem;

long steps_of(const JudgedPoint& p) { return p.tried.record.cell.summary.steps; }

std::string scene_text(const Reproducer& r) {
    const Trial& t = r.trial;
    return fmt::format(
        "# Minimised by jvari suite: {} is {} here, {}.\n# jvari run {} {} --energy\n{}",
        t.scheme->name, name_of(r.expected.verdict), r.expected.detail, r.file,
        compare::arguments_of(*t.scheme, t.settings), write_scene(t.scene));
}

bool read_back(const fs::path& folder, const compare::Catalogue& catalogue, Reproducer& into) {
    std::error_code error;
    if (!fs::is_regular_file(folder / "index.csv", error)) return false;  // written last
    try {
        into = read_failures(folder, catalogue).at(0);
        return true;
    } catch (const std::exception&) {  // incomplete: minimised again
        return false;
    }
}
}  // namespace

std::vector<Reproducer> reproducers_of(const MapRun& run, const compare::Catalogue& catalogue,
                                       const MapRequest& request, const store::Listener& listener) {
    std::map<std::pair<std::string, study::Verdict>, const JudgedPoint*> cheapest;
    for (const JudgedPoint& p : run.points) {
        const study::Verdict v = p.tried.judgement.verdict;
        if (study::is_stable(v) || v == study::Verdict::unjudged || !p.tried.record.cell.ran() ||
            !p.at.map->reproduce)
            continue;
        const JudgedPoint*& kept = cheapest[{p.at.scheme->name, v}];
        if (!kept || steps_of(p) < steps_of(*kept)) kept = &p;
    }
    std::vector<Reproducer> all;
    for (const auto& [key, point] : cheapest)
        all.push_back({fmt::format("{}-{}.toml", key.first, name_of(key.second)),
                       trial_at(point->at), point->tried.judgement});
    store::side_by_side(
        std::vector<double>(all.size(), 1), request.jobs, listener, "failures",
        [&](std::size_t i, store::Done& done) {
            Reproducer& r = all[i];
            Trials trials(catalogue);  // separate Trials, so that no minimisation waits for another
            const std::string address = trials.plan_of(r.trial).jobs.front().id +
                                        name_of(r.expected.verdict) + request.program;
            const fs::path folder = request.folder.empty()
                                        ? fs::path()
                                        : request.folder / "points" / store::hash_of(address);
            const store::FileLock lock(
                folder, "minimises how " + std::string(r.trial.scheme->name) + " fails",
                done.may_wait());
            if (lock.elsewhere()) return done.postpone();
            if (request.resume && read_back(folder, catalogue, r)) return;
            const study::Verdict wanted = r.expected.verdict;
            r.trial = minimised(
                r.trial, [&](const Trial& t) { return trials(t).judgement.verdict == wanted; });
            r.trial.scene.name += "_minimised";
            r.expected = trials(r.trial).judgement;
            if (folder.empty()) return;
            write_failures(folder, {r});
        });
    return all;
}

void write_failures(const fs::path& folder, const std::vector<Reproducer>& all) {
    store::make_folder(folder);
    store::must_be_writable(folder / "index.csv");
    store::Table index;
    index.columns = {"file",      "scheme",          "rate",    "modes", "options",
                     "reference", "reference_modes", "outcome", "step",  "detail"};
    for (const Reproducer& r : all) {
        store::write_fresh(folder / r.file, scene_text(r));
        const Settings& s = r.trial.settings;
        index.rows.push_back({r.file, r.trial.scheme->name, s.sample_rate, s.modes,
                              store::options_text(s.options), r.trial.reference,
                              r.trial.reference_modes, name_of(r.expected.verdict), r.expected.step,
                              r.expected.detail});
    }
    store::write_fresh(folder / "index.csv", store::csv(index));
}

std::vector<Reproducer> read_failures(const fs::path& folder, const compare::Catalogue& catalogue) {
    const store::Table index = store::read_csv(store::read_whole(folder / "index.csv"));
    std::vector<Reproducer> all;
    for (std::size_t i = 0; i < index.rows.size(); ++i) {
        Reproducer r{index.text(i, "file"),
                     {&catalogue.find(index.text(i, "scheme")),
                      {},
                      {},
                      index.text(i, "reference"),
                      static_cast<int>(index.number(i, "reference_modes"))},
                     {}};
        r.trial.scene = read_scene((folder / r.file).string());
        Settings& s = r.trial.settings;
        s.sample_rate = index.number(i, "rate");
        s.tap_rate = row_rate(s.sample_rate);
        s.modes = static_cast<int>(index.number(i, "modes"));
        s.options = store::options_in(index.text(i, "options"));
        r.expected = {study::verdict_named(index.text(i, "outcome")), index.text(i, "detail"),
                      static_cast<long>(index.number(i, "step"))};
        all.push_back(std::move(r));
    }
    return all;
}

namespace {
bool still(const Fails& fails, const Trial& t) {
    try {
        validate(t.scene);
        return fails(t);
    } catch (const std::exception&) { return false; }
}

// True for the parts to remove, in turn: large parts go first. One string and its excitation stay.
bool is_removal(const Reduction& r) {
    return r.part != Part::contact_stiffness && r.part != Part::footprint &&
           r.part != Part::damping_term && r.part != Part::tap;
}

// Scene with only the first of the map's taps, because the judgement uses its own taps.
Scene heard_at_one_point(const Scene& scene) {
    Scene one = listened(scene);
    one.taps.resize(1);
    return one;
}

bool remove_what_can_be(Trial& t, const Fails& fails) {
    bool smaller = false;
    std::vector<Reduction> left = reductions_of(t.scene);
    while (!left.empty()) {
        const Reduction r = std::move(left.back());
        left.pop_back();
        if (!is_removal(r)) continue;
        Trial x = t;
        r.apply(x.scene);
        // taps went with their string
        if (x.scene.taps.empty()) x.scene = heard_at_one_point(x.scene);
        if (!still(fails, x)) continue;
        t = std::move(x);
        left = reductions_of(t.scene);  // the other reductions may have new places
        smaller = true;
    }
    return smaller;
}

// Smallest n with `fails_with` on a descent by n/2, n/4, ... 1.
long shortened(long n, long least, const std::function<bool(long)>& fails_with) {
    for (long cut = n / 2; cut >= 1; cut = std::min(cut / 2, n / 2))
        while (n - cut >= least && fails_with(n - cut)) n -= cut;
    return n;
}

// False for a grid: its modes would only reduce the reference's.
bool has_modes(const Trial& t) {
    const auto five = compare::dofs_with(5, *t.scheme, t.scene, t.settings),
               six = compare::dofs_with(6, *t.scheme, t.scene, t.settings);
    return five && six && five != six;
}

bool shorten(Trial& t, const Fails& fails) {
    bool shorter = false;
    const auto try_out = [&](long& value, long least,
                             const std::function<void(Trial&, long)>& apply) {
        const long n = shortened(value, least, [&](long k) {
            Trial x = t;
            apply(x, k);
            return still(fails, x);
        });
        if (n == value) return;
        apply(t, value = n);
        shorter = true;
    };
    long rows = std::lround(t.scene.duration * t.settings.tap_rate);
    try_out(rows, 1, [](Trial& x, long k) {
        x.scene.duration = static_cast<double>(k) / x.settings.tap_rate;
    });
    if (t.settings.modes > 0 && has_modes(t)) {
        long modes = t.settings.modes;
        try_out(modes, 1, [](Trial& x, long k) { x.settings.modes = static_cast<int>(k); });
    }
    for (std::size_t i = 0; i < t.settings.options.size(); ++i)
        if (t.settings.options[i].first == grid_option.name) {
            long intervals = std::atol(t.settings.options[i].second.c_str());
            try_out(intervals, 5,
                    [i](Trial& x, long k) { x.settings.options[i].second = std::to_string(k); });
        }
    return shorter;
}
}  // namespace

Trial minimised(Trial t, const Fails& fails) {
    if (t.settings.modes == 0 && has_modes(t)) {  // the default, made explicit
        Trial explicit_modes = t;
        explicit_modes.settings.modes = modes_for(t.scene, t.settings);
        if (still(fails, explicit_modes)) t = std::move(explicit_modes);
    }
    t.scene = heard_at_one_point(t.scene);
    for (bool smaller = true; smaller;) {
        // removing first, while duration and modes are still sufficient to fail
        smaller = remove_what_can_be(t, fails);
        smaller = shorten(t, fails) || smaller;
    }
    return t;
}

}  // namespace jvari::bench::suite

#include "bench/suite/maps.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <map>
#include <utility>
#include <vector>

#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/machine.hpp"
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

long steps_of(const MapPoint& p) { return p.record.cell.summary.steps; }

std::string scene_text(const Failure& f) {
    return fmt::format(
        "# Minimised by jvari suite: {} is {} here, {}.\n# jvari run {} {} --energy\n{}",
        f.scheme->name, name_of(f.expected.verdict), f.expected.detail, f.file,
        compare::arguments_of(*f.scheme, f.settings), write_scene(f.scene));
}

bool read_back(const fs::path& folder, const compare::Catalogue& catalogue, Failure& into) {
    std::error_code error;
    if (!fs::is_regular_file(folder / "index.csv", error)) return false;  // written last
    try {
        into = read_failures(folder, catalogue).at(0);
        return true;
    } catch (const std::exception&) {  // incomplete: minimised again
        return false;
    }
}

// Cheapest failure of each scheme and kind.
std::vector<Failure> cheapest_of(const MapRun& run) {
    std::map<std::pair<std::string, study::Verdict>, const MapPoint*> cheapest;
    for (const MapPoint& p : run.points) {
        const study::Verdict v = p.judgement.verdict;
        if (study::is_stable(v) || v == study::Verdict::unjudged || !p.record.cell.ran() ||
            !run.map_of(p).reproduce)
            continue;
        const MapPoint*& kept = cheapest[{p.job->cell.scheme->name, v}];
        if (!kept || steps_of(p) < steps_of(*kept)) kept = &p;
    }
    std::vector<Failure> all;
    for (const auto& [key, p] : cheapest)
        all.push_back({fmt::format("{}-{}.toml", key.first, name_of(key.second)),
                       p->job->cell.scheme, p->job->point->scene, p->job->cell.settings,
                       run.map_of(*p).reference, run.map_of(*p).reference_modes.value_or(0),
                       p->judgement});
    return all;
}
}  // namespace

study::Plan plan_of(const Failure& f, const compare::Catalogue& catalogue,
                    const std::string& program) {
    study::Plan plan;
    plan.points.push_back(
        judged_point(catalogue, f.scene, f.settings, f.reference, f.reference_modes));
    for (study::ReferenceChoice& c : plan.points.front().references) c.kept = false;
    plan.jobs.push_back(judged_job(*f.scheme, plan.points.front(), f.settings));
    study::address(plan, program);
    return plan;
}

study::Judgement outcome_of(const Failure& f, const compare::Catalogue& catalogue,
                            study::References& references) {
    const study::Plan plan = plan_of(f, catalogue, "{}");
    const study::Job& job = plan.jobs.front();
    if (job.judged) references.hold(*job.point);
    study::Kept nowhere;
    const auto ended = [](long, long) { store::throw_if_cancelled(); };
    return MapPoint(job, *study::record_of(job, references, nowhere, ended)).judgement;
}

std::vector<Failure> failures_of(const fs::path& cells, bool resume, const MapRun& run,
                                 const compare::Catalogue& catalogue,
                                 const std::vector<std::string>& plugins, int jobs,
                                 const store::Listener& listener) {
    const std::string program = store::program_identity(plugins);
    std::vector<Failure> all = cheapest_of(run);
    store::side_by_side(
        std::vector<double>(all.size(), 1), jobs, listener, "failures",
        [&](std::size_t i, store::Done& done) {
            Failure& f = all[i];
            const study::Verdict wanted = f.expected.verdict;
            const std::string address =
                plan_of(f, catalogue, program).jobs.front().id + name_of(wanted);
            const fs::path folder = cells.empty() ? cells : cells / store::hash_of(address);
            const store::FileLock lock(
                folder, "minimises how " + std::string(f.scheme->name) + " fails", done.may_wait());
            if (lock.elsewhere()) return done.postpone();
            if (resume && read_back(folder, catalogue, f)) return;
            // separate references, so that no minimisation waits for another
            study::References references;
            f = minimised(f, [&](const Failure& x) {
                return outcome_of(x, catalogue, references).verdict == wanted;
            });
            f.scene.name += "_minimised";
            f.expected = outcome_of(f, catalogue, references);
            if (!folder.empty()) write_failures(folder, {f});
        });
    return all;
}

void write_failures(const fs::path& folder, const std::vector<Failure>& all) {
    store::make_folder(folder);
    store::must_be_writable(folder / "index.csv");
    store::Table index;
    index.columns = {"file",      "scheme",          "rate",    "modes", "options",
                     "reference", "reference_modes", "outcome", "step",  "detail"};
    for (const Failure& f : all) {
        store::write_fresh(folder / f.file, scene_text(f));
        const Settings& s = f.settings;
        index.rows.push_back({f.file, f.scheme->name, s.sample_rate, s.modes,
                              store::options_text(s.options), f.reference, f.reference_modes,
                              name_of(f.expected.verdict), f.expected.step, f.expected.detail});
    }
    store::write_fresh(folder / "index.csv", store::csv(index));
}

std::vector<Failure> read_failures(const fs::path& folder, const compare::Catalogue& catalogue) {
    const store::Table index = store::read_csv(store::read_whole(folder / "index.csv"));
    std::vector<Failure> all;
    for (std::size_t i = 0; i < index.rows.size(); ++i) {
        const auto whole = [&index, i](const char* name) {
            return static_cast<int>(index.number(i, name));
        };
        const double rate = index.number(i, "rate");
        const std::string file = index.text(i, "file");
        all.push_back(
            {file,
             &catalogue.find(index.text(i, "scheme")),
             read_scene((folder / file).string()),
             {rate, row_rate(rate), whole("modes"), store::options_in(index.text(i, "options"))},
             index.text(i, "reference"),
             whole("reference_modes"),
             {study::verdict_named(index.text(i, "outcome")), index.text(i, "detail"),
              whole("step")}});
    }
    return all;
}

namespace {
bool still(const Fails& fails, const Failure& f) {
    try {
        validate(f.scene);
        return fails(f);
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

bool remove_what_can_be(Failure& f, const Fails& fails) {
    bool smaller = false;
    std::vector<Reduction> left = reductions_of(f.scene);
    while (!left.empty()) {
        const Reduction r = std::move(left.back());
        left.pop_back();
        if (!is_removal(r)) continue;
        Failure x = f;
        r.apply(x.scene);
        // taps went with their string
        if (x.scene.taps.empty()) x.scene = heard_at_one_point(x.scene);
        if (!still(fails, x)) continue;
        f = std::move(x);
        left = reductions_of(f.scene);  // the other reductions may have new places
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
bool has_modes(const Failure& f) {
    const auto five = compare::dofs_with(5, *f.scheme, f.scene, f.settings),
               six = compare::dofs_with(6, *f.scheme, f.scene, f.settings);
    return five && six && five != six;
}

bool shorten(Failure& f, const Fails& fails) {
    bool shorter = false;
    const auto try_out = [&](long& value, long least,
                             const std::function<void(Failure&, long)>& apply) {
        const long n = shortened(value, least, [&](long k) {
            Failure x = f;
            apply(x, k);
            return still(fails, x);
        });
        if (n == value) return;
        apply(f, value = n);
        shorter = true;
    };
    long rows = std::lround(f.scene.duration * f.settings.tap_rate);
    try_out(rows, 1, [](Failure& x, long k) {
        x.scene.duration = static_cast<double>(k) / x.settings.tap_rate;
    });
    if (f.settings.modes > 0 && has_modes(f)) {
        long modes = f.settings.modes;
        try_out(modes, 1, [](Failure& x, long k) { x.settings.modes = static_cast<int>(k); });
    }
    for (std::size_t i = 0; i < f.settings.options.size(); ++i)
        if (f.settings.options[i].first == grid_option.name) {
            long intervals = std::atol(f.settings.options[i].second.c_str());
            try_out(intervals, 5,
                    [i](Failure& x, long k) { x.settings.options[i].second = std::to_string(k); });
        }
    return shorter;
}
}  // namespace

Failure minimised(Failure f, const Fails& fails) {
    if (f.settings.modes == 0 && has_modes(f)) {  // the default, made explicit
        Failure explicit_modes = f;
        explicit_modes.settings.modes = modes_for(f.scene, f.settings);
        if (still(fails, explicit_modes)) f = std::move(explicit_modes);
    }
    f.scene = heard_at_one_point(f.scene);
    for (bool smaller = true; smaller;) {
        // removing first, while duration and modes are still sufficient to fail
        smaller = remove_what_can_be(f, fails);
        smaller = shorten(f, fails) || smaller;
    }
    return f;
}

}  // namespace jvari::bench::suite

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <tuple>

#include "bench/store/encoding.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/suite/maps.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::suite {

namespace {
constexpr const char* nyquist = "nyquist";

double nyquist_margin(const Scene& scene, const Settings& settings) {
    double fastest = 0;  // largest omega^2 over the modes of all strings [rad^2/s^2]
    for (const String& s : scene.strings) {
        const Modes modes = modes_of(s, modes_for(s, settings));
        fastest = std::max(fastest, omega_squared_damped(modes.omega0.back(), modes.sigma.back()));
    }
    return 0.5 * settings.sample_rate * 2 * std::numbers::pi / std::sqrt(fastest) - 1;
}

// Margin: positive on the sound side, 0 on the boundary; NaN if the theory does not cover the
// scheme.
double theory_margin(const std::string& theory, const study::Job& job) {
    const auto& [scheme, settings] = std::tie(*job.cell.scheme, job.cell.settings);
    if (theory == nyquist) return nyquist_margin(job.point->scene, settings);
    return scheme.limit.name && theory == scheme.limit.name
               ? margin_of(scheme, job.point->scene, settings)
               : nan;
}

// Kind of motion that the theory describes: "lasting contact: where the string parts from the
// barrier the boundary is elsewhere".
std::string motion_of(const std::string& theory) {
    if (theory == "grid_limit") return "any motion: it is of the grid alone";
    if (theory == "penalty_limit")
        return "lasting contact; where the string parts from the barrier, failures were seen to "
               "begin 16 to 71 % off";
    return "any motion: it is of the highest mode alone";
}

// Set of a single cell: a point of a map, moved to another x.
CellSet cell_at(const MapRun& run, const MapPoint& p, double x) {
    CellSet cell = run.map_of(p);
    const auto& swept = p.job->point->swept;
    cell.schemes = {p.job->cell.scheme->name};
    for (std::size_t k = 0; k < swept.size(); ++k) cell.sweep[k].values = {swept[k].second};
    SweptKey& axis = cell.sweep.front();
    axis.values = {number_text(x)};
    return cell;
}

// Boundary from theory: the change of sign in the margin along the axis, found by bisection. The
// search starts at the first point that the theory covers.
double theory_along(const MapRun& run, const MapPoint& row, const compare::Catalogue& catalogue) {
    const CellSet& map = run.map_of(row);
    const SweptKey& axis = map.sweep.front();
    if (map.theory.empty()) return nan;
    const auto side = [&](double x) {
        const std::vector<CellSet> one{cell_at(run, row, x)};
        const study::Plan plan = plan_of(one, catalogue, {});
        const double margin = theory_margin(map.theory, plan.jobs.front());
        return std::isnan(margin) ? study::Verdict::refused
               : margin > 0       ? study::Verdict::sound
                                  : study::Verdict::diverged;
    };
    const std::vector<double>& at = axis.at;
    std::size_t first = 0;
    while (first + 1 < at.size() && side(at[first]) == study::Verdict::refused) ++first;
    const Bracket ends{at[first], at.back(), side(at[first]), side(at.back())};
    if (ends.at_low == ends.at_high || ends.at_low == study::Verdict::refused ||
        ends.at_high == study::Verdict::refused)
        return nan;
    return bisect(ends, 60, axis.whole, side).middle();
}

bool same_row(const MapPoint& p, const MapPoint& q) {
    const auto y = [](const MapPoint& of) { return std::span(of.job->point->swept).subspan(1); };
    return p.job->set == q.job->set && p.job->cell.scheme == q.job->cell.scheme &&
           std::ranges::equal(y(p), y(q));
}

// Compares the theory with the nearest boundary of stability in each row.
void compare_with_theory(MapRun& run, const compare::Catalogue& catalogue) {
    std::vector<Boundary>& all = run.boundaries;
    for (auto first = all.begin(), end = first; first != all.end(); first = end) {
        end = std::find_if(first, all.end(), [first](const Boundary& b) {
            return !same_row(*b.below, *first->below);
        });
        const double theory = theory_along(run, *first->below, catalogue);
        const auto distance = [theory](const Boundary& b) {
            const auto& [low, high, at_low, at_high] = b.between;
            if (study::is_stable(at_low) == study::is_stable(at_high)) return HUGE_VAL;
            return std::abs(b.between.middle() - theory);
        };
        const auto nearest = std::min_element(
            first, end,
            [&](const Boundary& a, const Boundary& b) { return distance(a) < distance(b); });
        if (distance(*nearest) < HUGE_VAL) nearest->theory = theory;
    }
}

// Changes of outcome between neighbours of a row.
std::vector<Boundary> changes_in(const MapRun& run) {
    std::vector<Boundary> changes;
    for (std::size_t i = 0; i + 1 < run.points.size(); ++i) {
        const MapPoint &p = run.points[i], &q = run.points[i + 1];
        if (run.map_of(p).sweep.front().at.empty() || !same_row(p, q)) continue;
        const auto x = [](const MapPoint& of) { return store::number_of(swept_at(of, 0).second); };
        if (p.judgement.verdict != q.judgement.verdict)
            changes.push_back({&p, {x(p), x(q), p.judgement.verdict, q.judgement.verdict}});
    }
    return changes;
}

// Bisects all boundaries in rounds: the middles of a round are cells like others.
void refine(const std::filesystem::path& folder, bool resume, MapRun& run,
            const compare::Catalogue& catalogue, const std::vector<std::string>& plugins,
            study::References& references, int jobs, const store::Listener& listener) {
    for (int round = 0;; ++round) {
        std::vector<CellSet> cells;
        std::vector<std::pair<Boundary*, double>> middles;
        for (Boundary& b : run.boundaries) {
            const CellSet& map = run.map_of(*b.below);
            const auto x = middle_of(b.between, map.sweep.front().whole);
            if (round >= map.refine || !x) continue;
            cells.push_back(cell_at(run, *b.below, *x));
            middles.emplace_back(&b, *x);
        }
        if (cells.empty()) return;
        study::Plan plan = plan_of(cells, catalogue, plugins);
        if (resume) study::keep_references_in(plan, folder.parent_path() / "references");
        for (const study::Job& job : plan.jobs)
            if (job.judged) references.hold(*job.point);
        study::Kept keep{folder, resume};
        study::Study study = study::run(plan, references, keep, jobs, listener);
        for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
            const MapPoint p(plan.jobs[i], std::move(study.records[i]));
            auto& [boundary, x] = middles[static_cast<std::size_t>(p.job->set)];
            narrow(boundary->between, x, p.judgement.verdict);
        }
        run.ran += study.ran;
        run.read_back += study.read_back;
    }
}
}  // namespace

std::optional<double> middle_of(const Bracket& b, bool whole) {
    const double between = b.low > 0 ? std::sqrt(b.low) * std::sqrt(b.high) : b.middle(),
                 middle = whole ? std::round(between) : between;
    return middle > b.low && middle < b.high ? std::optional(middle) : std::nullopt;
}

void narrow(Bracket& b, double middle, study::Verdict v) {
    const bool stable = study::is_stable(b.at_low), ends = stable != study::is_stable(b.at_high);
    const bool lower = v == b.at_low || (v != b.at_high && ends && study::is_stable(v) == stable);
    if (lower) b.low = middle, b.at_low = v;
    else b.high = middle, b.at_high = v;
}

MapRun run_maps(const std::filesystem::path& folder, bool resume, const std::vector<CellSet>& maps,
                const study::Plan& plan, const compare::Catalogue& catalogue,
                const std::vector<std::string>& plugins, int jobs,
                const store::Listener& listener) {
    MapRun run{&maps};
    if (maps.empty()) return run;
    study::References references(plan.jobs);
    for (const study::Job& job : plan.jobs)  // kept for the bisections
        if (job.judged && maps[static_cast<std::size_t>(job.set)].refine > 0)
            references.hold(*job.point);
    study::Kept keep{folder, resume};
    study::Study study = study::run(plan, references, keep, jobs, listener);
    run.ran = study.ran;
    run.read_back = study.read_back;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i)
        run.points.emplace_back(plan.jobs[i], std::move(study.records[i]));
    std::map<std::pair<int, const Descriptor*>, std::size_t> order;
    for (const MapPoint& p : run.points)
        order.try_emplace({p.job->set, p.job->cell.scheme}, order.size());
    std::ranges::stable_sort(run.points, {}, [&order](const MapPoint& p) {
        return order.at({p.job->set, p.job->cell.scheme});
    });
    run.boundaries = changes_in(run);
    refine(folder, resume, run, catalogue, plugins, references, jobs, listener);
    compare_with_theory(run, catalogue);
    return run;
}

std::vector<std::string> theories() {
    std::vector<std::string> names{nyquist};
    for (const Descriptor& d : schemes())
        if (d.limit.name && std::find(names.begin(), names.end(), d.limit.name) == names.end())
            names.emplace_back(d.limit.name);
    return names;
}

store::Table boundaries_table(const MapRun& run, const std::vector<Failure>& failures) {
    store::Table t{{"map", "scheme", "x_key", "y_key", "y", "between", "x_low", "x_high", "theory",
                    "relative_difference", "reproducer", "theory_holds_for"},
                   {}};
    for (const Boundary& b : run.boundaries) {
        const CellSet& map = run.map_of(*b.below);
        const Descriptor* scheme = b.below->job->cell.scheme;
        const std::string& x_key = swept_at(*b.below, 0).first;
        const auto& [y_key, y] = swept_at(*b.below, 1);
        std::string file;
        for (const study::Verdict side : {b.between.at_low, b.between.at_high})
            for (const Failure& f : failures)
                if (map.reproduce && f.scheme == scheme && f.expected.verdict == side)
                    file = "failures/" + f.file;
        t.rows.push_back(
            {map.name, scheme->name, x_key, y_key, store::Field::as_written(y),
             fmt::format("{}|{}", name_of(b.between.at_low), name_of(b.between.at_high)),
             b.between.low, b.between.high, b.theory, b.relative_difference(), file,
             std::isnan(b.theory) ? "" : motion_of(map.theory)});
    }
    return t;
}

std::string maps_text(const MapRun& run) {
    std::string text;
    for (auto p = run.points.begin(), end = p; p != run.points.end(); p = end) {
        std::map<study::Verdict, int> count;
        const study::Job& first = *p->job;
        for (; end != run.points.end() && end->job->set == first.set &&
               end->job->cell.scheme == first.cell.scheme;
             ++end)
            ++count[end->judgement.verdict];
        text += fmt::format("  {:<28} {:<42}", run.map_of(*p).name, first.cell.scheme->name);
        for (const auto& [verdict, n] : count) text += fmt::format(" {} {}", name_of(verdict), n);
        text += "\n";
    }
    for (const Boundary& b : run.boundaries) {
        if (std::isnan(b.theory)) continue;
        const auto& [y_key, y] = swept_at(*b.below, 1);
        text += fmt::format(
            "  {:<28} {:<42} {}|{} at {} = {:.5g}{}{}, theory {:.5g}: {:+.2g} %\n    theory holds "
            "for {}\n",
            run.map_of(*b.below).name, b.below->job->cell.scheme->name, name_of(b.between.at_low),
            name_of(b.between.at_high), swept_at(*b.below, 0).first, b.between.middle(),
            y.empty() ? "" : ", " + y_key + " = ", y, b.theory, 100 * b.relative_difference(),
            motion_of(run.map_of(*b.below).theory));
    }
    return text + fmt::format("{} points, {} boundaries: {} run, {} read back\n", run.points.size(),
                              run.boundaries.size(), run.ran, run.read_back);
}

}  // namespace jvari::bench::suite

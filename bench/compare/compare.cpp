#include "bench/compare/compare.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/compare/compare_plan.hpp"
#include "bench/compare/needed_cells.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "reference/agreement.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::compare {

namespace {
using KnownOf = std::map<const study::Point*, study::References::Of>;

std::string certify_command(const CompareRequest& r, const Comparison& c) {  // what would certify this comparison's reference
    std::string text = "jvari certify " + r.scene;
    if (r.duration) text += fmt::format(" --duration {:.6g}", *r.duration);
    if (c.reference.settings.tap_rate != 44100) text += fmt::format(" --tap-rate {:.12g}", c.reference.settings.tap_rate);
    for (const std::string& set : r.set) text += " --set " + set;
    return text;
}

// What of a comparison is known before a cell runs; messages of its reference.
void describe(Comparison& c, const CompareRequest& request, const study::References::Of& known, const store::Listener& listener) {
    const study::Reference& reference = known.truth->reference;
    c.horizon = known.truth->horizon;
    c.reference = reference.choice;
    c.reference_summary = study::summary_of(*c.reference.scheme, c.scene(), c.reference.settings, reference.run);
    c.against = known.against();
    c.reference_sound = store::sound_of(reference.run.trace.column(c.headline.nut), reference.run.trace.tap_rate);
    if (!c.reference.note.empty()) listener.note(c.reference.note);
    if (!c.against.trust.any())
        listener.note(
            c.reference.oversampled
                ? fmt::format("the uncertainty of {} is unknown: {}", c.reference.name(), c.against.trust.missing)
                : fmt::format(
                      "the uncertainty of {} is unknown: twice its modes were not run, and there is no certificate. To make one: {}",
                      c.reference.name(), certify_command(request, c)));
    if (reference.run.status.outcome != Outcome::ok)
        listener.note(fmt::format("the reference {} {} after {:.6g} s: later windows have no error", c.reference.scheme->name,
                                  name_of(reference.run.status.outcome), c.reference_summary.duration));
}

// Errors of the windows that a shorter run covers; of the whole run nothing is known.
study::Errors covered_by(study::Errors errors, double window) {
    for (auto& tap : errors)
        for (std::size_t k = 0; k < study::measures().size(); ++k)
            if (!(study::measures()[k].window <= window)) tap[k] = store::nan;
    return errors;
}

// Runs all cells over the headline's window and marks those that are needed.
std::vector<study::Cell> search(const Comparison& c, const KnownOf& known, int threads, const store::Listener& listener) {
    Scene shown = c.scene();
    shown.duration = std::min(shown.duration, study::headline_window(shown.duration));
    const bool shorter = shown.duration < c.scene().duration;
    std::vector<study::Cell> tried;
    std::vector<double> sizes;
    for (const study::Job& job : c.plan.jobs) {
        tried.push_back(job.cell);
        sizes.push_back(std::max(job.cell.settings.sample_rate, 44100.0) * std::max(1, job.cell.settings.modes));
    }
    std::vector<double> errors(tried.size(), HUGE_VAL);
    store::side_by_side(
        sizes, threads, listener, "search",
        [&](std::size_t i, store::Done& done) {
            const Trace& reference = known.at(c.plan.jobs[i].point).truth->reference.run.trace;
            try {
                const Trace trace = study::run_cell(
                    tried[i], shown, [&done](long rows, long of) { done = static_cast<double>(rows) / static_cast<double>(of); });
                tried[i].errors = covered_by(study::errors_of(trace, reference), shorter ? shown.duration : HUGE_VAL);
                if (tried[i].reason.empty())
                    errors[i] = relative_difference(trace.column(c.headline.nut), reference.column(c.headline.nut), reference.tap_rate,
                                                    shown.duration);
            } catch (const std::exception& e) {
                study::fail(tried[i], e);
            }
        },
        [&](std::size_t i) { return study::what_of(c.plan.jobs[i]); });
    const std::size_t window = shown.duration >= 50e-3 ? 1 : shown.duration >= 10e-3 ? 0 : 2;
    mark_needed(tried, errors, c.against.trust.of_scene(static_cast<std::size_t>(c.headline.nut), window));
    return tried;
}

// Of the cells that were sought those that are needed run whole, and the others stay as the search left them. What was sought and cannot be
// made goes.
void run(Comparison& c, study::References& references, const KnownOf& known, std::vector<study::Cell> tried, study::Kept& keep, int threads,
         const store::Listener& listener) {
    std::map<const study::Point*, study::Against> against;  // references go with the last job that needs them
    for (const auto& [point, of] : known) against[point] = of.against();
    study::Plan whole, all;
    std::vector<bool> needed;
    std::vector<study::Record> records;
    for (std::size_t i = 0; i < c.plan.jobs.size(); ++i) {
        const study::Cell& cell = tried[i];
        const bool run = cell.ran() && cell.needed;
        if (!run) references.release(*c.plan.jobs[i].point);
        if (!cell.ran() && cell.added) continue;
        needed.push_back(run);
        all.jobs.push_back(c.plan.jobs[i]);
        if (run) whole.jobs.push_back(c.plan.jobs[i]);
    }
    study::Study outcome = study::run(whole, references, keep, threads, listener);
    std::size_t next = 0;
    for (std::size_t i = 0, k = 0; i < c.plan.jobs.size(); ++i) {
        if (!tried[i].ran() && tried[i].added) continue;
        if (needed[k++]) records.push_back(std::move(outcome.records[next++]));
        else records.push_back({tried[i], against.at(c.plan.jobs[i].point), {}, {}});
    }
    outcome.records = std::move(records);
    c.outcome = std::move(outcome);
    c.plan.jobs = std::move(all.jobs);
}
}  // namespace

Comparison compare(const CompareRequest& request, const Catalogue& catalogue, const store::Listener& listener) {
    study::Kept nowhere;
    return compare(request, catalogue, listener, nowhere);
}

Comparison compare(const CompareRequest& request, const Catalogue& catalogue, const store::Listener& listener, study::Kept& keep) {
    Comparison c;
    const Scene scene = load_scene(request);
    note_scene(scene, listener);
    c.headline = study::headline_of(scene);
    for (const Plan& plan : plans_of(request, catalogue, scene)) {
        for (const std::string& note : plan.notes) listener.note(note);
        study::Point& point = c.plan.points.emplace_back();
        point.scene = scene;
        point.taps = scene.taps.size();
        point.references = plan.references;
        point.truth_modes = request.reference_modes;
        for (const study::Cell& cell : plan.cells) {
            study::Job job{&point, cell};
            job.sounds = true;
            job.repeats = request.repeats;
            c.plan.jobs.push_back(job);
        }
    }
    std::vector<std::string> plugins;
    for (const Guest* g : guests()) plugins.push_back(g->path);
    study::address(c.plan, store::program_identity(plugins));

    study::References references(c.plan.jobs);
    KnownOf known;
    for (const study::Point& point : c.plan.points) {
        known[&point] = references.make(point, request.jobs, listener);
        if (!known[&point].truth) throw Refusal(known[&point].refused);
    }
    describe(c, request, known.at(&c.plan.points.front()), listener);
    std::vector<study::Cell> tried;
    for (const study::Job& job : c.plan.jobs) {
        tried.push_back(job.cell);
        c.searched = c.searched || job.cell.searched;
    }
    if (c.searched) tried = search(c, known, request.jobs, listener);
    run(c, references, known, std::move(tried), keep, request.jobs, listener);
    return c;
}

}  // namespace jvari::bench::compare

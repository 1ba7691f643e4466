#include "bench/compare/compare.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bench/compare/bound.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/study/judgement.hpp"
#include "scenes/excitation.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::compare {

namespace {
// Command that would certify this comparison's reference.
std::string certify_command(const CompareRequest& r, const Comparison& c) {
    std::string text = "jvari certify " + r.scene;
    if (r.duration) text += fmt::format(" --duration {:.6g}", *r.duration);
    if (c.reference.settings.tap_rate != 44100)
        text += fmt::format(" --tap-rate {:.12g}", c.reference.settings.tap_rate);
    for (const std::string& set : r.set) text += " --set " + set;
    return text;
}

// Fills in the facts about the reference that are known before a cell runs, and gives its messages.
void describe(Comparison& c, const CompareRequest& request, const study::References::Of& known,
              const store::Listener& listener) {
    const study::Reference& reference = known.truth->reference;
    c.horizon = known.truth->horizon;
    c.reference = reference.choice;
    c.reference_summary =
        study::summary_of(*c.reference.scheme, c.scene(), c.reference.settings, reference.run);
    c.against = known.against();
    c.reference_sound =
        store::sound_of(reference.run.trace.column(c.headline.nut), reference.run.trace.tap_rate);
    if (!c.reference.note.empty()) listener.note(c.reference.note);
    if (const std::string untouched = untouched_text(c.scene(), c.reference_summary);
        !untouched.empty())
        listener.warn(untouched);
    if (!c.against.trust.any())
        listener.note(c.reference.oversampled
                          ? fmt::format("the uncertainty of {} is unknown: {}", c.reference.name(),
                                        c.against.trust.missing)
                          : fmt::format("the uncertainty of {} is unknown: twice its modes were "
                                        "not run, and there is no certificate. To make one: {}",
                                        c.reference.name(), certify_command(request, c)));
    if (reference.run.status.outcome != Outcome::ok)
        listener.note(fmt::format("the reference {} {} after {:.6g} s: later windows have no error",
                                  c.reference.scheme->name, name_of(reference.run.status.outcome),
                                  c.reference_summary.duration));
}

// Runs all cells over the headline's window and marks the needed ones. The jobs use the scene cut
// short there, compared with the motion in the whole scene.
std::vector<study::Record> search(const Comparison& c, study::References& references, int threads,
                                  const store::Listener& listener) {
    const double from = free_from(c.scene()), length = study::headline_window(c.scene()),
                 end = std::min(c.scene().duration, from + length);
    study::Measures covered;  // measures that the shorter run covers
    for (std::size_t k = 0; k < study::measures().size() && end < c.scene().duration; ++k)
        if (study::measures()[k].window <= length) covered.push_back(k);
    study::Plan shown;
    std::map<const study::Point*, const study::Point*> part_of;
    for (const study::Point& whole : c.plan.points) {
        study::Point& part = shown.points.emplace_back(whole);
        part_of[&whole] = &part;
        part.whole = whole.scene;
        part.scene.duration = end;
    }
    for (const study::Job& job : c.plan.jobs) {
        study::Job& tried = shown.jobs.emplace_back(job);
        tried.point = part_of.at(job.point);
        tried.errors = covered;
        tried.sounds = false;
        tried.repeats = 0;
        references.hold(*tried.point);
    }
    study::Kept nowhere;
    std::vector<study::Record> records =
        study::run(shown, references, nowhere, threads, listener).records;
    const auto nut = static_cast<std::size_t>(c.headline.nut),
               window = study::waveform_over(length);
    std::vector<study::Cell> tried;
    std::vector<double> errors;
    for (study::Record& r : records) {
        r.cell.in_model.clear();
        errors.push_back(r.cell.ran() && r.cell.reason.empty() ? r.cell.errors.at(nut).at(window)
                                                               : HUGE_VAL);
        tried.push_back(std::move(r.cell));
    }
    mark_needed(tried, errors, c.against.trust.of_scene(nut, window));
    for (std::size_t i = 0; i < records.size(); ++i) records[i].cell = std::move(tried[i]);
    return records;
}

// Runs the needed cells whole and leaves the other searched cells in the state from the search.
// Removes added cells that cannot be made.
void run(Comparison& c, study::References& references, std::vector<study::Record> tried,
         study::Kept& keep, int threads, const store::Listener& listener) {
    study::Plan whole, all;
    std::vector<study::Record> records;
    std::vector<std::size_t> places;  // places of the cells that run whole
    for (std::size_t i = 0; i < c.plan.jobs.size(); ++i) {
        const study::Cell& cell = tried[i].cell;
        const bool run = cell.ran() && cell.needed;
        if (!run) references.release(*c.plan.jobs[i].point);
        if (!cell.ran() && cell.added) continue;
        if (run) places.push_back(records.size()), whole.jobs.push_back(c.plan.jobs[i]);
        all.jobs.push_back(c.plan.jobs[i]);
        records.push_back(std::move(tried[i]));
    }
    study::Study outcome = study::run(whole, references, keep, threads, listener);
    for (std::size_t k = 0; k < places.size(); ++k)
        records[places[k]] = std::move(outcome.records[k]);
    outcome.records = std::move(records);
    c.outcome = std::move(outcome);
    c.plan.jobs = std::move(all.jobs);
}
}  // namespace

std::optional<Advice> advice_on(const Scene& scene, const CompareRequest& r,
                                const Catalogue& catalogue, const store::Listener& listener) {
    const std::size_t waveform = study::waveform_over(study::headline_window(scene));
    AdviceRequest advice_request;
    const std::vector<Target> all = targets();
    advice_request.measure = std::ranges::find(all, waveform, &Target::measure)->name;
    advice_request.tap_rate = r.tap_rate;
    for (const std::string& scheme : r.schemes.empty() ? std::vector<std::string>{""} : r.schemes) {
        advice_request.scheme = scheme;
        try {
            return advise(scene, advice_request, catalogue, listener).back();
        } catch (const Refusal&) {}
    }
    return std::nullopt;
}

Comparison compare(const CompareRequest& request, const Catalogue& catalogue,
                   const store::Listener& listener) {
    study::Kept nowhere;
    return compare(request, catalogue, listener, nowhere);
}

Comparison compare(const CompareRequest& request, const Catalogue& catalogue,
                   const store::Listener& listener, study::Kept& keep,
                   const std::function<void(const study::Ran&, study::Record&)>& measure) {
    Comparison c;
    study::Point common;
    common.scene = load_scene(request);
    common.time_limit = request.time_limit.value_or(HUGE_VAL);
    common.begin = request.modes.empty() ? 0 : request.modes.front();
    note_scene(common.scene, listener);
    note_windows(common.scene, listener);
    for (const double rate : request.rates) refuse_slow_rate(common.scene, rate);
    c.headline = study::headline_of(common.scene);
    study::Job like{};
    like.sounds = true;
    like.repeats = request.repeats;
    like.measure = measure;
    CompareRequest sought = request;
    if (request.search && request.modes.empty())
        c.advice = advice_on(common.scene, request, catalogue, listener);
    if (c.advice) listener.note("advice before any reference: " + text_of(*c.advice));
    if (c.advice && c.advice->scheme) sought.near = c.advice->settings;
    add_jobs(c.plan, sought, catalogue, common, like);
    for (const std::string& note : c.plan.notes) listener.note(note);
    double lowest = 0;
    for (const study::Job& job : c.plan.jobs)
        if (const double rate = job.cell.settings.sample_rate; rate > 0)
            lowest = lowest > 0 ? std::min(lowest, rate) : rate;
    note_force_files(common.scene, lowest, listener);
    std::vector<std::string> plugins;
    for (const Guest* g : guests()) plugins.push_back(g->path);
    study::address(c.plan, store::program_identity(plugins));

    study::References references(c.plan.jobs);
    std::map<const study::Point*, study::References::Of> known;
    for (const study::Point& point : c.plan.points) {
        known[&point] = references.make(point, request.jobs, listener);
        if (!known[&point].truth) throw Refusal(known[&point].refused);
    }
    describe(c, request, known.at(&c.plan.points.front()), listener);
    std::vector<study::Record> tried;
    if (std::ranges::any_of(c.plan.jobs, [](const study::Job& job) { return job.cell.searched; }))
        tried = search(c, references, request.jobs, listener);
    else
        for (const study::Job& job : c.plan.jobs) tried.push_back({job.cell, {}, {}, {}});
    run(c, references, std::move(tried), keep, request.jobs, listener);
    return c;
}

// ---- Cells that are needed

namespace {
constexpr double as_good = 0.9;  // factor on the cheaper cell's error
constexpr double less_work =
    // More than the difference between schemes in time per step and number of state: four over a
    // lumped contact.
    32;

double work_of(const study::Cell& c) {
    return static_cast<double>(c.summary.steps) * c.summary.dofs;
}

bool surely_less(const study::Cell& a, const study::Cell& b) {
    if (b.added && a.scheme == b.scheme && a.settings.options == b.settings.options)
        return a.modes() <= b.modes() && a.settings.sample_rate <= b.settings.sample_rate &&
               work_of(a) < work_of(b);
    return work_of(a) > 0 && less_work * work_of(a) <= work_of(b);
}

bool usable(const study::Cell& c, double error) {
    return c.ran() && c.reason.empty() && study::flags_of(c.summary).empty() &&
           std::isfinite(error);
}

bool does_as_well(double a, double b, double certificate) {
    const auto keeps = [certificate](double error, double most) {
        return error + certificate <= most;
    };
    if (keeps(a, *std::min_element(std::begin(accuracies), std::end(accuracies)))) return true;
    return as_good * a <= b &&
           std::all_of(std::begin(accuracies), std::end(accuracies),
                       [&](double most) { return keeps(a, most) || !keeps(b, most); });
}
}  // namespace

void mark_needed(std::vector<study::Cell>& cells, const std::vector<double>& errors,
                 double certificate) {
    const double certain = std::isnan(certificate) ? 0 : certificate;
    std::vector<std::size_t> order(cells.size()), kept;
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return work_of(cells[a]) < work_of(cells[b]);
    });
    for (const std::size_t i : order) {
        const auto instead = [&](std::size_t k) {
            return surely_less(cells[k], cells[i]) && does_as_well(errors[k], errors[i], certain);
        };
        const bool failed = !cells[i].ran() || !cells[i].reason.empty(),
                   good = usable(cells[i], errors[i]);
        // A failure at the default number of modes is a finding.
        const bool may_go = cells[i].searched && !failed;
        const auto found = may_go ? std::find_if(kept.begin(), kept.end(), instead) : kept.end();
        if (!good && cells[i].added) {
            cells[i].needed = false;
            if (!failed)
                cells[i].reason =
                    "not to be trusted: " + names_of(study::flags_of(cells[i].summary));
        } else if (found != kept.end()) {
            const study::Cell& other = cells[*found];
            cells[i].needed = false;
            cells[i].reason =
                fmt::format("{}, {} modes at {:.4g} kHz does as well for less",
                            store::variant_name(other.scheme->name,
                                                store::options_text(other.settings.options)),
                            other.modes(), other.settings.sample_rate / 1000);
        } else if (good) {
            kept.push_back(i);
        }
    }
}

}  // namespace jvari::bench::compare

#include "bench/compare/compare.hpp"
#include "bench/compare/silence.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "bench/compare/compare_plan.hpp"
#include "bench/compare/cost.hpp"
#include "bench/compare/kept_cells.hpp"
#include "bench/compare/needed_cells.hpp"
#include "bench/compare/truth.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/store/system/time_limit.hpp"
#include "bench/trust/kept_run.hpp"
#include "reference/agreement.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::compare {

namespace {
ProgressOf told_to(store::Done& done) {
    return [&done](long rows, long of) { done = static_cast<double>(rows) / static_cast<double>(of); };
}

Run reference_run(const ReferenceChoice& choice, const Scene& scene, const ProgressOf& progress) {
    RunOptions options;
    options.progress = progress;
    const auto make = [&] { return run(*choice.scheme, scene, choice.settings, options); };
    if (!choice.kept) return make();
    const std::string key = trust::run_key(*choice.scheme, scene, choice.settings);
    const auto cached = [&] { return trust::kept_run(trust::kept_runs_folder(), key, make); };
    return choice.kept_in.empty() ? cached() : trust::kept_run(choice.kept_in, key, cached, 0);
}

double last_instant(const Run& r) {
    return static_cast<double>(r.trace.rows - 1) / r.trace.tap_rate;
}

// A scheme at three rates, the highest of them those of `r.choice`: its run there and its own estimate.
void run_oversampled(Reference& r, const Scene& scene, const ProgressOf& progress) {
    RunOptions options;
    options.progress = progress;
    Settings coarsest = r.choice.settings;
    coarsest.sample_rate /= r.choice.oversampled;
    try {
        Oversampled o = oversampled(*r.choice.scheme, scene, coarsest, r.choice.oversampled, options);
        if (o.rate == r.choice.settings.sample_rate) {
            r.run = std::move(o.run);
            r.trust = trust::trust_of(o, last_instant(r.run));
            return;
        }
        r.trust.missing = fmt::format("at {:.6g} Hz it {}", o.rate, name_of(o.run.status.outcome));
    } catch (const Refusal& e) {
        r.trust.missing = e.what();
    }
    r.run = reference_run(r.choice, scene, progress);  // a coarser one fails: no estimate
}

// Schemes that may stand in, in order of what they estimate their own error to be.
void least_error_first(std::span<ReferenceChoice> choices, const Scene& scene, const ProgressOf& progress) {
    RunOptions options;
    options.progress = progress;
    std::vector<std::pair<double, ReferenceChoice>> tried;
    for (ReferenceChoice& c : choices) {
        Settings coarsest = c.settings;
        coarsest.sample_rate /= c.oversampled;
        tried.emplace_back(estimate_of(*c.scheme, scene, coarsest, c.oversampled, options), std::move(c));
    }
    std::ranges::stable_sort(tried, {}, [](const auto& t) { return t.first; });
    for (std::size_t i = 0; i < tried.size(); ++i) choices[i] = std::move(tried[i].second);
}

std::string certify_command(const CompareRequest& r, const Comparison& c) {  // what would certify this comparison's reference
    std::string text = "jvari certify " + r.scene;
    if (r.duration) text += fmt::format(" --duration {:.6g}", *r.duration);
    if (c.reference_settings.tap_rate != 44100) text += fmt::format(" --tap-rate {:.12g}", c.reference_settings.tap_rate);
    for (const std::string& set : r.set) text += " --set " + set;
    return text;
}
}  // namespace

Reference run_reference(const std::vector<ReferenceChoice>& choices, const Scene& scene, int jobs, const store::Listener& listener,
                        double time_limit) {
    std::string refusals;
    bool ordered = false;
    std::vector<ReferenceChoice> in_turn = choices;
    for (std::size_t k = 0; k < in_turn.size(); ++k) try {
            if (in_turn[k].oversampled && k + 1 < in_turn.size() && !ordered) {
                const std::span<ReferenceChoice> rest(in_turn.begin() + static_cast<long>(k), in_turn.end());
                store::side_by_side({1}, 1, listener, "stand-in", [&](std::size_t, store::Done& done) {
                    least_error_first(rest, scene, store::within(time_limit, told_to(done)));
                });
                ordered = true;
            }
            const ReferenceChoice& choice = in_turn[k];
            Reference r{choice, {}, {}, {}};
            store::side_by_side({1, 1}, jobs, listener, "reference", [&](std::size_t i, store::Done& done) {
                const ProgressOf progress = store::within(time_limit, told_to(done));
                if (i == 1) r.moved = reference_run(choice, moved(scene, 1 + floor_displacement), progress);
                else if (choice.oversampled) run_oversampled(r, scene, progress);
                else r.run = reference_run(choice, scene, progress);
            });
            if (r.run.trace.rows < 2) {
                refusals += fmt::format("; {} failed at its start", choice.scheme->name);
                continue;
            }
            if (!choice.oversampled) r.trust = trust::trust_of(scene, choice.scheme->name, choice.settings, last_instant(r.run));
            return r;
        } catch (const Refusal& e) {
            refusals += std::string("; ") + e.what();
        } catch (const store::PastItsLimit& e) {
            throw store::PastItsLimit(fmt::format("reference {}: {}", in_turn[k].name(), e.what()));
        }
    throw Refusal("reference: none represents scene " + scene.name + refusals);
}

Trace run_cell(Cell& cell, const Scene& scene, const ProgressOf& progress) {
    RunOptions options;
    options.energy = true;
    options.progress = progress;
    Run result = run(*cell.scheme, scene, cell.settings, options);
    cell.summary = summary_of(*cell.scheme, scene, cell.settings, result);
    if (result.status.outcome != Outcome::ok)
        cell.reason =
            fmt::format("{} at step {}, after {:.6g} s", name_of(result.status.outcome), result.status.step, cell.summary.duration);
    return std::move(result.trace);
}

void judge(Cell& cell, const Trace& done, const Trace& truth, const Trace* model) {
    cell.errors = errors_of(done, truth);
    cell.in_model = !model ? Errors{} : model == &truth ? cell.errors : errors_of(done, *model);
}

namespace {
using EachCell = std::function<void(const char* label, const std::function<void(std::size_t, const ProgressOf&)>&)>;

// What of a comparison is known before a cell runs; messages of its reference.
void describe(Comparison& c, const CompareRequest& request, const Truth& truth, const Reference& model, const store::Listener& listener) {
    const Reference& reference = truth.reference;
    c.truth = truth.said;
    c.horizon = truth.horizon;
    c.model_trust = model.trust;
    c.reference = reference.choice.scheme;
    c.reference_name = reference.choice.name();
    c.reference_settings = reference.choice.settings;
    c.trust = reference.trust;
    c.reference_note = reference.choice.note;
    c.reference_summary = summary_of(*c.reference, c.scene, c.reference_settings, reference.run);
    c.floor = errors_of(reference.moved.trace, reference.run.trace);
    c.reference_sound = store::sound_of(reference.run.trace.column(c.headline.nut), reference.run.trace.tap_rate);
    if (!c.reference_note.empty()) listener.note(c.reference_note);
    if (!c.trust.any())
        listener.note(
            reference.choice.oversampled
                ? fmt::format("the uncertainty of {} is unknown: {}", c.reference_name, c.trust.missing)
                : fmt::format(
                      "the uncertainty of {} is unknown: twice its modes were not run, and there is no certificate. To make one: {}",
                      c.reference_name, certify_command(request, c)));
    if (reference.run.status.outcome != Outcome::ok)
        listener.note(fmt::format("the reference {} {} after {:.6g} s: later windows have no error", c.reference->name,
                                  name_of(reference.run.status.outcome), c.reference_summary.duration));
}

// Errors of the windows that a shorter run covers; of the whole run nothing is known.
Errors covered_by(Errors errors, double window) {
    for (auto& tap : errors)
        for (std::size_t k = 0; k < measures().size(); ++k)
            if (!(measures()[k].window <= window)) tap[k] = store::nan;
    return errors;
}

// Runs all cells over the headline's window, marks those that are needed, and takes out what was sought and cannot be made.
void search(Comparison& c, const Trace& reference, const EachCell& each_cell) {
    Scene shown = c.scene;
    shown.duration = std::min(shown.duration, headline_window(shown.duration));
    const int nut = c.headline.nut;
    std::vector<Cell> tried = c.cells;
    std::vector<double> errors(tried.size(), HUGE_VAL);
    each_cell("search", [&](std::size_t i, const ProgressOf& progress) {
        const Trace trace = run_cell(tried[i], shown, progress);
        tried[i].errors = covered_by(errors_of(trace, reference), shown.duration < c.scene.duration ? shown.duration : HUGE_VAL);
        if (tried[i].reason.empty())
            errors[i] = relative_difference(trace.column(nut), reference.column(nut), reference.tap_rate, shown.duration);
    });
    for (std::size_t i = 0; i < tried.size(); ++i) tried[i].refused = c.cells[i].refused;
    const std::size_t window = shown.duration >= 50e-3 ? 1 : shown.duration >= 10e-3 ? 0 : 2;
    mark_needed(tried, errors, c.trust.of_scene(static_cast<std::size_t>(nut), window));
    for (std::size_t i = 0; i < tried.size(); ++i)
        if (!tried[i].needed) c.cells[i] = tried[i];
    std::erase_if(c.cells, [](const Cell& cell) { return cell.refused && cell.added; });
}
}  // namespace

Comparison compare(const CompareRequest& request, const Catalogue& catalogue, const store::Listener& listener) {
    KeptCells nowhere;
    return compare(request, catalogue, listener, nowhere);
}

Comparison compare(const CompareRequest& request, const Catalogue& catalogue, const store::Listener& listener, KeptCells& keep) {
    Comparison c;
    c.scene = load_scene(request.scene, request.set, request.duration);
    note_silent_strings(c.scene, listener);
    c.headline = headline_of(c.scene);
    const Plan plan = plan_of(request, catalogue, c.scene);
    for (const std::string& note : plan.notes) listener.note(note);
    c.cells = plan.cells;
    const Reference model = run_reference(plan.references, c.scene, request.jobs, listener);
    const Truth truth = request.reference_modes ? run_truth(plan.references, c.scene, *request.reference_modes, request.jobs, listener)
                                                : Truth{model, {}, {}};
    describe(c, request, truth, model, listener);

    const EachCell each_cell = [&](const char* label, const std::function<void(std::size_t, const ProgressOf&)>& work) {
        std::vector<double> sizes;
        for (const Cell& cell : c.cells) sizes.push_back(std::max(cell.settings.sample_rate, 44100.0) * std::max(1, cell.settings.modes));
        store::side_by_side(
            sizes, request.jobs, listener, label,
            [&](std::size_t i, store::Done& done) {
                if (c.cells[i].refused || !c.cells[i].needed) return;
                try {
                    work(i, told_to(done));
                } catch (const std::exception& e) {  // one scheme that throws is one row, whatever it throws
                    c.cells[i].refused = true;
                    c.cells[i].reason = e.what();
                }
            },
            [&](std::size_t i) { return fmt::format("{} at {} Hz", c.cells[i].scheme->name, c.cells[i].settings.sample_rate); });
    };
    c.searched = std::ranges::any_of(c.cells, [](const Cell& cell) { return cell.searched; });
    if (c.searched) search(c, truth.reference.run.trace, each_cell);

    keep.of = static_cast<int>(std::ranges::count_if(c.cells, [](const Cell& cell) { return cell.needed; }));
    each_cell("errors", [&](std::size_t i, const ProgressOf& progress) {
        Cell& cell = c.cells[i];
        const Reference* own = of_modes(cell, model, truth);
        const std::string identity = keep.folder.empty() ? "" : identity_of(cell, truth.reference, own ? *own : model, c.scene);
        const std::filesystem::path file = keep.folder / (store::hash_of(identity) + ".json");
        if (keep.resume && read_cell(file, identity, cell)) {
            ++keep.kept, ++keep.read;
            return;
        }
        const Trace trace = run_cell(cell, c.scene, progress);
        judge(cell, trace, truth.reference.run.trace, own ? &own->run.trace : nullptr);
        if (cell.reason.empty()) cell.sound = store::sound_of(trace.column(c.headline.nut), trace.tap_rate);
        if (keep.folder.empty()) return;
        store::write_fresh(file, json_of(cell, identity));
        ++keep.kept;
    });
    std::vector<Contender> contenders;
    for (Cell& cell : c.cells)
        if (cell.needed) contenders.push_back({&cell, &c.scene});
    time_cells(contenders, request.repeats, listener);
    return c;
}

}  // namespace jvari::bench::compare

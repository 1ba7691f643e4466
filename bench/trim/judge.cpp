#include "bench/trim/judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "bench/compare/bound.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/time_limit.hpp"
#include "bench/study/cost.hpp"
#include "bench/study/judgement.hpp"
#include "bench/study/truth.hpp"
#include "reference/agreement.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"

namespace jvari::bench::trim {

namespace fs = std::filesystem;

namespace {
constexpr double sample = 5e-3;  // least time of one sample of a cost [s]
constexpr int samples = 3;
constexpr double worth_keeping = 5e-3;  // of a model: below, a file takes longer than the run [s]

int column_of(const Scene& scene, const std::string& tap) {
    for (std::size_t k = 0; k < scene.taps.size(); ++k)
        if (scene.taps[k].name == tap) return static_cast<int>(k);
    throw BadScene("tap", tap, "to be there still");
}

// What is unknown of a reference by this measure: its certificate for waveforms; of the others no
// bound is known, and what the doublings tell stands for it.
double uncertainty(const study::Truth& t, int tap, std::size_t measure, double from) {
    const study::Reference& of = t.reference;
    const std::string& column = study::measures()[measure].column;
    for (std::size_t w = 0; w < trust::Trust::columns.size(); ++w)
        if (column ==
            "error" +
                std::string(trust::Trust::columns[w]).substr(std::string("certificate").size()))
            return of.trust.any() ? of.trust.of_scene(static_cast<std::size_t>(tap), w)
                                  : store::nan;
    const double rate = of.run.trace.tap_rate;
    const auto apart = [&](const Trace& a, const Trace& b) {
        return study::error_of(measure, rows_from(a.column(tap), from, rate),
                               rows_from(b.column(tap), from, rate), rate);
    };
    std::vector<double> changes;
    for (std::size_t n = 0; n < t.coarser.size(); ++n) {
        const study::Reference& more = n + 1 < t.coarser.size() ? t.coarser[n + 1] : of;
        changes.push_back(apart(t.coarser[n].run.trace, more.run.trace));
    }
    const double left_out = left_after(changes, t.matched);
    return t.own.empty()
               ? left_out
               : no_less(left_out, apart(t.own[0], of.run.trace), apart(t.own[1], t.own[0]));
}
}  // namespace

std::string Model::settings_text() const {
    std::string text = store::variant_name(scheme->name, store::options_text(settings.options));
    if (settings.modes > 0) text += fmt::format(", {} modes", settings.modes);
    return text + fmt::format(", {:g} Hz", settings.sample_rate);
}

Model toggled(Model m, int part) {
    const auto at = std::ranges::lower_bound(m.left_out, part);
    if (at != m.left_out.end() && *at == part) m.left_out.erase(at);
    else m.left_out.insert(at, part);
    return m;
}

double processor_time(const Model& m, const Scene& left) {
    const auto scheme = make_scheme(*m.scheme, left, m.settings);
    double least = HUGE_VAL;
    for (int k = 0; k < samples; ++k) {
        const double from = store::processor_seconds();
        double took = 0;
        int runs = 0;
        for (; took < sample; ++runs) {
            run(*scheme, left, m.settings, {.timed = true});
            took = store::processor_seconds() - from;
        }
        least = std::min(least, took / runs);
    }
    return least / left.duration;
}

Judge::Judge(const Request& request, const compare::Catalogue& catalogue,
             const store::Listener& listener, CostOf cost_of)
    : request_(request),
      catalogue_(catalogue),
      listener_(listener),
      cost_of_(std::move(cost_of)),
      target_(target_of(request.measure, request.within)),
      scene_(compare::load_scene(request.scene, request.set, {})),
      own_duration_(scene_.duration),
      program_(store::program_identity(request.plugins)),
      stamp_(store::stamp_now()) {
    const double absent = judges_decay() ? own_duration_ : free_from(scene_) + 50e-3;
    scene_.duration = std::min(own_duration_, request.duration.value_or(absent));
    tap_ = compare::tap_named(scene_, request.tap);
    if (request.tap.empty()) tap_ = study::headline_of(scene_).nut;
    const double window = target_.measure->window, judged = scene_.duration - free_from(scene_);
    place_ = std::isfinite(window) && judged < window * (1 - 1e-9)
                 ? study::measure("error_l2_whole")
                 : target_.measure->place;
    if (!request_.out.empty()) {
        keep_.folder = fs::path(request_.out) / "cells";
        keep_.resume = true;
        keep_.least = worth_keeping;
        store::make_folder(keep_.folder);
        store::must_be_writable(fs::path(request_.out) / "path.csv");
        store::sweep_parts(keep_.folder);
    }
    reductions_ = reductions_of(scene_, truth(0).penetration);
}

bool Judge::may_go(int k) const {
    const Reduction& r = reductions_[k];
    // that is the question, not the model
    if (r.part == Part::initial_shape || r.part == Part::pluck) return false;
    const bool loss =
        r.part == Part::damping || r.part == Part::damping_term || r.part == Part::contact_loss;
    // 50 ms hardly hear it, and without it the sound never ends
    if (loss && !judges_decay()) return false;
    Scene left = scene_;
    r.apply(left);
    remove_idle_taps(left, tap().name);
    if (std::none_of(left.taps.begin(), left.taps.end(),
                     [this](const Tap& t) { return t.name == tap().name; }))
        return false;
    const Quantity q = tap().quantity;
    const bool sums =
        q == Quantity::thread_force || q == Quantity::bridge_force || q == Quantity::driving_force;
    return !sums || (r.part != Part::barrier && r.part != Part::thread);
}

Scene Judge::scene_of(const Model& m, int start) const {
    Scene scene = started(scene_, start);
    for (const int k : m.left_out) reductions_[k].apply(scene);
    remove_idle_taps(scene, tap().name);
    column_of(scene, tap().name);
    validate(scene);
    return scene;
}

const study::Point& Judge::point(int start) {
    if (!points_.at(start).points.empty()) return points_[start].points.front();
    study::Point& p = points_[start].points.emplace_back();
    p.scene = started(scene_, start);
    p.whole = p.scene;
    compare::CompareRequest r;
    r.reference = request_.reference;
    r.rates = {4 * request_.tap_rate};
    r.tap_rate = request_.tap_rate;
    p.references = compare::references_of(r, catalogue_, p.scene);
    if (!request_.out.empty())
        study::keep_references_in(points_[start], fs::path(request_.out) / "references");
    p.truth_modes = request_.reference_modes;
    p.in_model = false;
    study::address(points_[start], program_);
    return p;
}

study::Plan Judge::plan_of(const Model& m, int start) {
    study::Plan plan;
    study::Point& p = plan.points.emplace_back(point(start));
    p.scene = scene_of(m, start);
    study::Job& job = plan.jobs.emplace_back(study::Job{&p, {m.scheme, m.settings}});
    job.errors = {place_};
    study::address(plan, program_);
    return plan;
}

const Truth& Judge::truth(int start) {
    if (truths_.at(start)) return *truths_[start];
    const study::Point& whole = point(start);
    references_.hold(whole);
    const study::References::Of found = references_.make(whole, request_.jobs, listener_);
    if (!found.truth) throw Refusal(found.refused);
    const study::Reference& of = found.truth->reference;
    if (of.run.status.outcome != Outcome::ok)
        throw Refusal(fmt::format("reference {} {}: there is no truth to trim by", of.choice.name(),
                                  name_of(of.run.status.outcome)));
    Truth& t = truths_[start].emplace();
    t.reference = of.choice.name();
    t.said = found.truth->said;
    t.modes = of.choice.settings.modes;
    t.certificate = uncertainty(*found.truth, tap_, place_, free_from(whole.scene));
    t.floor = found.floor->at(static_cast<std::size_t>(tap_))[place_];
    t.horizon = found.truth->horizon;
    if (const double depth = fact_of(of.run.facts, facts::deepest_penetration); depth > 0)
        t.penetration = depth;
    return t;
}

Verdict Judge::verdict(const Model& m, int start, double limit) {
    truth(start);
    study::Plan plan = plan_of(m, start);
    study::Job& job = plan.jobs.front();
    if (const auto known = verdicts_.find(job.id); known != verdicts_.end()) return known->second;
    job.patience = limit;
    const study::Record record = *study::record_of(job, references_, keep_, [](long, long) {});
    const study::Cell& cell = record.cell;
    if (cell.failure == "past_time_limit") return {"slow", store::nan, limit};
    // what is left is no model of this scheme
    if (!cell.ran()) return verdicts_[job.id] = {"refused"};
    const std::string flags = names_of(study::flags_of(cell.summary));
    const bool whole = cell.summary.status.outcome == Outcome::ok;
    return verdicts_[job.id] = {
               !whole          ? name_of(cell.summary.status.outcome)
               : flags.empty() ? "ok"
                               : flags,
               whole ? cell.errors.at(static_cast<std::size_t>(tap_))[place_] : store::nan,
               cell.summary.processor_seconds};
}

double Judge::worst_error(const Model& m, const std::vector<int>& of_starts) {
    double worst = 0;
    try {
        for (const int start : of_starts) {
            const Verdict v = verdict(m, start);
            if (v.status != "ok") return std::nan("");
            worst = std::max(worst, v.error);
        }
    } catch (const std::exception&) { return std::nan(""); }
    return worst;
}

bool Judge::certain(int start) {
    return truth(start).certificate < (start == 0 ? 1 : 0.5) * target_.most;
}

bool Judge::within(const Verdict& v, int start) {
    const double error = start > 0 && !certain(start)
                             ? v.error
                             : compare::Bound{v.error, truth(start).certificate}.most();
    return v.status == "ok" && error <= target_.most;
}

double Judge::cost(const Model& m) {
    const study::Plan plan = plan_of(m, 0);
    const study::Job& job = plan.jobs.front();
    if (const auto known = costs_.find(job.id); known != costs_.end()) return known->second;
    const fs::path file = keep_.folder / study::clock_file(job);
    if (const auto kept =
            request_.out.empty() ? std::nullopt : study::read_clock(file, job.identity)) {
        if (kept->stamp.name != stamp_.name)
            throw store::UsageError(
                fmt::format("--out {}: its costs come from another machine, {}; choose another "
                            "folder, or remove {}/*.clock",
                            request_.out, kept->stamp.name, keep_.folder.string()));
        return costs_[job.id] = kept->processor.median / scene_.duration;
    }
    const double cost = costs_[job.id] = cost_of_(m, job.point->scene);
    study::Timing clock;
    clock.processor = clock.wall = spread_of(std::vector{cost * scene_.duration});
    clock.stamp = stamp_;
    if (!request_.out.empty()) store::write_fresh(file, study::clock_json(clock, job.identity));
    return cost;
}

bool Judge::saves(const Model& less, const Model& now) {
    std::vector<double> of_less, of_now;
    for (int round = 0; round < 7; ++round) {
        of_less.push_back(cost_of_(less, scene_of(less)));
        of_now.push_back(cost_of_(now, scene_of(now)));
    }
    const Spread a = spread_of(of_less), b = spread_of(of_now);
    return a.median <= worth * b.median && a.upper <= b.lower;
}

std::vector<Spread> Judge::costs(const std::vector<Model>& models, int rounds) {
    std::vector<Scene> scenes;
    std::vector<study::Cell> cells;
    for (const Model& m : models) {
        scenes.push_back(scene_of(m));
        cells.push_back({m.scheme, m.settings});
        cells.back().summary.wall_seconds = verdict(m, 0).seconds;
    }
    std::vector<study::Contender> contenders;
    for (std::size_t k = 0; k < cells.size(); ++k) contenders.push_back({&cells[k], &scenes[k]});
    study::time_cells(contenders, rounds, listener_);
    std::vector<Spread> spreads;
    for (const study::Cell& c : cells) {
        Spread s = c.clock.processor;
        for (double* x : {&s.median, &s.lower, &s.upper}) *x /= scene_.duration;
        spreads.push_back(s);
    }
    return spreads;
}

}  // namespace jvari::bench::trim

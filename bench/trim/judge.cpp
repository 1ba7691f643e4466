#include "bench/trim/judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "analysis/cheapest.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/study/cost.hpp"
#include "bench/study/truth.hpp"
#include "reference/agreement.hpp"
#include "reference/references.hpp"
#include "scenes/excitation.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/controls.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::trim {

namespace fs = std::filesystem;

namespace {
constexpr double sample = 5e-3;  // minimum time for one sample of a cost [s]
constexpr int samples = 3;
constexpr double deepest_absent = 1;  // penetration of a reference without contact [m]
// limit for keeping a model: writing a file takes longer than a shorter run [s]
constexpr double worth_keeping = 5e-3;

// Uncertainty of a reference in this measure: for waveforms its certificate. Other measures have no
// known bound, so the estimate from the doublings is taken.
double uncertainty(const study::Truth& t, std::size_t tap, std::size_t measure, double from) {
    const study::Reference& of = t.reference;
    // Waveforms are the first measures.
    if (measure < study::Trust::columns.size())
        return of.trust.any() ? of.trust.of_scene(tap, measure) : nan;
    const double rate = of.run.trace.tap_rate;
    const auto column = [&](const Trace& trace) {
        return rows_from(trace.column(static_cast<int>(tap)), from, rate);
    };
    const auto apart = [&](const Trace& a, const Trace& b) {
        return study::error_of(measure, column(a), column(b), rate);
    };
    return study::left_out(t, apart);
}
}  // namespace

Model toggled(Model m, int part) {
    const auto at = std::ranges::lower_bound(m.left_out, part);
    if (at != m.left_out.end() && *at == part) m.left_out.erase(at);
    else m.left_out.insert(at, part);
    return m;
}

std::string identity_of(const Request& r) {
    std::string text = write_scene(compare::load_scene(r.scene, r.set, r.duration)) +
                       fmt::format("{} {} {} {} {} {} {}", r.measure, r.within, r.tap, r.scheme,
                                   r.reference, r.tap_rate, r.reference_modes);
    for (const compare::SchemeOption& o : r.options)
        text += fmt::format("\n{}:{}={}", o.scheme, o.name, o.value);
    return text;
}

double processor_time(const Model& m, const Scene& left) {
    double least = HUGE_VAL;
    for (int k = 0; k < samples; ++k)
        least = std::min(least, study::sample_of(*m.scheme, left, m.settings, sample).processor);
    return least / left.duration;
}

Judge::Judge(const Request& request, const compare::Catalogue& catalogue,
             const store::Listener& listener, CostOf cost_of)
    : request_(request),
      catalogue_(catalogue),
      listener_(listener),
      cost_of_(std::move(cost_of)),
      target_(compare::target_of(request.measure, request.within)),
      scene_(compare::load_scene(request.scene, request.set, {})),
      own_duration_(scene_.duration),
      program_(store::program_identity(request.plugins)),
      stamp_(store::stamp_now()) {
    const double absent = judges_decay() ? own_duration_ : free_from(scene_) + 50e-3;
    scene_.duration = std::min(own_duration_, request.duration.value_or(absent));
    compare::require_rows(scene_, {0, request.tap_rate, 0, {}});
    const int tap = compare::tap_named(scene_, request.tap);
    tap_ = static_cast<std::size_t>(request.tap.empty() ? study::headline_of(scene_).nut : tap);
    const study::Measure& measure = study::measures()[target_.measure];
    const double judged = scene_.duration - free_from(scene_);
    const bool covered = std::isinf(measure.window) || judged >= measure.window * (1 - 1e-9);
    if (measure.heard && !covered)
        throw store::UsageError(fmt::format(
            "--of {}: found {:.4g} ms after the last pluck, expected {:g} ms, its window",
            target_.name, 1e3 * judged, 1e3 * measure.window));
    measure_ = covered ? target_.measure : study::measure("error_l2_whole");
    if (!request_.out.empty()) {
        keep_.folder = fs::path(request_.out) / "cells";
        keep_.resume = true;
        keep_.least = worth_keeping;
        store::make_folder(keep_.folder);
        store::must_be_writable(fs::path(request_.out) / "path.csv");
        store::sweep_parts(keep_.folder);
    }
    const double depth = fact_of(truth(0).reference.run.facts, facts::deepest_penetration);
    reductions_ = reductions_of(scene_, depth > 0 ? depth : deepest_absent);
}

bool Judge::may_go(int k) const {
    const Reduction& r = reductions_[k];
    // excitation belongs to the question, not to the model
    if (r.part == Part::initial_shape || r.part == Part::pluck) return false;
    const bool loss =
        r.part == Part::damping || r.part == Part::damping_term || r.part == Part::contact_loss;
    // A loss is hardly audible in 50 ms, but without loss the sound never ends.
    if (loss && !judges_decay()) return false;
    Scene left = scene_;
    r.apply(left);
    remove_idle_taps(left, tap().name);
    if (std::ranges::find(left.taps, tap().name, &Tap::name) == left.taps.end()) return false;
    const Quantity q = tap().quantity;
    const bool sums =
        q == Quantity::thread_force || q == Quantity::bridge_force || q == Quantity::driving_force;
    return !sums || (r.part != Part::barrier && r.part != Part::thread);
}

Scene Judge::scene_of(const Model& m, int start) const {
    Scene scene = started(scene_, start);
    for (const int k : m.left_out) reductions_[k].apply(scene);
    remove_idle_taps(scene, tap().name);
    if (std::ranges::find(scene.taps, tap().name, &Tap::name) == scene.taps.end())
        throw BadScene("tap", tap().name, "to be there still");
    validate(scene);
    return scene;
}

const study::Point& Judge::point(int start) {
    if (!points_.at(start).points.empty()) return points_[start].points.front();
    study::Point& p = points_[start].points.emplace_back();
    p.scene = started(scene_, start);
    p.whole = p.scene;
    const auto able = std::ranges::find_if(catalogue_.schemes, [&p](const Descriptor* d) {
        return represents(*d, p.scene) && !left_out_unasked(*d, p.scene);
    });
    p.references = study::references_of(
        p.scene, {4 * request_.tap_rate, request_.tap_rate, 0, {}},
        request_.reference.empty() ? nullptr : &catalogue_.find(request_.reference),
        able == catalogue_.schemes.end() ? nullptr : *able);
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
    job.errors = {measure_};
    study::address(plan, program_);
    return plan;
}

const Judge::Known& Judge::known(int start) {
    if (known_.at(start)) return *known_[start];
    const study::Point& whole = point(start);
    references_.hold(whole);
    const study::References::Of found = references_.make(whole, request_.jobs, listener_);
    if (!found.truth) throw Refusal(found.refused);
    const study::Reference& of = found.truth->reference;
    if (of.run.status.outcome != Outcome::ok)
        throw Refusal(fmt::format("reference {} {}: there is no truth to trim by", of.choice.name(),
                                  name_of(of.run.status.outcome)));
    if (study::rows_for(measure_, of.run.trace, static_cast<int>(tap_)).empty())
        throw Refusal(
            fmt::format("--of {}: the reference {} cannot be read by its modes below 20 kHz",
                        target_.name, of.choice.name()));
    const double unknown = uncertainty(*found.truth, tap_, measure_, free_from(whole.scene));
    return known_[start].emplace(Known{found, unknown});
}

const study::Truth& Judge::truth(int start) { return *known(start).reference.truth; }
double Judge::certificate(int start) { return known(start).certificate; }
double Judge::floor(int start) { return known(start).reference.floor->at(tap_)[measure_]; }

Judged Judge::judged(const Model& m, int start, double limit) {
    known(start);
    study::Plan plan = plan_of(m, start);
    study::Job& job = plan.jobs.front();
    if (const auto at = judged_.find(job.id); at != judged_.end()) return at->second;
    job.patience = limit;
    const study::Record record = *study::record_of(job, references_, keep_, [](long, long) {});
    const study::Cell& cell = record.cell;
    if (cell.failure == "past_time_limit") return {};
    const bool whole = cell.ran() && cell.summary.status.outcome == Outcome::ok;
    return judged_[job.id] = {study::judge(cell, nan).verdict,
                              whole ? cell.errors.at(tap_)[measure_] : nan,
                              cell.summary.processor_seconds};
}

double Judge::worst_error(const Model& m, const std::vector<int>& of_starts) {
    double worst = 0;
    try {
        for (const int start : of_starts) {
            const Judged v = judged(m, start);
            if (!v.trusted()) return std::nan("");
            worst = std::max(worst, v.error);
        }
    } catch (const std::exception&) { return std::nan(""); }
    return worst;
}

bool Judge::certain(int start) {
    return certificate(start) < (start == 0 ? 1 : 0.5) * target_.most;
}

bool Judge::within(const Judged& j, int start) {
    const bool alone = start > 0 && !certain(start);
    const double most = alone ? j.error : at_most(j.error, certificate(start));
    return j.trusted() && most <= target_.most;
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
        cells.back().summary.wall_seconds = judged(m, 0).seconds;
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

#include "bench/trim/judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/compare/bound.hpp"
#include "bench/compare/compare_plan.hpp"
#include "bench/compare/record/compare_record.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/kept.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/time_limit.hpp"
#include "bench/store/usage.hpp"
#include "bench/study/truth.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::trim {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;
constexpr double sample = 5e-3;  // least time of one sample of a cost [s]
constexpr int samples = 3;
constexpr double worth_keeping = 5e-3;  // of a verdict: below, a file takes longer than the run [s]

int tap_named(const Scene& scene, const std::string& name) {
    if (scene.taps.empty())
        throw store::UsageError("scene " + scene.name + " has no tap: there is nothing to judge. A [[tap]] says what to hear");
    if (name.empty()) return study::headline_of(scene).nut;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < scene.taps.size(); ++k) {
        if (scene.taps[k].name == name) return static_cast<int>(k);
        names.push_back(scene.taps[k].name);
    }
    throw store::UsageError("--tap " + store::unknown("tap", name, names));
}

int column_of(const Scene& scene, const std::string& tap) {
    for (std::size_t k = 0; k < scene.taps.size(); ++k)
        if (scene.taps[k].name == tap) return static_cast<int>(k);
    throw BadScene("tap", tap, "to be there still");
}

double number(const Json& j, const char* key) {
    return store::number_of(j.at(key).get<std::string>());
}

// Processor seconds of one run, the mean of as many as last `sample`.
double timed(Scheme& scheme, const Scene& scene, const Settings& settings) {
    const double from = store::processor_seconds();
    double took = 0;
    int runs = 0;
    while (took < sample) {
        run(scheme, scene, settings, {.timed = true});
        took = store::processor_seconds() - from;
        ++runs;
    }
    return took / runs;
}
}  // namespace

std::string Model::settings_text() const {
    std::string text = store::variant_name(scheme->name, store::options_text(settings.options));
    if (settings.modes > 0) text += fmt::format(", {} modes", settings.modes);
    return text + fmt::format(", {:g} Hz", settings.sample_rate);
}

double processor_time(const Model& m, const Scene& left) {
    const auto scheme = make_scheme(*m.scheme, left, m.settings);
    double least = HUGE_VAL;
    for (int k = 0; k < samples; ++k) least = std::min(least, timed(*scheme, left, m.settings));
    return least / left.duration;
}

Judge::Judge(const Request& request, const compare::Catalogue& catalogue, const store::Listener& listener, CostOf cost_of)
    : request_(request),
      catalogue_(catalogue),
      listener_(listener),
      cost_of_(std::move(cost_of)),
      target_(target_of(request.measure, request.within)),
      scene_(compare::load_scene(request.scene, request.set, {})),
      own_duration_(scene_.duration),
      program_(store::program_identity(request.plugins)) {
    scene_.duration = std::min(scene_.duration, request.duration);
    tap_ = tap_named(scene_, request.tap);
    if (!request_.out.empty()) {
        std::error_code error;
        fs::create_directories(fs::path(request_.out) / "cells", error);
        store::must_be_writable(fs::path(request_.out) / "path.csv");
        store::sweep_parts(fs::path(request_.out) / "cells");
    }
    reductions_ = reductions_of(scene_, truth(0).penetration);
}

bool Judge::may_go(int k) const {
    const Reduction& r = reductions_[k];
    if (r.part == Part::initial_shape || r.part == Part::pluck) return false;  // that is the question, not the model
    Scene left = scene_;
    r.apply(left);
    remove_idle_taps(left, tap().name);
    if (std::none_of(left.taps.begin(), left.taps.end(), [this](const Tap& t) { return t.name == tap().name; })) return false;
    const Quantity q = tap().quantity;
    const bool sums = q == Quantity::thread_force || q == Quantity::bridge_force || q == Quantity::driving_force;
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

std::string Judge::identity(const Model& m, int start, const char* what) const {
    return Json{what,
                program_,
                scene_hash(started(scene_, start)),
                request_.reference,
                request_.reference_modes,
                store::text_of(request_.tap_rate),
                tap().name,
                target_.measure->name,
                m.scheme ? scene_hash(scene_of(m, start)) : "",
                m.scheme ? m.scheme->name : "",
                store::text_of(m.settings.sample_rate),
                m.settings.modes,
                m.settings.options}
        .dump();
}

fs::path Judge::file_of(const std::string& identity) const {
    return fs::path(request_.out) / "cells" / (store::hash_of(identity) + ".json");
}

template <class Read>
auto Judge::kept(const std::string& identity, Read read) const -> std::optional<std::invoke_result_t<Read, const Json&>> {
    if (request_.out.empty()) return std::nullopt;
    return store::read_kept(file_of(identity), identity, read);
}

void Judge::keep(const std::string& identity, const Json& content) const {
    if (!request_.out.empty()) store::write_fresh(file_of(identity), store::kept_text(identity, content));
}

void Judge::run_truth(int start) {
    const Scene scene = started(scene_, start);
    compare::CompareRequest r;
    r.reference = request_.reference;
    r.rates = {4 * request_.tap_rate};
    r.search = false;
    r.tap_rate = request_.tap_rate;
    const compare::Plan plan = compare::plan_of(r, catalogue_, scene);
    const study::Truth t = study::run_truth(plan.references, scene, request_.reference_modes, request_.jobs, listener_);
    const study::Reference& of = t.reference;
    if (of.run.status.outcome != Outcome::ok)
        throw Refusal(fmt::format("reference {} {}: there is no truth to trim by", of.choice.name(), name_of(of.run.status.outcome)));
    const auto column = of.run.trace.column(tap_), moved = of.moved.trace.column(tap_);
    traces_[start].emplace(column.begin(), column.end());
    Truth& known = truths_[start].emplace();
    known.reference = of.choice.name();
    known.said = t.said;
    known.modes = of.choice.settings.modes;
    known.floor = target_.measure->error(moved, column, of.run.trace.tap_rate);
    known.horizon = t.horizon;
    if (target_.measure->name == std::string("l2_50ms")) {
        if (of.trust.any()) known.certificate = of.trust.of_scene(tap_, scene_.duration >= 50e-3 ? 1 : 2);
    } else if (!t.coarser.empty()) {  // no bound is known of the others: what the doublings tell
        const auto changed = [&](std::size_t last) {
            const study::Reference& more = last < t.coarser.size() ? t.coarser[last] : of;
            return target_.measure->error(t.coarser[last - 1].run.trace.column(tap_), more.run.trace.column(tap_), of.run.trace.tap_rate);
        };
        const std::size_t n = t.coarser.size();
        known.certificate = left_after(changed(n), n > 1 ? changed(n - 1) : store::nan);
    }
    const double depth = study::fact(of.run.facts, facts::deepest_penetration);
    known.penetration = depth > 0 ? depth : 1;
    const std::string id = identity({{}, nullptr, {}}, start, "truth");
    keep(id, {{"reference", known.reference},
              {"said", known.said},
              {"modes", known.modes},
              {"certificate", store::text_of(known.certificate)},
              {"floor", store::text_of(known.floor)},
              {"horizon", store::text_of(known.horizon)},
              {"penetration", store::text_of(known.penetration)}});
}

const Truth& Judge::truth(int start) {
    if (truths_[start]) return *truths_[start];
    const std::string id = identity({{}, nullptr, {}}, start, "truth");
    truths_[start] = kept(id, [](const Json& j) {
        return Truth{j.at("reference"),  j.at("said"),         j.at("modes"),           number(j, "certificate"),
                     number(j, "floor"), number(j, "horizon"), number(j, "penetration")};
    });
    if (!truths_[start]) run_truth(start);
    return *truths_[start];
}

const std::vector<double>& Judge::trace(int start) {
    if (!traces_[start]) run_truth(start);
    return *traces_[start];
}

Verdict Judge::verdict(const Model& m, int start, double limit) {
    const std::string id = identity(m, start, "model");
    if (const auto asked = verdicts_.find(id); asked != verdicts_.end()) return asked->second;
    const auto known = kept(id, [](const Json& j) {
        return Verdict{j.at("status"), number(j, "error"), number(j, "seconds"), j.at("dofs")};
    });
    if (known) {
        ++read_back_;
        return verdicts_[id] = *known;
    }
    Verdict v;
    const std::vector<double>& reference = trace(start);
    try {
        const Scene scene = scene_of(m, start);
        const auto scheme = make_scheme(*m.scheme, scene, m.settings);
        RunOptions options;
        options.energy = true;  // what its ledger says against it
        options.progress = store::within(limit, [](long, long) {});
        const double from = store::processor_seconds();
        const Run r = run(*scheme, scene, m.settings, options);
        v.seconds = store::processor_seconds() - from;
        const std::string flags = names_of(study::flags_of(study::summary_of(*m.scheme, scene, m.settings, r)));
        v.status = r.status.outcome != Outcome::ok ? name_of(r.status.outcome) : flags.empty() ? "ok" : flags;
        v.dofs = r.dofs;
        if (r.status.outcome == Outcome::ok)
            v.error = target_.measure->error(r.trace.column(column_of(scene, tap().name)), reference, r.trace.tap_rate);
    } catch (const store::PastItsLimit&) {
        return {"slow", std::nan(""), limit, 0};
    } catch (const std::exception&) {  // Refusal, BadScene: what is left is no model of this scheme
        v.status = "refused";
    }
    ++judged_;
    verdicts_[id] = v;
    if (v.seconds < worth_keeping) return v;
    keep(id, {{"status", v.status}, {"error", store::text_of(v.error)}, {"seconds", store::text_of(v.seconds)}, {"dofs", v.dofs}});
    return v;
}

bool Judge::certain(int start) {
    return truth(start).certificate < (start == 0 ? 1 : 0.5) * target_.most;
}

bool Judge::within(const Verdict& v, int start) {
    const double error = start > 0 && !certain(start) ? v.error : compare::Bound{v.error, truth(start).certificate}.most();
    return v.status == "ok" && error <= target_.most;
}

double Judge::cost(const Model& m) {
    const std::string id = identity(m, 0, "cost");
    if (const auto known = costs_.find(id); known != costs_.end()) return known->second;
    if (const auto cost = kept(id, [](const Json& j) { return number(j, "cost"); })) return costs_[id] = *cost;
    const double cost = costs_[id] = cost_of_(m, scene_of(m));
    keep(id, {{"cost", store::text_of(cost)}});
    return cost;
}

std::vector<Spread> Judge::costs(const std::vector<Model>& models, int rounds) const {
    std::vector<Scene> scenes;
    std::vector<std::unique_ptr<Scheme>> schemes;
    std::vector<std::vector<double>> seconds(models.size());
    for (const Model& m : models) {
        scenes.push_back(scene_of(m));
        schemes.push_back(make_scheme(*m.scheme, scenes.back(), m.settings));
    }
    const auto progress = listener_.begin("cost");
    for (int round = 0; round < rounds; ++round)
        for (std::size_t k = 0; k < models.size(); ++k) {
            progress->show((round + static_cast<double>(k) / static_cast<double>(models.size())) / rounds);
            seconds[k].push_back(timed(*schemes[k], scenes[k], models[k].settings) / scenes[k].duration);
        }
    std::vector<Spread> spreads;
    for (const auto& s : seconds) spreads.push_back(spread_of(s));
    return spreads;
}

}  // namespace jvari::bench::trim

#include "bench/study/job.hpp"

#include <fmt/core.h>

#include <atomic>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "bench/store/encoding.hpp"
#include "bench/store/json.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/study/reference.hpp"
#include "scenes/excitation.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::study {

namespace {
using Json = nlohmann::ordered_json;

Json settings_json(const Settings& s) {
    return {{"rate", store::text_of(s.sample_rate)},
            {"tap_rate", store::text_of(s.tap_rate)},
            {"modes", s.modes},
            {"options", s.options}};
}

Json references_json(const Point& p) {
    Json references = Json::array();
    for (const ReferenceChoice& c : p.references)
        references.push_back({{"name", c.name()}, {"settings", settings_json(c.settings)}});
    return references;
}

// True if the doubling of the modes starts at a number given for the point.
bool begins(const Point& p) { return p.truth_modes == 0 && p.begin > 0; }
}  // namespace

void address(Plan& plan, const std::string& of_program) {
    const Json program = store::parsed(of_program);
    for (Point& p : plan.points) {
        const Json references = references_json(p);
        const std::string limit = store::text_of(p.time_limit);
        p.hash = scene_hash(p.scene);
        if (p.true_hash.empty()) p.true_hash = p.whole ? scene_hash(*p.whole) : p.hash;
        p.reference_key = p.true_hash + store::compact(references) + limit;
        if (!p.truth_modes) continue;
        Json modeless = references;
        for (Json& r : modeless) r["settings"].erase("modes");
        p.truth_key = std::to_string(*p.truth_modes) + p.true_hash + store::compact(modeless) +
                      limit + (begins(p) ? " " + std::to_string(p.begin) : "") +
                      store::text_of(p.effort) + (p.settles_whole ? " whole" : "");
    }
    std::set<std::string> seen;
    std::vector<Job> once;
    for (Job& job : plan.jobs) {
        const Point& p = *job.point;
        Json identity{{"program", program},
                      {"scene", p.scene.name},
                      {"scene_hash", p.hash},
                      {"scheme", job.cell.scheme->name},
                      {"settings", settings_json(job.cell.settings)},
                      {"sounds", job.sounds},
                      {"measured", job.measured}};
        if (job.judged) identity["references"] = references_json(p);
        if (job.judged && p.truth_modes) identity["reference_modes"] = *p.truth_modes;
        if (job.judged && begins(p)) identity["reference_begins"] = p.begin;
        if (!job.errors.empty()) identity["errors"] = job.errors;
        if (p.whole) identity["part_of"] = p.true_hash;
        if (!p.in_model) identity["in_model"] = false;
        if (p.alone) identity["reference_alone"] = true;
        if (p.settles_whole) identity["reference_settles_whole"] = true;
        if (p.effort != 1) identity["reference_effort"] = store::text_of(p.effort);
        if (job.repeats > 0) identity["repeats"] = job.repeats;
        if (!std::isinf(p.time_limit)) identity["time_limit_s"] = p.time_limit;
        job.identity = store::compact(identity);
        job.id = store::hash_of(job.identity);
        if (seen.insert(job.identity).second) once.push_back(std::move(job));
    }
    plan.jobs = std::move(once);
}

std::string identity_of(const Plan& plan) {
    std::string all;
    for (const Job& job : plan.jobs) {
        Json identity = store::parsed(job.identity);
        identity.erase("program");
        all += store::compact(identity) + "\n";
    }
    return all;
}

std::string what_of(const Job& job) {
    std::string text = job.point->scene.name;
    for (const auto& [key, value] : job.point->swept) text += " " + key + "=" + value;
    text += ": " + store::variant_name(job.cell.scheme->name,
                                       store::options_text(job.cell.settings.options));
    if (job.cell.settings.sample_rate > 0)
        text += fmt::format(" at {} Hz", job.cell.settings.sample_rate);
    return text;
}

// ---- References

class References::Shared {
public:
    template <class Make>
    void make(double from, Make run) {
        if (made_) return;
        std::optional<store::Wait> wait(std::in_place);
        const std::lock_guard lock(mutex_);
        wait.reset();
        if (made_) return;
        try {
            truth_ = std::make_unique<Truth>(run());
            const Run& moved = truth_->reference.moved;
            if (moved.trace.rows > 0)
                floor_ = errors_of(moved.trace, truth_->reference.run.trace, {}, from);
        } catch (const std::exception& e) { refused_ = e.what(); }
        made_ = true;
    }
    void hold() { ++needed_by_; }
    void release() {
        if (--needed_by_ > 0) return;
        truth_.reset();
        made_ = false;
    }
    const Truth* truth() const { return truth_.get(); }
    const Errors& floor() const { return floor_; }
    const std::string& refused() const { return refused_; }

private:
    std::mutex mutex_;  // protects the members below until `made_` is true
    std::unique_ptr<Truth> truth_;
    Errors floor_;
    std::string refused_;
    std::atomic<bool> made_ = false;
    std::atomic<int> needed_by_ = 0;
};

Against References::Of::against() const {
    if (!truth) return {};
    const Reference& r = truth->reference;
    return {r.choice.name(), r.choice.settings.modes,        truth->description, *floor,
            r.trust,         model ? model->trust : Trust{}, truth->limit_hz};
}

References::References(std::span<const Job> jobs) {
    for (const Job& job : jobs)
        if (job.judged) hold(*job.point);
}

References::~References() = default;

References::Shared& References::of(const std::string& key) {
    const std::lock_guard lock(mutex_);
    auto& shared = all_[key];
    if (!shared) shared = std::make_unique<Shared>();
    return *shared;
}

void References::each_of(const Point& p, void (Shared::*act)()) {
    (of(p.reference_key).*act)();
    if (!p.truth_key.empty()) (of(p.truth_key).*act)();
}

References::Of References::make(const Point& p, int jobs, const store::Listener& listener) {
    const Scene& scene = p.true_scene();
    const double from = free_from(scene);
    Shared& model = of(p.reference_key);
    Shared& truth = p.truth_key.empty() ? model : of(p.truth_key);
    if (p.truth_modes)
        truth.make(from, [&] {
            return run_truth(p.references, scene, *p.truth_modes, jobs, listener, p.time_limit,
                             p.begin, p.effort, p.settles_whole);
        });
    // A size that the user asked for has no limit but the user's.
    const TimeLimit limit = p.truth_modes ? first_run(p.time_limit) : TimeLimit{p.time_limit};
    if (!p.truth_modes || (p.in_model && truth.truth()))
        model.make(from, [&] {
            Truth t;
            t.reference = run_reference(p.references, scene, jobs, listener, limit, p.alone);
            return t;
        });
    return {truth.truth(), model.truth() ? &model.truth()->reference : nullptr, &truth.floor(),
            truth.refused()};
}

void References::hold(const Point& p) { each_of(p, &Shared::hold); }
void References::release(const Point& p) { each_of(p, &Shared::release); }

}  // namespace jvari::bench::study

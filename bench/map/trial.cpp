#include "bench/map/trial.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/compare/compare.hpp"
#include "bench/store/records.hpp"
#include "bench/trust/kept_run.hpp"
#include "reference/certificate.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::map {

namespace {
using Json = nlohmann::ordered_json;

Settings reference_settings(const Descriptor& reference, const Trial& t) {
    Settings s;
    s.sample_rate = reference.clock == Clock::continuous ? 0 : 8 * t.settings.sample_rate;
    s.tap_rate = t.settings.tap_rate;
    s.modes = t.reference_modes > 0 ? t.reference_modes : t.settings.modes > 0 ? t.settings.modes : modes_for(t.scene, t.settings);
    return s;
}
}  // namespace

double row_rate(double rate) {
    return rate / std::max(1.0, std::round(rate / 44100));
}

Trial trial_of(const std::string& scene, const Descriptor& scheme, const std::string& reference, const std::vector<Assignment>& all,
               int reference_modes) {
    Trial t{&scheme, {}, {}, reference, reference_modes};
    std::vector<std::string> overrides;
    std::optional<double> duration;
    double amplitude = 1;
    t.settings.sample_rate = 44100;
    for (const auto& [key, value] : all) {
        if (key == "rate") t.settings.sample_rate = store::number_of(value);
        else if (key == "modes") t.settings.modes = static_cast<int>(store::number_of(value));
        else if (key == "duration") duration = store::number_of(value);
        else if (key == "amplitude") amplitude = store::number_of(value);
        else if (key.rfind("option:", 0) == 0) {
            const auto colon = key.find(':', 7);  // option:[SCHEME:]NAME
            if (colon == std::string::npos) t.settings.options.emplace_back(key.substr(7), value);
            else if (key.substr(7, colon - 7) == scheme.name) t.settings.options.emplace_back(key.substr(colon + 1), value);
        } else overrides.push_back(key + "=" + value);
    }
    t.settings.tap_rate = row_rate(t.settings.sample_rate);
    t.scene = moved(compare::load_scene(scene, overrides, duration), amplitude);
    return t;
}

std::string identity_of(const Trial& t) {
    Json options = Json::array();
    for (const auto& [name, value] : t.settings.options) options.push_back({name, value});
    return Json{{"scene", t.scene.name},
                {"scene_hash", scene_hash(t.scene)},
                {"scheme", t.scheme->name},
                {"rate", store::text_of(t.settings.sample_rate)},
                {"tap_rate", store::text_of(t.settings.tap_rate)},
                {"modes", t.settings.modes},
                {"options", options},
                {"reference", t.reference},
                {"reference_modes", t.reference_modes}}
        .dump();
}

const Truths::Truth& Truths::of(const Trial& t, const study::ProgressOf& progress) {
    static const Truth none;
    if (t.reference == "none") return none;
    const Descriptor& named = !t.reference.empty()            ? catalogue_.find(t.reference)
                              : catalogue_.references.empty() ? *t.scheme
                                                              : *catalogue_.references.front();
    const Settings s = reference_settings(named, t);
    const std::string key =
        Json{scene_hash(t.scene), t.reference, store::text_of(s.sample_rate), store::text_of(s.tap_rate), s.modes, s.options}.dump();
    Truth* truth;
    {
        const std::lock_guard lock(mutex_);
        auto& kept = truths_[key];
        if (!kept) kept = std::make_unique<Truth>();
        truth = kept.get();
    }
    std::call_once(truth->once, [&] { make(*truth, t, progress); });
    return *truth;
}

void Truths::make(Truth& truth, const Trial& t, const study::ProgressOf& progress) const {
    RunOptions options;
    options.progress = progress;
    std::vector<const Descriptor*> candidates = catalogue_.references;
    if (!t.reference.empty()) candidates = {&catalogue_.find(t.reference)};
    for (const Descriptor* d : candidates) try {
            if (!(needed_by(t.scene) - d->represents).empty()) continue;
            const Scene scene = listened(t.scene);
            const Settings s = reference_settings(*d, t);
            Run r = trust::kept_run(
                catalogue_.is_reference(*d) ? folder_ : "", trust::run_key(*d, scene, s), [&] { return run(*d, scene, s, options); }, 0);
            if (r.status.outcome != Outcome::ok) continue;
            truth.name = d->name;
            truth.trace = std::move(r.trace);
            return;
        } catch (const Refusal&) {
        }
}

Tried run_trial(const Trial& t, Truths& truths, const study::ProgressOf& progress) {
    Tried tried;
    const Scene scene = listened(t.scene);
    RunOptions probed;
    probed.energy = true;
    probed.progress = progress;
    try {
        const Run r = run(*t.scheme, scene, t.settings, probed);
        const Truths::Truth& truth = truths.of(t, progress);
        tried.steps = r.steps;
        tried.reference = truth.name;
        tried.figures = figures_of(*t.scheme, scene, r, truth.name.empty() ? nullptr : &truth.trace);
        tried.judgement = judge(tried.figures);
    } catch (const Refusal& e) {
        tried.figures = {{}, store::nan, store::nan, store::nan, store::nan, t.scheme->balance};
        tried.judgement = {Verdict::refused, e.what(), 0};
    }
    return tried;
}

}  // namespace jvari::bench::map

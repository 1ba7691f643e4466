#include "bench/suite/maps.hpp"

#include <algorithm>
#include <cmath>

#include "bench/compare/compare.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "reference/agreement.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"

namespace jvari::bench::suite {

namespace {
// Tap positions over the length: no low mode has a node at both.
constexpr double listening_points[] = {0.3, 0.437};

double worst_nut(const study::Errors& errors, const Scene& scene) {
    double worst = nan;
    for (std::size_t k = 0; k < errors.size(); ++k)
        if (scene.taps[k].quantity == Quantity::nut_force)
            worst = std::fmax(worst, errors[k][study::measure("error_l2_whole")]);
    return worst;
}
}  // namespace

double row_rate(double rate) { return rate / std::max(1.0, std::round(rate / 44100)); }

Trial trial_of(const std::string& scene, const Descriptor& scheme, const std::string& reference,
               const std::vector<Assignment>& all, int reference_modes) {
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
            // the text behind "option:"
            const auto o = compare::SchemeOption::of(key.substr(7), value);
            if (o.scheme.empty() || o.scheme == scheme.name)
                t.settings.options.emplace_back(o.name, o.value);
        } else overrides.push_back(key + "=" + value);
    }
    t.settings.tap_rate = row_rate(t.settings.sample_rate);
    t.scene = moved(compare::load_scene(scene, overrides, duration), amplitude);
    return t;
}

Scene listened(Scene scene) {
    scene.taps.clear();
    scene = unfiltered(std::move(scene));
    for (int k = 0; k < static_cast<int>(scene.strings.size()); ++k) {
        const double L = scene.strings[k].length;
        const std::string of = k == 0 ? "" : std::to_string(k);
        scene.taps.push_back({"y" + of, Quantity::displacement, k, listening_points[0] * L});
        scene.taps.push_back({"z" + of, Quantity::displacement, k, listening_points[1] * L});
        scene.taps.push_back({"nut" + of, Quantity::nut_force, k, 0});
    }
    return scene;
}

Trials::Trials(const compare::Catalogue& catalogue, const MapRequest& request)
    : catalogue_(catalogue), request_(request) {
    if (request.folder.empty()) return;
    keep_.folder = request.folder / "points";
    keep_.resume = request.resume;
    store::make_folder(keep_.folder);
    store::must_be_writable(keep_.folder / "any");
}

// References without stand-ins: if no reference represents the scene, a point is judged by its own
// figures.
std::vector<study::ReferenceChoice> Trials::references_of(const Trial& t) const {
    if (t.reference == "none") return {};
    Settings at = t.settings;
    at.options.clear();
    at.modes = t.reference_modes > 0  ? t.reference_modes
               : t.settings.modes > 0 ? t.settings.modes
                                      : modes_for(t.scene, t.settings);
    const bool named = !t.reference.empty();
    std::vector<study::ReferenceChoice> choices =
        study::references_of(t.scene, at, named ? &catalogue_.find(t.reference) : nullptr, nullptr);
    std::erase_if(choices, [&t](const auto& c) { return !represents(*c.scheme, t.scene); });
    for (study::ReferenceChoice& c : choices) {
        c.kept = c.kept && !request_.folder.empty();
        if (request_.resume) c.kept_in = request_.folder / "references";
    }
    return choices;
}

study::Plan Trials::plan_of(const Trial& t) const {
    study::Plan plan;
    study::Point& point = plan.points.emplace_back();
    point.scene = listened(t.scene);
    point.references = references_of(t);
    point.truth_modes = std::nullopt;
    point.alone = true;
    study::Job& job = plan.jobs.emplace_back(study::Job{&point, {t.scheme, t.settings}});
    job.judged = !point.references.empty();
    job.errors = {study::measure("error_l2_whole")};
    study::address(plan, request_.program);
    return plan;
}

std::optional<Tried> Trials::operator()(const Trial& t, bool wait) {
    const study::Plan plan = plan_of(t);
    const study::Job& job = plan.jobs.front();
    if (job.judged) references_.hold(*job.point);
    const auto r = study::record_of(
        job, references_, keep_, [](long, long) { store::throw_if_cancelled(); }, wait);
    if (!r) return {};
    const double error = worst_nut(r->cell.errors, job.point->scene);
    return Tried{*r, error, study::judge(r->cell, error)};
}

}  // namespace jvari::bench::suite

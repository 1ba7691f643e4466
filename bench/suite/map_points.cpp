#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/suite/maps.hpp"
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

// References without stand-ins: if no reference represents the scene, a point is judged by its own
// figures.
study::Point judged_point(const compare::Catalogue& catalogue, Scene scene, const Settings& of,
                          const std::string& reference, int reference_modes) {
    study::Point point;
    point.scene = listened(std::move(scene));
    point.truth_modes = std::nullopt;
    point.alone = true;
    if (reference == "none") return point;
    Settings at = of;
    at.options.clear();
    at.modes = reference_modes > 0 ? reference_modes
               : of.modes > 0      ? of.modes
                                   : modes_for(point.scene, of);
    point.references = study::references_of(
        point.scene, at, reference.empty() ? nullptr : &catalogue.find(reference), nullptr);
    std::erase_if(point.references,
                  [&](const auto& c) { return !represents(*c.scheme, point.scene); });
    return point;
}

study::Job judged_job(const Descriptor& scheme, const study::Point& point,
                      const Settings& settings) {
    study::Job job{&point, {&scheme, settings}};
    job.judged = !point.references.empty();
    job.errors = {study::measure("error_l2_whole")};
    return job;
}

MapPoint::MapPoint(const study::Job& of, study::Record r)
    : job(&of),
      record(std::move(r)),
      error(worst_nut(record.cell.errors, of.point->scene)),
      judgement(study::judge(record.cell, error)) {}

const std::pair<std::string, std::string>& swept_at(const MapPoint& p, std::size_t key) {
    static const std::pair<std::string, std::string> none;
    const auto& swept = p.job->point->swept;
    return key < swept.size() ? swept[key] : none;
}

store::Table maps_table(const MapRun& run) {
    store::Table t{{"map", "scene", "scheme", "x_key", "x", "y_key", "y", "outcome", "detail",
                    "reference", "largest_over_bound", "energy_gain", "pull", "error"},
                   {}};
    for (const MapPoint& p : run.points) {
        const study::Cell& cell = p.record.cell;
        const study::Summary& s = cell.summary;
        const auto number = [&cell](double x) { return cell.ran() ? x : nan; };
        const auto& [x_key, x] = swept_at(p, 0);
        const auto& [y_key, y] = swept_at(p, 1);
        t.rows.push_back({run.map_of(p).name, run.map_of(p).scenes.front(), cell.scheme->name,
                          x_key, store::Field::as_written(x), y_key, store::Field::as_written(y),
                          name_of(p.judgement.verdict), p.judgement.detail,
                          cell.ran() ? p.record.against.reference : "",
                          number(s.largest_over_bound), number(s.energy_gain),
                          number(study::pull_of(s.smallest_contact_force, s.largest_contact_force)),
                          number(p.error)});
    }
    return t;
}

}  // namespace jvari::bench::suite

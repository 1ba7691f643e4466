#include "bench/suite/maps.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "bench/store/encoding.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::suite {

namespace {
std::vector<const Descriptor*> schemes_of(const Map& m, const compare::Catalogue& catalogue) {
    std::vector<const Descriptor*> chosen;
    for (const std::string& name : m.schemes) chosen.push_back(&catalogue.find(name));
    if (!chosen.empty()) return chosen;
    const Scene scene = compare::load_scene(m.scene, {}, std::nullopt);
    for (const Descriptor* d : catalogue.schemes)
        if (represents(*d, scene)) chosen.push_back(d);
    if (chosen.empty())
        throw store::UsageError(
            fmt::format("map {}: no scheme represents scene {}", m.name, m.scene));
    return chosen;
}

std::vector<PointPlace> places_of(const std::vector<Map>& maps,
                                  const compare::Catalogue& catalogue) {
    std::vector<PointPlace> places;
    for (const Map& m : maps) {
        if (!m.reference.empty() && m.reference != "none") catalogue.find(m.reference);
        const std::vector<std::string> ys =
            m.y.values.empty() ? std::vector<std::string>{""} : m.y.values;
        for (const Descriptor* d : schemes_of(m, catalogue))
            for (const std::string& y : ys)
                for (const std::string& x : m.x.values) places.push_back({&m, d, x, y});
    }
    return places;
}

std::string axis_text(const MapAxis& axis, double x) {
    return axis.whole ? std::to_string(std::lround(x)) : store::text_of(x);
}

// Boundary from theory: the change of sign in the margin along the axis, found by bisection. The
// search starts at the first point that the theory covers.
double theory_along(const PointPlace& row) {
    const MapAxis& axis = row.map->x;
    if (row.map->theory.empty() || axis.at.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto side = [&row](double x) {
        const Trial t = trial_at({row.map, row.scheme, axis_text(row.map->x, x), row.y});
        const double margin = theory_margin(row.map->theory, *t.scheme, t.scene, t.settings);
        return std::isnan(margin) ? study::Verdict::refused
               : margin > 0       ? study::Verdict::sound
                                  : study::Verdict::diverged;
    };
    std::size_t first = 0;
    while (first + 1 < axis.at.size() && side(axis.at[first]) == study::Verdict::refused) ++first;
    const Bracket ends{axis.at[first], axis.at.back(), side(axis.at[first]), side(axis.at.back())};
    if (ends.at_low == ends.at_high || ends.at_low == study::Verdict::refused ||
        ends.at_high == study::Verdict::refused)
        return std::numeric_limits<double>::quiet_NaN();
    const Bracket b = bisect(ends, 60, axis.whole, side);
    return 0.5 * (b.low + b.high);
}
// Compares the theory with the nearest boundary of stability in each row.
void compare_with_theory(std::vector<Boundary>& all) {
    for (std::size_t i = 0; i < all.size();) {
        std::size_t end = i;
        while (end < all.size() && all[end].map == all[i].map && all[end].scheme == all[i].scheme &&
               all[end].y == all[i].y)
            ++end;
        const double theory = theory_along({all[i].map, all[i].scheme, "", all[i].y});
        const auto distance = [theory](const Boundary& b) {
            if (study::is_stable(b.low) == study::is_stable(b.high)) return HUGE_VAL;
            return std::abs(0.5 * (store::number_of(b.x_low) + store::number_of(b.x_high)) -
                            theory);
        };
        const auto nearest = std::min_element(
            all.begin() + static_cast<long>(i), all.begin() + static_cast<long>(end),
            [&](const Boundary& a, const Boundary& b) { return distance(a) < distance(b); });
        if (distance(*nearest) < HUGE_VAL) nearest->theory = theory;
        i = end;
    }
}

// Indices of points whose verdict differs from the next point's in the same row.
std::vector<std::size_t> changes_in(const std::vector<PointPlace>& places,
                                    const std::vector<Tried>& tried) {
    std::vector<std::size_t> changes;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const PointPlace &p = places[i], &q = places[i + 1];
        const bool same_row = p.map == q.map && p.scheme == q.scheme && p.y == q.y;
        if (same_row && !p.map->x.at.empty() &&
            tried[i].judgement.verdict != tried[i + 1].judgement.verdict)
            changes.push_back(i);
    }
    return changes;
}
}  // namespace

Trial trial_at(const PointPlace& p) {
    std::vector<Assignment> all = p.map->fixed;
    all.emplace_back(p.map->x.key, p.x);
    if (!p.map->y.key.empty()) all.emplace_back(p.map->y.key, p.y);
    try {
        return trial_of(p.map->scene, *p.scheme, p.map->reference, all, p.map->reference_modes);
    } catch (const store::UsageError& e) {
        throw store::UsageError("map " + p.map->name + ": " + e.what());
    }
}

double Boundary::relative_difference() const {
    return 0.5 * (store::number_of(x_low) + store::number_of(x_high)) / theory - 1;
}

MapRun run_maps(const std::vector<Map>& maps, const compare::Catalogue& catalogue,
                const MapRequest& request, const store::Listener& listener) {
    if (maps.empty()) return {};  // makes no folder
    const std::vector<PointPlace> places = places_of(maps, catalogue);
    // reports wrong scenes and keys before anything runs
    for (const PointPlace& p : places) trial_at(p);
    Trials trials(catalogue, request);
    std::vector<Tried> tried(places.size());
    store::side_by_side(std::vector<double>(places.size(), 1), request.jobs, listener, "points",
                        [&](std::size_t i, store::Done& done) {
                            if (auto t = trials(trial_at(places[i]), done.may_wait()))
                                tried[i] = std::move(*t);
                            else done.postpone();
                        });

    const std::vector<std::size_t> changes = changes_in(places, tried);
    MapRun result;
    result.boundaries.resize(changes.size());
    std::vector<int> bisections(changes.size());
    store::side_by_side(
        std::vector<double>(changes.size(), 1), request.jobs, listener, "boundaries",
        [&](std::size_t i, store::Done& done) {
            const PointPlace &low = places[changes[i]], &high = places[changes[i] + 1];
            const study::Verdict at_low = tried[changes[i]].judgement.verdict,
                                 at_high = tried[changes[i] + 1].judgement.verdict;
            const MapAxis& axis = low.map->x;
            std::filesystem::path file;  // names the lock; empty: no lock
            if (!request.folder.empty())
                file = request.folder / "points" /
                       store::hash_of(trials.plan_of(trial_at(low)).jobs.front().id +
                                      trials.plan_of(trial_at(high)).jobs.front().id);
            const store::FileLock lock(file, "finds a boundary of " + low.map->name,
                                       done.may_wait());
            if (lock.elsewhere()) return done.postpone();
            const Bracket b =
                bisect({store::number_of(low.x), store::number_of(high.x), at_low, at_high},
                       low.map->refine, axis.whole, [&](double x) {
                           PointPlace at = low;
                           at.x = axis_text(axis, x);
                           ++bisections[i];
                           return trials(trial_at(at)).judgement.verdict;
                       });
            result.boundaries[i] = {low.map,
                                    low.scheme,
                                    low.y,
                                    b.at_low,
                                    b.at_high,
                                    axis_text(axis, b.low),
                                    axis_text(axis, b.high),
                                    std::numeric_limits<double>::quiet_NaN()};
        });
    for (std::size_t i = 0; i < places.size(); ++i)
        result.points.push_back({places[i], std::move(tried[i])});
    compare_with_theory(result.boundaries);
    result.ran = trials.ran();
    result.read_back =
        std::accumulate(bisections.begin(), bisections.end(), static_cast<int>(places.size())) -
        result.ran;
    return result;
}

namespace {
constexpr const char* nyquist = "nyquist";

double nyquist_margin(const Scene& scene, const Settings& settings) {
    double fastest = 0;  // largest omega^2 over the modes of all strings [rad^2/s^2]
    for (const String& s : scene.strings) {
        const Modes modes = modes_of(s, modes_for(s, settings));
        fastest = std::max(fastest, omega_squared_damped(modes.omega0.back(), modes.sigma.back()));
    }
    return 0.5 * settings.sample_rate * 2 * std::numbers::pi / std::sqrt(fastest) - 1;
}
}  // namespace

std::vector<std::string> theories() {
    std::vector<std::string> names{nyquist};
    for (const Descriptor& d : schemes())
        if (d.limit.name && std::find(names.begin(), names.end(), d.limit.name) == names.end())
            names.emplace_back(d.limit.name);
    return names;
}

std::string motion_of(const std::string& theory) {
    if (theory == "grid_limit") return "any motion: it is of the grid alone";
    if (theory == "penalty_limit")
        return "lasting contact; where the string parts from the barrier, failures were seen to "
               "begin 16 to 71 % off";
    return "any motion: it is of the highest mode alone";
}

double theory_margin(const std::string& name, const Descriptor& d, const Scene& scene,
                     const Settings& settings) {
    if (name == nyquist) return nyquist_margin(scene, settings);
    return d.limit.name && name == d.limit.name ? margin_of(d, scene, settings)
                                                : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jvari::bench::suite

#include "bench/map/map_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/map/map_theory.hpp"
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/outcome_name.hpp"
#include "bench/store/records.hpp"
#include "bench/store/side_by_side.hpp"
#include "bench/store/whole.hpp"

namespace jvari::bench::map {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json number(double x) {  // JSON has no NaN and no infinity
    return store::text_of(x);
}

std::string json_of(const Tried& t, const std::string& identity) {
    return store::sealed(Json{
        {"point", Json::parse(identity)},
        {"outcome", name_of(t.judgement.verdict)},
        {"detail", t.judgement.detail},
        {"step", t.judgement.step},
        {"status", name_of(t.figures.status.outcome)},
        {"displacement", number(t.figures.displacement)},
        {"energy_gain", number(t.figures.energy_gain)},
        {"pull", number(t.figures.pull)},
        {"error", number(t.figures.error)},
        {"reference", t.reference},
        {"steps", t.steps}}.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Verdict verdict_named(const std::string& name) {
    for (const Verdict v : verdicts())
        if (name == name_of(v)) return v;
    throw std::runtime_error("unknown outcome " + name);
}

std::optional<Tried> read_back(const fs::path& path, const std::string& identity) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return std::nullopt;
    try {
        const Json j = Json::parse(store::unsealed(store::read_whole(path)));
        if (j.at("point") != Json::parse(identity)) return std::nullopt;
        Tried t;
        t.judgement = {verdict_named(j.at("outcome")), j.at("detail"), store::whole<long>(j.at("step"))};
        t.figures.status = {store::outcome_named(j.at("status")), store::whole<long>(j.at("step"))};
        t.figures.displacement = store::number_of(j.at("displacement"));
        t.figures.energy_gain = store::number_of(j.at("energy_gain"));
        t.figures.pull = store::number_of(j.at("pull"));
        t.figures.error = store::number_of(j.at("error"));
        t.reference = j.at("reference");
        t.steps = store::whole<long>(j.at("steps"));
        return t;
    } catch (const std::exception&) {  // Json::exception, UsageError, what unsealed() throws
        return std::nullopt;
    }
}

class Laboratory {  // tries points, and keeps what came of them
public:
    Laboratory(Truths& truths, std::string program, fs::path folder, bool resume)
        : truths_(truths), program_(std::move(program)), folder_(std::move(folder)), resume_(resume) {}

    Tried operator()(const PointPlace& at) {
        const Trial trial = trial_at(at);
        const std::string identity = Json{{"program", program_}, {"trial", Json::parse(identity_of(trial))}}.dump();
        const fs::path file = folder_ / (store::hash_of(identity) + ".json");
        if (resume_ && !folder_.empty())
            if (auto kept = read_back(file, identity)) {
                ++kept_;
                kept->figures.balance = at.scheme->balance;
                return *kept;
            }
        Tried tried = run_trial(trial, truths_);
        ++ran_;
        if (!folder_.empty()) {
            const std::lock_guard lock(writing_);  // two maps can hold the same point
            store::write_fresh(file, json_of(tried, identity));
        }
        return tried;
    }

    int ran() const { return ran_; }
    int kept() const { return kept_; }

private:
    Truths& truths_;
    const std::string program_;
    const fs::path folder_;
    const bool resume_;
    std::mutex writing_;
    std::atomic<int> ran_ = 0, kept_ = 0;
};

std::vector<const Descriptor*> schemes_of(const Map& m, const compare::Catalogue& catalogue) {
    std::vector<const Descriptor*> chosen;
    for (const std::string& name : m.schemes) chosen.push_back(&catalogue.find(name));
    if (!chosen.empty()) return chosen;
    const Scene scene = compare::load_scene(m.scene, {}, std::nullopt);
    for (const Descriptor* d : catalogue.schemes)
        if ((needed_by(scene) - d->represents).empty()) chosen.push_back(d);
    if (chosen.empty()) throw store::UsageError(fmt::format("map {}: no scheme represents scene {}", m.name, m.scene));
    return chosen;
}

std::string axis_text(const MapAxis& axis, double x) {
    return axis.whole ? std::to_string(std::lround(x)) : store::text_of(x);
}

// Where the theory's margin changes its sign between the ends of the axis.
double theory_along(const PointPlace& row) {
    const MapAxis& axis = row.map->x;
    if (row.map->theory.empty() || axis.at.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto side = [&row](double x) {
        const Trial t = trial_at({row.map, row.scheme, axis_text(row.map->x, x), row.y});
        const double margin = theory_margin(row.map->theory, *t.scheme, t.scene, t.settings);
        return std::isnan(margin) ? Verdict::refused : margin > 0 ? Verdict::sound : Verdict::diverged;
    };
    const Bracket ends{axis.at.front(), axis.at.back(), side(axis.at.front()), side(axis.at.back())};
    if (ends.at_low == ends.at_high || ends.at_low == Verdict::refused || ends.at_high == Verdict::refused)
        return std::numeric_limits<double>::quiet_NaN();
    const Bracket b = bisect(ends, 60, axis.whole, side);
    return 0.5 * (b.low + b.high);
}
// The theory of a row is held against the nearest of the boundaries of soundness in the row.
void compare_with_theory(std::vector<Boundary>& all) {
    for (std::size_t i = 0; i < all.size();) {
        std::size_t end = i;
        while (end < all.size() && all[end].map == all[i].map && all[end].scheme == all[i].scheme && all[end].y == all[i].y) ++end;
        const double theory = theory_along({all[i].map, all[i].scheme, "", all[i].y});
        const auto distance = [theory](const Boundary& b) {
            if (b.low != Verdict::sound && b.high != Verdict::sound) return HUGE_VAL;
            return std::abs(0.5 * (store::number_of(b.x_low) + store::number_of(b.x_high)) - theory);
        };
        const auto nearest = std::min_element(all.begin() + static_cast<long>(i), all.begin() + static_cast<long>(end),
                                              [&](const Boundary& a, const Boundary& b) { return distance(a) < distance(b); });
        if (distance(*nearest) < HUGE_VAL) nearest->theory = theory;
        i = end;
    }
}
}  // namespace

Trial trial_at(const PointPlace& p) {
    std::vector<Assignment> all = p.map->fixed;
    all.emplace_back(p.map->x.key, p.x);
    if (!p.map->y.key.empty()) all.emplace_back(p.map->y.key, p.y);
    try {
        return trial_of(p.map->scene, *p.scheme, p.map->reference, all);
    } catch (const store::UsageError& e) {
        throw store::UsageError("map " + p.map->name + ": " + e.what());
    }
}

double Boundary::relative_difference() const {
    return 0.5 * (store::number_of(x_low) + store::number_of(x_high)) / theory - 1;
}

MapRun run_maps(const std::vector<Map>& maps, Truths& truths, const std::string& program, const fs::path& folder, bool resume, int jobs,
                const store::Listener& listener) {
    MapRun result;
    for (const Map& m : maps) {
        if (!m.reference.empty() && m.reference != "none") truths.catalogue().find(m.reference);
        const auto schemes = schemes_of(m, truths.catalogue());
        const std::vector<std::string> rows = m.y.values.empty() ? std::vector<std::string>{""} : m.y.values;
        for (const Descriptor* d : schemes)
            for (const std::string& y : rows)
                for (const std::string& x : m.x.values) result.points.push_back({{&m, d, x, y}, {}});
    }
    for (const JudgedPoint& p : result.points) trial_at(p.at);  // scenes and keys that are none are said before anything runs
    Laboratory laboratory(truths, program, folder, resume);
    store::side_by_side(std::vector<double>(result.points.size(), 1), jobs, listener, "points",
                        [&](std::size_t i, store::Done&) { result.points[i].tried = laboratory(result.points[i].at); });

    struct Pair {
        const JudgedPoint *low, *high;
    };
    std::vector<Pair> changes;
    for (std::size_t i = 0; i + 1 < result.points.size(); ++i) {
        const JudgedPoint &p = result.points[i], &q = result.points[i + 1];
        const bool same_row = p.at.map == q.at.map && p.at.scheme == q.at.scheme && p.at.y == q.at.y;
        if (same_row && !p.at.map->x.at.empty() && p.tried.judgement.verdict != q.tried.judgement.verdict) changes.push_back({&p, &q});
    }
    std::vector<std::optional<Boundary>> found(changes.size());
    store::side_by_side(std::vector<double>(changes.size(), 1), jobs, listener, "boundaries", [&](std::size_t i, store::Done&) {
        const JudgedPoint *low = changes[i].low, *high = changes[i].high;  // clang 14 captures no structured binding
        const MapAxis& axis = low->at.map->x;
        const Bracket b =
            bisect({store::number_of(low->at.x), store::number_of(high->at.x), low->tried.judgement.verdict, high->tried.judgement.verdict},
                   low->at.map->refine, axis.whole, [&](double x) {
                       PointPlace at = low->at;
                       at.x = axis_text(axis, x);
                       return laboratory(at).judgement.verdict;
                   });
        found[i] = Boundary{low->at.map,
                            low->at.scheme,
                            low->at.y,
                            b.at_low,
                            b.at_high,
                            axis_text(axis, b.low),
                            axis_text(axis, b.high),
                            std::numeric_limits<double>::quiet_NaN()};
    });
    for (auto& b : found) result.boundaries.push_back(std::move(*b));
    compare_with_theory(result.boundaries);
    result.ran = laboratory.ran();
    result.read_back = laboratory.kept();
    return result;
}

}  // namespace jvari::bench::map

#include "bench/suite/facet.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bench/store/base64.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/system/memo.hpp"
#include "reference/references.hpp"
#include "scenes/barrier.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::suite {

namespace {
constexpr double window = 0.03;           // [s] from the start
constexpr int frames = 120, places = 48;  // in time, along the string
constexpr double around = 2.5;            // half of the places lie up to so many times the farthest point of a barrier
const std::vector<std::string> columns{"from_s", "step_s", "positions", "scales", "shape", "force_scale", "force", "obstacle"};

std::vector<std::array<double, 2>> obstacle_of(const String& s) {  // position and height of points of the barriers
    std::vector<std::array<double, 2>> points;
    for (const Barrier& b : s.barriers)
        if (const auto* point = std::get_if<LumpedBarrier>(&b)) {
            points.push_back({point->position - 0.5 * point->width, point->height});
            points.push_back({point->position + 0.5 * point->width, point->height});
        } else if (const auto* profile = std::get_if<ProfileBarrier>(&b)) {
            const auto x = middles(*profile, 24);
            const auto height = heights(profile->curve, x);
            for (std::size_t k = 0; k < x.size(); ++k) points.push_back({x[k], height[k]});
        }
    std::ranges::sort(points);
    return points;
}

std::vector<double> positions_of(const String& s) {
    const auto obstacle = obstacle_of(s);
    const double near = obstacle.empty() ? 0 : around * obstacle.back()[0], border = near < 0.6 * s.length ? near : 0;
    std::vector<double> x;
    const int inner = border > 0 ? places / 2 : 0;
    for (int i = 0; i < inner; ++i) x.push_back(border * i / inner);
    for (int i = inner; i < places; ++i) x.push_back(border + (s.length - border) * (i - inner) / (places - 1 - inner));
    return x;
}

Scene filmed(Scene scene) {
    scene.duration = std::min(scene.duration, window);
    scene.taps.clear();
    for (const double x : positions_of(scene.strings[0]))
        scene.taps.push_back({fmt::format("at_{}", scene.taps.size()), Quantity::displacement, 0, x});
    if (!scene.strings[0].barriers.empty()) scene.taps.push_back({"force", Quantity::bridge_force, 0, 0});
    return scene;
}

std::string base64_of(const std::vector<double>& x, double scale) {
    std::vector<std::int16_t> samples;
    for (const double v : x) samples.push_back(static_cast<std::int16_t>(std::lround(std::clamp(v / scale, -1.0, 1.0) * 32767)));
    return store::base64(samples);
}

double peak_of(std::span<const double> x) {
    double most = 1e-12;
    for (const double v : x) most = std::fmax(most, std::abs(v));
    return most;
}

std::vector<std::string> row_of(const Scene& scene, const Trace& t) {
    const long stride = std::max(1L, std::lround(scene.duration * t.tap_rate / frames));
    std::string positions, scales, obstacle;
    std::vector<double> scale, shape, force;
    const auto list = [](std::string& text, const std::string& one) { text += (text.empty() ? "" : " ") + one; };
    for (int i = 0; i < places; ++i) {
        scale.push_back(peak_of(t.column(i)));
        list(positions, fmt::format("{:.6g}", scene.taps[static_cast<std::size_t>(i)].position));
        list(scales, fmt::format("{:.6g}", scale.back()));
    }
    for (long row = 0; row < t.rows; row += stride) {
        for (int i = 0; i < places; ++i) shape.push_back(t.column(i)[row] / scale[static_cast<std::size_t>(i)]);
        if (t.taps() > places) {  // the strongest since the last frame: touches are short
            const auto since = t.column(places).subspan(static_cast<std::size_t>(std::max(0L, row - stride + 1)),
                                                        static_cast<std::size_t>(std::min(stride, row + 1)));
            force.push_back(*std::ranges::max_element(since, {}, [](double f) { return std::abs(f); }));
        }
    }
    for (const auto& [x, height] : obstacle_of(scene.strings[0])) list(obstacle, fmt::format("{:.6g}:{:.6g}", x, height));
    const double most = peak_of(force);
    return {"0",
            fmt::format("{:.8g}", static_cast<double>(stride) / t.tap_rate),
            positions,
            scales,
            base64_of(shape, 1),
            fmt::format("{:.6g}", most),
            base64_of(force, most),
            obstacle};
}
}  // namespace

store::Table motion_rows(const MeasuredCell& c) {
    store::Table t{columns, {}};
    for (const std::string& name : columns) t.columns.push_back("reference_" + name);
    const Scene scene = filmed(c.scene);
    const Run own = run(c.scheme, scene, c.settings);
    if (own.status.outcome != Outcome::ok) return t;
    std::vector<std::string> row = row_of(scene, own.trace), theirs(columns.size());
    if (const Descriptor* reference = c.reference ? best_reference(scene) : nullptr) {
        const Settings settings = beside(c, *reference);
        static store::Memo<Run> references;  // all cells of a scene share theirs
        const std::string key = fmt::format("{} {} {} {} {}", reference->name, scene_hash(scene), settings.tap_rate, settings.modes,
                                            store::options_text(settings.options));
        const Run& r = references.get(key, [&] { return run(*reference, scene, settings); });
        if (r.status.outcome == Outcome::ok) theirs = row_of(scene, r.trace);
    }
    row.insert(row.end(), theirs.begin(), theirs.end());
    t.rows.push_back(std::move(row));
    return t;
}

void write_motion(const std::filesystem::path& folder, const store::Table& g) {
    const auto who = static_cast<std::size_t>(g.column("from_s"));
    store::Table t{{g.columns.begin(), g.columns.begin() + static_cast<long>(who + columns.size())}, {}};
    std::set<std::string> seen;
    for (const auto& row : g.rows) {
        std::vector<std::string> own(row.begin(), row.begin() + static_cast<long>(t.columns.size())),
            reference(row.begin(), row.begin() + static_cast<long>(who));
        reference.insert(reference.end(), row.begin() + static_cast<long>(t.columns.size()), row.end());
        for (const char* column : {"cell", "options", "rate", "modes"})
            if (const int k = t.column(column); k >= 0) reference[static_cast<std::size_t>(k)].clear();
        reference[static_cast<std::size_t>(t.column("scheme"))] = "reference";
        if (const std::string& shape = reference[static_cast<std::size_t>(t.column("shape"))]; !shape.empty() && seen.insert(shape).second)
            t.rows.push_back(std::move(reference));
        t.rows.push_back(std::move(own));
    }
    store::write_fresh(folder / "motion.csv", store::csv(t));
}

}  // namespace jvari::bench::suite

#include "bench/study/cells.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/store/records.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/study/cell.hpp"
#include "bench/study/judgement.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::study {

namespace {
int modes_used(const Scene& scene, const Settings& settings, const std::vector<Fact>& facts) {
    if (const double n = fact_of(facts, facts::interior_nodes); n == n) return static_cast<int>(n);
    if (const double n = fact_of(facts, facts::grid_intervals); n == n)
        return static_cast<int>(n) - 1;
    return modes_for(scene, settings);
}
}  // namespace

Summary summary_of(const Descriptor& d, const Scene& scene, const Settings& settings,
                   const Run& run) {
    Summary s{};
    static_cast<Figures&>(s) = figures_of(d.balance, scene, modes_for(scene, settings), run);
    const bool continuous = d.clock == Clock::continuous;
    s.scheme = d.name;
    s.scene = scene.name;
    s.rate = continuous ? nan : settings.sample_rate;
    s.modes = modes_used(scene, settings, run.facts);
    s.dofs = run.dofs;
    s.steps = run.steps;
    s.rows = run.trace.rows;
    s.duration = run.trace.rows > 1 ? (run.trace.rows - 1) / run.trace.tap_rate : 0;
    s.wall_seconds = run.wall_seconds;
    s.ns_per_step = run.steps > 0 ? run.wall_seconds * 1e9 / run.steps : nan;
    s.times_real_time = run.wall_seconds > 0 ? s.duration / run.wall_seconds : nan;
    return s;
}

std::string Cell::status() const {
    return !ran() ? failure : !needed ? "not_needed" : name_of(summary.status.outcome);
}

Trace run_cell(Cell& cell, const Scene& scene, bool heard, const ProgressOf& progress) {
    const Scene read = heard ? heard_too(*cell.scheme, scene) : scene;
    const auto scheme = make_scheme(*cell.scheme, read, cell.settings);
    const double from = store::processor_seconds();
    Run result = run(*scheme, read, cell.settings, {.energy = true, .progress = progress});
    const double took = store::processor_seconds() - from;
    result.trace.names.resize(scene.taps.size());
    cell.summary = summary_of(*cell.scheme, scene, cell.settings, result);
    cell.summary.processor_seconds = took;
    if (result.status.outcome != Outcome::ok)
        cell.reason = fmt::format("{} at step {}, after {:.6g} s", name_of(result.status.outcome),
                                  result.status.step, cell.summary.duration);
    return std::move(result.trace);
}

void fail(Cell& cell, const std::exception& e) {
    // BadScene: the scene is impossible with these modes.
    const bool refused = dynamic_cast<const Refusal*>(&e) || dynamic_cast<const BadScene*>(&e);
    cell.failure = refused                                        ? "refused"
                   : dynamic_cast<const store::PastItsLimit*>(&e) ? "past_time_limit"
                                                                  : "error";
    cell.reason = e.what();
}

const Figure& TabledCell::figure(std::size_t measure, const std::string& tap) const {
    static const Figure nothing;
    const std::string& name = !tap.empty()                 ? tap
                              : measures()[measure].bridge ? headline_bridge
                                                           : headline_nut;
    const auto found = std::ranges::find(taps, name);
    return found == taps.end() ? nothing : figures[found - taps.begin()][measure];
}

double TabledCell::fact(const std::string& name) const {
    const auto found = std::ranges::find(facts, name, &std::pair<std::string, double>::first);
    return found == facts.end() ? nan : found->second;
}

std::string TabledCell::problem() const {
    std::string text = scene;
    for (const auto& [key, value] : swept) text += fmt::format(", {} = {}", key, value);
    return text;
}

std::string TabledCell::run() const {
    std::string name = variant();
    if (!(fact(facts::grid_intervals.name) > 0) && !std::isnan(modes))
        name += fmt::format(", {} modes", modes);
    return std::isnan(rate) ? name : name + fmt::format(" at {:.4g} kHz", rate / 1000);
}

// ---- Records to cells

namespace {
Figure figure_of(const Record& r, std::size_t tap, std::size_t measure) {
    const Against& a = r.against;
    const auto in = [&](const Errors& e) { return tap < e.size() ? e[tap][measure] : nan; };
    Figure f{in(r.cell.errors), measures()[measure].less_is_better ? in(a.floor) : nan, nan,
             in(r.cell.in_model), nan};
    const auto window =
        std::ranges::find(Trust::columns, "certificate" + measures()[measure].column.substr(5));
    if (window == Trust::columns.end()) return f;
    const auto w = static_cast<std::size_t>(window - Trust::columns.begin());
    f.certificate = a.trust.of_scene(tap, w);
    f.certificate_in_model = a.model_trust.in_model(tap, w);
    return f;
}

// Headline errors below the noise floor, which is the reference's sensitivity to a change by 1e-12.
std::string ties_of(const TabledCell& c) {
    std::string ties;
    for (std::size_t m = 0; m < measures().size(); ++m)
        if (c.figure(m).value <= c.figure(m).floor)
            ties += (ties.empty() ? "" : " ") + measures()[m].column;
    return ties;
}

void add_clock(TabledCell& c, const Cell& cell) {
    const Timing& t = cell.clock;
    c.machine = t.stamp.name, c.load = t.stamp.load, c.governor = t.stamp.governor;
    if (t.wall.count == 0) {
        c.untimed = cell.scheme->untimed;
        return;
    }
    c.repeats = t.wall.count;
    if (!(t.wall.median > 0)) return;
    const double seconds = cell.summary.duration > 0 ? cell.summary.duration : nan;
    const auto put = [](const Spread& s, double over, double& median, double& lower,
                        double& upper) {
        median = s.median / over;
        lower = s.lower / over;
        upper = s.upper / over;
    };
    put(t.wall, seconds, c.cost_s_per_s, c.cost_lower, c.cost_upper);
    put(t.processor, seconds, c.processor_s_per_s, c.processor_lower, c.processor_upper);
    put(t.wall, 1, c.wall_seconds, c.wall_seconds_lower, c.wall_seconds_upper);
    if (cell.summary.steps > 0)
        c.ns_per_step = t.wall.median * 1e9 / static_cast<double>(cell.summary.steps);
    c.times_real_time = seconds / t.wall.median;
    c.worst_block_of_deadline = t.worst_block;
}

void add_run(TabledCell& c, const Cell& cell) {
    const Summary& s = cell.summary;
    c.flags = names_of(flags_of(s));
    c.energy_residual_per_step = s.energy_residual_per_step;
    c.energy_residual_accumulated = s.energy_residual_accumulated;
    c.smallest_contact_force = s.smallest_contact_force;
    c.deepest_penetration = s.deepest_penetration;
    c.dofs = s.dofs;
    c.state_bytes = 8.0 * s.dofs;
    c.steps = static_cast<double>(s.steps);
    if (s.status.outcome != Outcome::ok) {
        c.failed_step = static_cast<double>(s.status.step);
        c.failed_at_s = s.duration;
    }
    for (const Fact& f : s.facts) c.facts.emplace_back(f.name, fact_of(s.facts, f.name));
    add_clock(c, cell);
}

TabledCell cell_of(const Job& job, const Record& r) {
    const Scene& scene = job.point->scene;
    const Headline headline = headline_of(scene);
    TabledCell c;
    c.cell = job.id;
    c.scene = scene.name;
    c.swept = job.point->swept;
    c.scheme = r.cell.scheme->name;
    c.options = r.cell.settings.options;
    if (r.cell.scheme->clock != Clock::continuous) c.rate = r.cell.settings.sample_rate;
    if (r.cell.modes() > 0) c.modes = r.cell.modes();
    c.status = r.cell.status();
    c.reason = r.cell.reason;
    c.cause = r.cell.cause;
    c.reference = r.against.reference;
    c.reference_doubling = r.against.doubling;
    if (r.against.modes > 0) c.reference_modes = r.against.modes;
    c.free_from_s = free_from(scene);
    c.reference_horizon_s = horizon_of(r.against.floor, headline);
    if (job.judged)
        for (const Tap& tap : scene.taps) c.taps.push_back(tap.name);
    if (!c.taps.empty()) {
        c.headline_nut = c.taps[static_cast<std::size_t>(headline.nut)];
        c.headline_bridge = c.taps[static_cast<std::size_t>(headline.bridge)];
    }
    for (std::size_t tap = 0; tap < c.taps.size(); ++tap) {
        auto& row = c.figures.emplace_back();
        for (std::size_t m = 0; m < measures().size(); ++m) row.push_back(figure_of(r, tap, m));
    }
    if (r.cell.ran()) add_run(c, r.cell);
    if (!std::isnan(r.against.limit_hz)) c.facts.emplace_back(reference_limit, r.against.limit_hz);
    c.below_floor = ties_of(c);
    return c;
}
}  // namespace

Cells cells_of(const Plan& plan, const std::vector<Record>& records) {
    Cells cells;
    for (std::size_t i = 0; i < records.size(); ++i)
        cells.push_back(cell_of(plan.jobs[i], records[i]));
    return cells;
}

// ---- Groups

Rows all_rows(const Cells& cells) {
    Rows rows(cells.size());
    std::iota(rows.begin(), rows.end(), 0);
    return rows;
}

std::vector<Rows> by_problem(const Cells& cells, const Rows& rows) {
    return alike(rows, [&](std::size_t i) { return cells[i].problem(); });
}

std::vector<std::string> swept_keys(const Cells& cells) {
    std::vector<std::string> keys;
    for (const TabledCell& c : cells)
        for (const auto& [key, value] : c.swept)
            if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    return keys;
}

}  // namespace jvari::bench::study

#include "bench/study/cost.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "bench/store/json.hpp"
#include "bench/store/system/interruption.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::study {

namespace {
constexpr double shortest_sample = 0.02;  // [s]
constexpr double cell_budget = 10;        // budget for one cell [s]

struct Timed : Contender {
    double expected;                          // [s] for one sample
    int repeats;                              // samples
    std::vector<double> wall{}, processor{};  // [s] for one run
};
// Removes the drift of the machine. A disturbance during a round (another clock frequency, a busy
// neighbour) affects all cells at one rate alike, because they are timed next to each other. So
// each sample is divided by the median, over these cells, of their relative times: sample over the
// cell's own median.
void take_off_drift(std::span<Timed> of_one_rate, int rounds) {
    constexpr std::size_t fewest = 3;  // with fewer cells, drift and cell cannot be told apart
    std::vector<double> middle;
    for (const Timed& t : of_one_rate) middle.push_back(spread_of(t.processor).median);
    for (std::size_t round = 0; round < static_cast<std::size_t>(rounds); ++round) {
        std::vector<double> relative;
        for (std::size_t k = 0; k < of_one_rate.size(); ++k)
            if (round < of_one_rate[k].processor.size())
                relative.push_back(of_one_rate[k].processor[round] / middle[k]);
        if (relative.size() < fewest) return;
        const double drift = spread_of(relative).median;
        for (Timed& t : of_one_rate)
            if (round < t.processor.size()) t.processor[round] /= drift;
    }
}
}  // namespace

Sample sample_of(const Descriptor& d, const Scene& scene, const Settings& settings,
                 double shortest) {
    const auto scheme = make_scheme(d, scene, settings);
    Sample s{0, 0, nan};
    const RunOptions options{.timed = true};
    const double from = store::processor_seconds(),
                 deadline = options.block_rows / settings.tap_rate;
    int runs = 0;
    for (; runs < 1000 && s.processor < shortest; ++runs) {
        const Run r = run(*scheme, scene, settings, options);
        s.wall += r.wall_seconds;
        if (r.worst_block > 0 && r.status.outcome == Outcome::ok)
            s.worst_block = std::fmin(s.worst_block, r.worst_block / deadline);
        s.processor = store::processor_seconds() - from;
    }
    return {s.wall / runs, s.processor / runs, s.worst_block};
}

void time_cells(const std::vector<Contender>& contenders, int repeats,
                const store::Listener& listener) {
    // before the timings, so that the load comes from other programs
    const store::Stamp stamp = store::stamp_now();
    std::vector<Timed> timed;
    double work = 0, finished = 0;
    for (const Contender& c : contenders) {
        if (!c.cell->ran()) continue;
        const double once = std::max(c.cell->summary.wall_seconds, 1e-6);
        const double expected = std::max(once, std::min(shortest_sample, 1000 * once));
        const int most = static_cast<int>(std::clamp(cell_budget / expected, 2.0, 1e6));
        timed.push_back({c, expected, std::min(repeats, most)});
        work += expected * timed.back().repeats;
    }
    // Competitors at the same rate follow each other, so that disturbances affect them equally.
    std::stable_sort(timed.begin(), timed.end(), [](const Timed& a, const Timed& b) {
        return a.cell->settings.sample_rate < b.cell->settings.sample_rate;
    });
    int rounds = 0;
    for (const Timed& t : timed) rounds = std::max(rounds, t.repeats);
    const auto progress = listener.begin("cost");
    const auto start = std::chrono::steady_clock::now();
    const Timed* slowest = nullptr;  // slowest for a single run
    for (int round = 0; round < rounds; ++round)
        for (Timed& t : timed) {
            if (round >= t.repeats) continue;
            const double elapsed =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            std::string text =
                fmt::format("round {} of {}, about {:.0f} s left", round + 1, rounds,
                            finished > 0 ? elapsed * (work - finished) / finished : work);
            if (slowest)
                text +=
                    fmt::format("; longest {:.0f} s: {} at {} Hz", slowest->wall.back(),
                                slowest->cell->scheme->name, slowest->cell->settings.sample_rate);
            progress->show(finished / work, text);
            const Sample s =
                sample_of(*t.cell->scheme, *t.scene, t.cell->settings, shortest_sample);
            t.wall.push_back(s.wall);
            t.processor.push_back(s.processor);
            t.cell->clock.worst_block = std::fmin(t.cell->clock.worst_block, s.worst_block);
            finished += t.expected;
            if (!slowest || s.wall > slowest->wall.back()) slowest = &t;
        }
    for (auto from = timed.begin(), to = from; from != timed.end(); from = to) {
        to = std::find_if(from, timed.end(), [&](const Timed& t) {
            return t.cell->settings.sample_rate != from->cell->settings.sample_rate;
        });
        take_off_drift({from, to}, rounds);
    }
    for (Timed& t : timed) {
        t.cell->clock.wall = spread_of(t.wall);
        t.cell->clock.processor = spread_of(t.processor);
        t.cell->clock.stamp = stamp;
    }
}

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json quoted(const Spread& s) {
    return {store::text_of(s.median), store::text_of(s.lower), store::text_of(s.upper)};
}
Spread spread_in(const Json& j, int count) {
    return {count, store::number_of(j.at(0)), store::number_of(j.at(1)), store::number_of(j.at(2))};
}
}  // namespace

std::string clock_json(const Timing& c, const std::string& identity) {
    return store::kept_text(identity, {{"repeats", c.wall.count},
                                       {"wall_seconds", quoted(c.wall)},
                                       {"processor_seconds", quoted(c.processor)},
                                       {"worst_block", store::text_of(c.worst_block)},
                                       {"stamp", json_of(c.stamp)}});
}

std::optional<Timing> read_clock(const fs::path& path, const std::string& identity) {
    return store::read_kept(path, identity, [](const Json& j) {
        Timing c;
        const int repeats = store::whole<int>(j.at("repeats"));
        c.wall = spread_in(j.at("wall_seconds"), repeats);
        c.processor = spread_in(j.at("processor_seconds"), repeats);
        c.worst_block = store::number_of(j.at("worst_block"));
        c.stamp = store::stamp_of(j.at("stamp"));
        return c;
    });
}

std::string clock_file(const Job& job) { return job.id + ".clock"; }

}  // namespace jvari::bench::study

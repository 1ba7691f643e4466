#include "bench/study/cost.hpp"

#include <fmt/core.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "bench/store/json.hpp"
#include "bench/store/system/time_limit.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::study {

namespace {
constexpr double shortest_sample = 0.02;  // [s]
constexpr double cell_budget = 10;        // of one cell [s]

struct Timed : Contender {
    int runs;                                   // back to back in one sample
    int repeats;                                // samples
    std::vector<double> samples, of_processor;  // [s] of one run
};

void sample(Timed& t) {
    const auto scheme = make_scheme(*t.cell->scheme, *t.scene, t.cell->settings);
    RunOptions options;
    options.timed = true;
    double seconds = 0;
    const double from = store::processor_seconds();
    for (int k = 0; k < t.runs; ++k) {
        const Run r = run(*scheme, *t.scene, t.cell->settings, options);
        seconds += r.wall_seconds;
        const double deadline = options.block_rows / t.cell->settings.tap_rate;
        if (r.worst_block > 0 && r.status.outcome == Outcome::ok)
            t.cell->clock.worst_block =
                std::fmin(t.cell->clock.worst_block, r.worst_block / deadline);
    }
    t.of_processor.push_back((store::processor_seconds() - from) / t.runs);
    t.samples.push_back(seconds / t.runs);
}
// What the machine does in a round (another clock frequency, a busy neighbour) meets the cells of
// one rate alike, which are next to each other in it. So of every sample goes the median over them
// of a sample over its cell's own median.
void take_off_drift(std::span<Timed> of_one_rate, int rounds) {
    constexpr std::size_t fewest = 3;  // of fewer it cannot be told from theirs
    std::vector<double> middle;
    for (const Timed& t : of_one_rate) middle.push_back(spread_of(t.of_processor).median);
    for (std::size_t round = 0; round < static_cast<std::size_t>(rounds); ++round) {
        std::vector<double> relative;
        for (std::size_t k = 0; k < of_one_rate.size(); ++k)
            if (round < of_one_rate[k].of_processor.size())
                relative.push_back(of_one_rate[k].of_processor[round] / middle[k]);
        if (relative.size() < fewest) return;
        const double drift = spread_of(relative).median;
        for (Timed& t : of_one_rate)
            if (round < t.of_processor.size()) t.of_processor[round] /= drift;
    }
}
double seconds_of(const Timed& t) {  // its last sample
    return t.samples.back() * t.runs;
}
}  // namespace

void time_cells(const std::vector<Contender>& contenders, int repeats,
                const store::Listener& listener) {
    const store::Stamp stamp = store::stamp_now();  // the load is what others made of it
    std::vector<Timed> timed;
    double work = 0, finished = 0;
    for (const Contender& c : contenders) {
        if (!c.cell->ran()) continue;
        const double once = std::max(c.cell->summary.wall_seconds, 1e-6);
        const int runs =
            static_cast<int>(std::clamp(std::ceil(shortest_sample / once), 1.0, 1000.0));
        const int most = static_cast<int>(std::clamp(cell_budget / (once * runs), 2.0, 1e6));
        timed.push_back({c, runs, std::min(repeats, most), {}, {}});
        work += once * runs * timed.back().repeats;
    }
    // competitors at the same rate follow each other, so that what the machine does meanwhile meets
    // them alike
    std::stable_sort(timed.begin(), timed.end(), [](const Timed& a, const Timed& b) {
        return a.cell->settings.sample_rate < b.cell->settings.sample_rate;
    });
    int rounds = 0;
    for (const Timed& t : timed) rounds = std::max(rounds, t.repeats);
    const auto progress = listener.begin("cost");
    const auto start = std::chrono::steady_clock::now();
    const Timed* slowest = nullptr;  // of one sample
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
                    fmt::format("; longest {:.0f} s: {} at {} Hz", seconds_of(*slowest),
                                slowest->cell->scheme->name, slowest->cell->settings.sample_rate);
            progress->show(finished / work, text);
            sample(t);
            finished += t.cell->summary.wall_seconds * t.runs;
            if (!slowest || seconds_of(t) > seconds_of(*slowest)) slowest = &t;
        }
    for (auto from = timed.begin(), to = from; from != timed.end(); from = to) {
        to = std::find_if(from, timed.end(), [&](const Timed& t) {
            return t.cell->settings.sample_rate != from->cell->settings.sample_rate;
        });
        take_off_drift({from, to}, rounds);
    }
    for (Timed& t : timed) {
        t.cell->clock.wall = spread_of(t.samples);
        t.cell->clock.processor = spread_of(t.of_processor);
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
    Spread s = spread_of({});
    s.count = count;
    s.median = store::number_of(j.at(0)), s.lower = store::number_of(j.at(1)),
    s.upper = store::number_of(j.at(2));
    return s;
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

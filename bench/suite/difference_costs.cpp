// Costs of two folders, side by side. Source: this program's rule for ties (two costs with touching
// quartiles tie).
//
// The comparison uses the lower quartile of processor time if both folders have processor time,
// else the median of wall time. Processor time excludes the time that other programs take from the
// machine, and a disturbance can only make a run slower.
//
// Two timings on one machine are different only beyond the machine's own variation, which has two
// kinds. All cells drift together (another clock frequency, a busy neighbour), and single cells are
// disturbed. Both are measured from the cells. The drift is the median ratio over cells with the
// same rate, which are timed in turn; if these are few, over all cells. The disturbance is 1.4826
// times the median distance from the drift, in logarithms (the standard deviation for a normal
// distribution).
//
// A series is a scheme with its options on a problem, over its rates. A series got slower under two
// conditions. The median of its ratios exceeds the drift by 15 % and by five standard errors. A
// standard error of the median over n cells is sqrt(pi/2n) disturbances. And in most cells the
// quartiles stay apart after the drift is taken off. With fewer than three series, drift and change
// cannot be told apart: a cell with separate quartiles counts only as moved. Costs on two machines
// are not compared.
#include "bench/suite/difference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "analysis/statistics.hpp"

namespace jvari::bench::suite {

namespace {
constexpr double least_change = 1.15;  // ratio
constexpr double disturbances = 5;
constexpr std::size_t fewest_series = 3;
constexpr double noted_drift = 1.25;  // ratio

struct Ratio {
    std::string series, name;
    double rate;                // 0: continuous time
    std::size_t before, after;  // rows
    double value;               // after over before
    double drift = 1;           // drift of the cells timed beside this one
    double change() const { return value / drift; }
};

template <class Of>
double median_of(const std::vector<Ratio>& ratios, Of of) {
    std::vector<double> values;
    for (const Ratio& r : ratios) values.push_back(of(r));
    return spread_of(values).median;
}

// Sets the drift. Cells at one rate are timed in turn, so they drift together; if too few, the
// drift over all cells counts.
void take_off_drift(std::vector<Ratio>& ratios) {
    const auto middle = [](const std::vector<Ratio>& of) {
        return median_of(of, [](const Ratio& r) { return r.value; });
    };
    std::map<double, std::vector<Ratio>> by_rate;
    for (const Ratio& r : ratios) by_rate[r.rate].push_back(r);
    std::map<double, double> drift;
    for (const auto& [rate, beside] : by_rate)
        drift[rate] = middle(beside.size() < fewest_series ? ratios : beside);
    for (Ratio& r : ratios) r.drift = drift[r.rate];
}

struct Noise {
    double disturbed = 0;  // standard deviation for a cell relative to its drift, in logarithms

    // Limit for the median ratio of so many cells: a larger ratio is more than the machine's
    // disturbance.
    double beyond(std::size_t cells) const {
        const double of_median =
            std::min(1.0, std::sqrt(std::numbers::pi / 2 / static_cast<double>(cells)));
        return std::max(least_change, std::exp(disturbances * of_median * disturbed));
    }
};
Noise noise_of(const std::vector<Ratio>& ratios) {
    return {1.4826 *
            median_of(ratios, [](const Ratio& r) { return std::abs(std::log(r.change())); })};
}

using Cost = double study::TabledCell::*;
struct Clock {  // columns of a clock, with the steadiest for comparing
    Cost median, lower, upper, compared;
    const char* column;  // name of the median's column
};
using C = study::TabledCell;
constexpr Clock wall{&C::cost_s_per_s, &C::cost_lower, &C::cost_upper, &C::cost_s_per_s,
                     "cost_s_per_s"};
// Processor time: other programs disturb it far less, and only toward slower; the lower quartile is
// the least disturbed.
constexpr Clock processor{&C::processor_s_per_s, &C::processor_lower, &C::processor_upper,
                          &C::processor_lower, "processor_s_per_s"};

bool has(const study::Cells& cells, Cost cost) {
    return std::ranges::any_of(cells, [cost](const C& c) { return c.*cost > 0; });
}

// Verdict on a series: worse, better or same.
Turn turn_of_costs(const Results& a, const Results& b, const std::vector<Ratio>& series,
                   const Noise& noise, const Clock& clock) {
    const double change = median_of(series, [](const Ratio& r) { return r.change(); });
    const double beyond = noise.beyond(series.size());
    if (change < beyond && change > 1 / beyond) return Turn::same;
    const auto apart = std::count_if(series.begin(), series.end(), [&](const Ratio& r) {
        return change > 1
                   ? b.cells[r.after].*clock.lower / r.drift > a.cells[r.before].*clock.upper
                   : b.cells[r.after].*clock.upper / r.drift < a.cells[r.before].*clock.lower;
    });
    if (2 * static_cast<std::size_t>(apart) <= series.size()) return Turn::same;
    return change > 1 ? Turn::worse : Turn::better;
}

std::vector<Ratio> ratios_of(const Results& a, const Results& b, const std::vector<Pair>& pairs,
                             const Clock& clock) {
    std::vector<Ratio> ratios;
    for (const Pair& p : pairs) {
        const C& before = a.cells[p.before];
        const double was = before.*clock.compared, is = b.cells[p.after].*clock.compared;
        if (was > 0 && is > 0)
            ratios.push_back({before.problem() + "|" + before.variant(), p.name,
                              std::isnan(before.rate) ? 0 : before.rate, p.before, p.after,
                              is / was});
    }
    return ratios;
}

// Findings for cells that ran in the second folder without a cost: they have lost it, on any
// machine.
void find_missing_costs(const Results& a, const Results& b, const std::vector<Pair>& pairs,
                        Difference& d) {
    for (const Pair& p : pairs) {
        const C &before = a.cells[p.before], &after = b.cells[p.after];
        if (after.status != "ok") continue;
        for (const Clock& c : {wall, processor})
            if (before.*c.median > 0 && !(after.*c.median > 0))
                d.findings.push_back({Turn::worse, p.name, c.column, before.*c.median,
                                      after.*c.median, "its cost is gone"});
    }
}

using Series = std::vector<std::pair<std::string, std::vector<Ratio>>>;

Series series_of(const std::vector<Ratio>& ratios) {
    Series series;
    for (const Ratio& r : ratios) {
        auto it = std::find_if(series.begin(), series.end(),
                               [&r](const auto& s) { return s.first == r.series; });
        if (it == series.end()) it = series.insert(series.end(), {r.series, {}});
        it->second.push_back(r);
    }
    return series;
}
}  // namespace

void compare_costs(const Results& a, const Results& b, const std::vector<Pair>& pairs,
                   Difference& d) {
    if (!has(b.cells, wall.median)) {
        if (has(a.cells, wall.median))
            d.notes.push_back(
                "no cell of the second folder has a cost: none was measured, or they are gone");
        return;
    }
    find_missing_costs(a, b, pairs, d);
    const bool both = has(a.cells, processor.median) && has(b.cells, processor.median);
    const Clock& clock = both ? processor : wall;
    std::vector<Ratio> ratios = ratios_of(a, b, pairs, clock);
    if (ratios.empty()) return;
    if (!a.provenance.same_machine(b.provenance)) {
        d.notes.push_back(fmt::format("costs are of two machines and are not compared: {} and {}",
                                      a.provenance.machine(), b.provenance.machine()));
        return;
    }
    if (a.provenance.system != b.provenance.system)
        d.notes.push_back(fmt::format("costs are of one machine under two systems: {} and {}",
                                      a.provenance.system, b.provenance.system));
    std::set<std::string> names;
    for (const Ratio& r : ratios) names.insert(r.series);
    const bool few = names.size() < fewest_series;
    if (!few) take_off_drift(ratios);
    const Series series = series_of(ratios);
    const Noise noise = few ? Noise{} : noise_of(ratios);
    const auto drift_of = [](const std::vector<Ratio>& of) {
        return median_of(of, [](const Ratio& r) { return r.drift; });
    };
    if (const double drift = drift_of(ratios); drift > noted_drift || drift < 1 / noted_drift)
        d.notes.push_back(
            fmt::format("the middle cell took {:.2f} times as long: the machine's doing or the "
                        "program's, which a clock cannot "
                        "tell; each is judged relative to that",
                        drift));
    double beyond = least_change;
    for (const auto& [name, cells] : series) beyond = std::max(beyond, noise.beyond(cells.size()));
    if (beyond > least_change)
        d.notes.push_back(
            fmt::format("the clock was disturbed: costs that changed by less than {:.2f} times are "
                        "not told apart",
                        beyond));
    for (const auto& [name, cells] : series) {
        d.compared += static_cast<int>(cells.size());
        const Turn turn = turn_of_costs(a, b, cells, noise, clock);
        if (turn == Turn::same) continue;
        const double change = median_of(cells, [](const Ratio& r) { return r.change(); });
        const std::string detail =
            few ? fmt::format("{:.2f} times, the machine's doing or the scheme's", change)
                : fmt::format("{:.2f} times beyond a drift of {:.2f}", change, drift_of(cells));
        for (const Ratio& r : cells)
            d.findings.push_back({few ? Turn::moved : turn, r.name, clock.column,
                                  a.cells[r.before].*clock.median, b.cells[r.after].*clock.median,
                                  detail});
    }
}

}  // namespace jvari::bench::suite

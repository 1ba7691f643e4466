#include "bench/suite/suite_parts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <functional>

#include "bench/store/checksum.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::suite {

namespace {
// A guess, for dealing alone: what a mode costs in a step, and no fewer modes than a contact is worth.
double seconds(double rate, double duration, int modes) {
    return std::max(rate, 44100.0) * duration * std::max(modes, 100) * 20e-9;
}
double seconds(const PlannedCell& c) {
    return seconds(c.cell.settings.sample_rate, c.point->scene.duration, c.cell.settings.modes);
}
double seconds(const SuitePlan& plan, const store::Rows& set) {
    double all = 0;
    for (const std::size_t i : set) all += seconds(plan.cells[i]) * (1 + plan.cells[i].set->repeats);
    return all;
}
double seconds(const map::MapRow& row) {
    double all = 0;
    for (const std::string& x : row.map->x.values) {
        const map::Trial t = map::trial_at({row.map, row.scheme, x, row.y});
        all += seconds(t.settings.sample_rate, t.scene.duration, t.settings.modes) * (1 + row.map->refine);
    }
    return all;
}

std::string what_of(const map::MapRow& row) {
    return fmt::format("{}: {}{}", row.map->name, row.scheme->name, row.y.empty() ? "" : " at " + row.map->y.key + " = " + row.y);
}

std::string address_of(const SuitePlan& plan, const store::Rows& set) {
    std::string all;
    for (const std::size_t i : set) all += plan.cells[i].id;
    return store::hash_of(all);
}

// work(k, shard): the k-th of these, longest first, in turn.
void deal(const std::vector<double>& sizes, int to, const std::function<void(std::size_t, int)>& work) {
    std::vector<std::size_t> order(sizes.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::ranges::stable_sort(order, [&sizes](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
    for (std::size_t k = 0; k < order.size(); ++k) work(order[k], static_cast<int>(k) % to);
}
}  // namespace

Shard shard_of(const std::string& text) {
    Shard s{0, 0};
    const char *from = text.data(), *end = from + text.size();
    const auto first = std::from_chars(from, end, s.number);
    const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
    const auto second = slash ? std::from_chars(first.ptr + 1, end, s.of) : first;
    if (!slash || second.ec != std::errc() || second.ptr != end || s.number < 1 || s.number > s.of)
        throw store::UsageError(fmt::format("--shard {}: expected I/N, the I-th of N shards, as 3/20", text));
    return s;
}

Parts parts_of(const SuitePlan& plan, const std::vector<map::Map>& maps, const compare::Catalogue& catalogue) {
    return {plan, map::rows_of(maps, catalogue), all_of(plan).clocks};
}

store::Table parts_table(const Parts& p, const std::string& program) {
    store::Table t;
    t.columns = {"part", "kind", "what", "seconds"};
    const auto add = [&t](const std::string& part, const char* kind, const std::string& what, double s) {
        t.rows.push_back({part, kind, what, fmt::format("{:.2g}", s)});
    };
    for (const PlannedCell& c : p.plan.cells) add(c.id, "cell", what_of(c), seconds(c));
    for (const store::Rows& set : p.clocks)
        add(address_of(p.plan, set), "clock", fmt::format("{} cells from {}", set.size(), what_of(p.plan.cells[set.front()])),
            seconds(p.plan, set));
    for (const map::MapRow& row : p.rows) add(store::hash_of(program + identity_of(row)), "row of a map", what_of(row), seconds(row));
    return t;
}

int clock_shards(const Parts& p, int of) {
    return std::min(static_cast<int>(p.clocks.size()), of / 2);
}

Share share_of(const Parts& p, const Shard& shard) {
    Share own;
    const int last = clock_shards(p, shard.of), first = shard.of - last, number = shard.number - 1;
    std::vector<double> sizes, clock_sizes;
    for (const PlannedCell& c : p.plan.cells) sizes.push_back(seconds(c));
    for (const map::MapRow& row : p.rows) sizes.push_back(seconds(row));
    deal(sizes, first, [&](std::size_t k, int to) {
        if (to != number) return;
        if (k < p.plan.cells.size()) own.work.cells.push_back(k);
        else own.rows.push_back(p.rows[k - p.plan.cells.size()]);
    });
    for (const store::Rows& set : p.clocks) clock_sizes.push_back(seconds(p.plan, set));
    deal(clock_sizes, std::max(last, 1), [&](std::size_t k, int to) {
        if (last == 0 ? number == 0 : to == number - first) own.work.clocks.push_back(p.clocks[k]);
    });
    std::ranges::sort(own.work.cells);
    return own;
}

}  // namespace jvari::bench::suite

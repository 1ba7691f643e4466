#include "bench/study/clock.hpp"

#include <nlohmann/json.hpp>

#include "bench/store/checksum.hpp"
#include "bench/store/kept.hpp"
#include "bench/store/whole.hpp"

namespace jvari::bench::study {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json quoted(const Spread& s) {
    return {store::text_of(s.median), store::text_of(s.lower), store::text_of(s.upper)};
}
Spread spread_in(const Json& j, int count) {
    Spread s = spread_of({});
    s.count = count;
    s.median = store::number_of(j.at(0)), s.lower = store::number_of(j.at(1)), s.upper = store::number_of(j.at(2));
    return s;
}
}  // namespace

std::string clock_json(const KeptClock& c, const std::string& identity) {
    return store::kept_text(identity, {{"repeats", c.wall.count},
                                       {"wall_seconds", quoted(c.wall)},
                                       {"processor_seconds", quoted(c.processor)},
                                       {"worst_block", store::text_of(c.worst_block)},
                                       {"stamp", Json::parse(json_of(c.stamp))}});
}

std::optional<KeptClock> read_clock(const fs::path& path, const std::string& identity) {
    return store::read_kept(path, identity, [](const Json& j) {
        KeptClock c;
        const int repeats = store::whole<int>(j.at("repeats"));
        c.wall = spread_in(j.at("wall_seconds"), repeats);
        c.processor = spread_in(j.at("processor_seconds"), repeats);
        c.worst_block = store::number_of(j.at("worst_block"));
        c.stamp = store::stamp_of(j.at("stamp").dump());
        return c;
    });
}

std::string clock_file(const Job& cell, const store::Stamp& stamp) {
    return cell.id + "." + store::hash_of(stamp.name).substr(0, 8) + ".clock";
}

std::vector<Clocks> clocks_in(const fs::path& folder, const Plan& plan, const store::Rows& cells) {
    std::multimap<std::string, fs::path> files;  // by the id of their cell
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (const std::string name = entry.path().filename().string(); name.front() != '.' && entry.path().extension() == ".clock")
            files.emplace(name.substr(0, name.find('.')), entry.path());
    std::vector<Clocks> all;
    for (const std::size_t i : cells) {
        Clocks& own = all.emplace_back();
        const auto [from, to] = files.equal_range(plan.jobs[i].id);
        for (auto file = from; file != to; ++file)
            if (auto clock = read_clock(file->second, plan.jobs[i].identity)) own.emplace(clock->stamp.name, std::move(*clock));
    }
    return all;
}

Chosen machine_of(const std::vector<Clocks>& cells) {
    std::map<std::string, std::size_t> timed;
    for (const Clocks& c : cells)
        for (const auto& [machine, clock] : c) ++timed[machine];
    const auto own = timed.find(store::stamp_now().name);
    if (own != timed.end() && own->second == cells.size()) return {own->first, true};
    Chosen best;
    std::size_t most = 0;
    for (const auto& [machine, count] : timed)
        if (count > most) best.machine = machine, most = count;
    best.all = most == cells.size();
    return best;
}

}  // namespace jvari::bench::study

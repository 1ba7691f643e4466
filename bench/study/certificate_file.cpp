#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/store/encoding.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/study/certificate.hpp"

namespace jvari::bench::study {

namespace {
using Json = nlohmann::ordered_json;
constexpr int format = 4;  // version number

std::string window_name(std::size_t w) {
    return w + 1 < agreement_windows.size() ? fmt::format("{:.0f}ms", 1e3 * agreement_windows[w])
                                            : "whole";
}
std::string level_name(std::size_t l) {  // "1e-3"
    return fmt::format("1e{}", std::lround(std::log10(agreement_levels[l])));
}

// Windows that end within the run, and the whole run.
Json windows_json(const Certificate::ByWindow& values, double duration) {
    Json j = Json::object();
    for (std::size_t w = 0; w < values.size(); ++w)
        if (w + 1 == values.size() || agreement_windows[w] <= duration * (1 + 1e-9))
            j[window_name(w)] = values[w];
    return j;
}
Certificate::ByWindow windows_of(const Json& j) {
    Certificate::ByWindow values;
    for (std::size_t w = 0; w < values.size(); ++w) {
        const auto found = j.find(window_name(w));
        values[w] = found == j.end() || found->is_null() ? nan : found->get<double>();
    }
    if (!j.contains("whole")) throw std::runtime_error("a tap without the whole window");
    return values;
}

Json taps_json(const Certificate& c, const std::vector<Agreement>& taps) {
    Json all = Json::object();
    for (std::size_t k = 0; k < taps.size(); ++k) {
        Json until = Json::object();
        for (std::size_t l = 0; l < agreement_levels.size(); ++l)
            until[level_name(l)] = taps[k].until[l];
        all[c.taps.at(k)] = {
            {"relative_l2", windows_json(taps[k].relative_l2, c.duration - c.from)},
            {"until_s", until}};
    }
    return all;
}
std::vector<Agreement> taps_of(const Certificate& c, const Json& j) {
    std::vector<Agreement> taps;
    for (const std::string& name : c.taps) {
        Agreement& a = taps.emplace_back();
        a.relative_l2 = windows_of(j.at(name).at("relative_l2"));
        for (std::size_t l = 0; l < agreement_levels.size(); ++l)
            a.until[l] = j.at(name).at("until_s").at(level_name(l));
    }
    return taps;
}

Json outcome_json(const Certificate& c, const Certificate::Entry& e) {
    if (!e.reason.empty()) return {{"status", "refused"}, {"reason", e.reason}};
    Json j{{"status", name_of(e.status.outcome)},
           {"failed_step", e.status.step},
           {"reached_s", e.reached}};
    if (e.sample_rate > 0) j["sample_rate_hz"] = e.sample_rate;
    for (std::size_t k = 0; k < e.estimate.size(); ++k)
        j["estimate"][c.taps.at(k)] = windows_json(e.estimate[k], c.duration - c.from);
    return j;
}
Certificate::Entry entry_of(const Certificate& c, const Json& plan, const Json& outcome) {
    Certificate::Entry e;
    e.reference = plan.at(0);
    for (const auto& [name, value] : plan.at(1).items()) e.options.emplace_back(name, value);
    e.doubled = plan.at(2);
    e.wall_seconds = nan;
    const std::string status = outcome.at("status");
    if (status == "refused") {
        e.reason = outcome.at("reason");
        return e;
    }
    e.status = {store::outcome_named(status), store::whole<long>(outcome.at("failed_step"))};
    e.reached = outcome.at("reached_s");
    e.sample_rate = outcome.value("sample_rate_hz", 0.0);
    if (const auto estimate = outcome.find("estimate"); estimate != outcome.end())
        for (const std::string& name : c.taps) e.estimate.push_back(windows_of(estimate->at(name)));
    return e;
}
}  // namespace

std::string Certificate::identity() const {
    Json runs = Json::array();
    for (const Entry& e : entries) {
        Json options = Json::object();
        for (const auto& [name, value] : e.options) options[name] = value;
        runs.push_back({e.reference, options, e.doubled});
    }
    return store::compact({{"program", store::parsed(program)},
                           {"format", format},
                           {"scene", scene},
                           {"scene_hash", scene_hash},
                           {"modes", modes},
                           {"tap_rate_hz", tap_rate},
                           {"duration_s", duration},
                           {"from_s", from},
                           {"taps", taps},
                           {"runs", runs}});
}

std::string Certificate::key() const { return store::hash_of(identity()); }

std::string json_of(const Certificate& c) {
    Json outcomes = Json::array(), pairs = Json::array();
    for (const auto& e : c.entries) outcomes.push_back(outcome_json(c, e));
    for (const auto& p : c.pairs)
        pairs.push_back({{"first", p.first}, {"second", p.second}, {"taps", taps_json(c, p.taps)}});
    return store::kept_text(
        c.identity(),
        {{"outcomes", outcomes}, {"pairs", pairs}, {"noise_floor", taps_json(c, c.floor)}}, 1);
}

std::string cost_json_of(const Certificate& c) {
    Json seconds = Json::array();
    for (const auto& e : c.entries) seconds.push_back(e.reason.empty() ? e.wall_seconds : nan);
    return store::kept_text(c.identity(), {{"wall_seconds", seconds}, {"made", store::made_by()}},
                            1);
}

std::optional<Certificate> read_certificate(const std::filesystem::path& path) {
    return store::read_kept(path, [](const Json& j) {
        const Json& of = j.at("of");
        if (of.at("format") != format) throw std::runtime_error("of another format");
        Certificate c;
        c.program = store::compact(of.at("program"));
        c.scene = of.at("scene");
        c.scene_hash = of.at("scene_hash");
        c.modes = store::whole<int>(of.at("modes"));
        c.tap_rate = of.at("tap_rate_hz");
        c.duration = of.at("duration_s");
        c.from = of.at("from_s");
        c.taps = of.at("taps").get<std::vector<std::string>>();
        for (std::size_t i = 0; i < of.at("runs").size(); ++i)
            c.entries.push_back(entry_of(c, of.at("runs").at(i), j.at("outcomes").at(i)));
        for (const Json& p : j.at("pairs")) {
            c.pairs.push_back({store::whole<int>(p.at("first")), store::whole<int>(p.at("second")),
                               taps_of(c, p.at("taps"))});
            for (const int entry : {c.pairs.back().first, c.pairs.back().second})
                if (entry < 0 || entry >= static_cast<int>(c.entries.size()))
                    throw std::runtime_error("a pair of entries that are not there");
        }
        c.floor = taps_of(c, j.at("noise_floor"));
        return c;
    });
}

std::filesystem::path cost_path(const std::filesystem::path& certificate) {
    std::filesystem::path path = certificate;
    return path.replace_extension(".cost.json");
}

void read_costs(const std::filesystem::path& certificate, Certificate& c) {
    const auto seconds = store::read_kept(cost_path(certificate), c.identity(), [](const Json& j) {
        std::vector<double> all;
        for (const Json& x : j.at("wall_seconds"))
            all.push_back(x.is_number() ? x.get<double>() : nan);
        return all;
    });
    for (std::size_t i = 0; seconds && i < std::min(seconds->size(), c.entries.size()); ++i)
        c.entries[i].wall_seconds = (*seconds)[i];
}

}  // namespace jvari::bench::study

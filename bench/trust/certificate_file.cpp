#include "bench/trust/certificate_file.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::trust {

namespace {
using Json = nlohmann::ordered_json;
constexpr int format = 3;  // of the file

std::string window_name(std::size_t w) {
    return w + 1 < agreement_windows.size() ? fmt::format("{:.0f}ms", 1e3 * agreement_windows[w])
                                            : "whole";
}
std::string level_name(std::size_t l) {  // "1e-3"
    return fmt::format("1e{}", std::lround(std::log10(agreement_levels[l])));
}

// Windows that end within the run, and the whole of it.
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
        values[w] = found == j.end() || found->is_null() ? store::nan : found->get<double>();
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

Json options_json(const Certificate::Options& options) {
    Json j = Json::object();
    for (const auto& [name, value] : options) j[name] = value;
    return j;
}

Json entry_json(const Certificate& c, const Certificate::Entry& e) {
    Json j{{"reference", e.reference}, {"options", options_json(e.options)}};
    if (e.sample_rate > 0) j["sample_rate_hz"] = e.sample_rate;
    if (!e.doubled.empty()) j["doubled"] = e.doubled;
    if (!e.reason.empty()) {
        j["status"] = "refused";
        j["reason"] = e.reason;
        return j;
    }
    j["status"] = name_of(e.status.outcome);
    if (e.status.outcome != Outcome::ok) j["failed_step"] = e.status.step;
    j["reached_s"] = e.reached;
    if (!e.estimate.empty()) {
        j["estimate"] = Json::object();
        for (std::size_t k = 0; k < e.estimate.size(); ++k)
            j["estimate"][c.taps.at(k)] = windows_json(e.estimate[k], c.duration - c.from);
    }
    return j;
}
Certificate::Entry entry_of(const Certificate& c, const Json& j) {
    Certificate::Entry e;
    e.reference = j.at("reference");
    for (const auto& [name, value] : j.at("options").items()) e.options.emplace_back(name, value);
    e.sample_rate = j.value("sample_rate_hz", 0.0);
    e.doubled = j.value("doubled", "");
    e.wall_seconds = store::nan;
    const std::string status = j.at("status");
    if (status == "refused") {
        e.reason = j.at("reason");
        return e;
    }
    e.status.outcome = store::outcome_named(status);
    if (const auto step = j.find("failed_step"); step != j.end())
        e.status.step = store::whole<long>(*step);
    e.reached = j.at("reached_s");
    if (const auto estimate = j.find("estimate"); estimate != j.end())
        for (const std::string& name : c.taps) e.estimate.push_back(windows_of(estimate->at(name)));
    return e;
}

std::string key_of(const std::string& hash, const std::string& program, const Certificate& plan) {
    Json runs = Json::array();
    for (const auto& e : plan.entries)
        runs.push_back({e.reference, options_json(e.options), e.sample_rate, e.doubled});
    return store::hash_of(
        Json{format, hash, program, plan.modes, plan.tap_rate, plan.duration, runs}.dump());
}
}  // namespace

std::string timeless_hash(const Scene& scene) {
    Scene timeless = scene;
    timeless.duration = 1;
    return scene_hash(timeless);
}

KeptCertificate planned_certificate(const Scene& scene, const CertifySettings& settings,
                                    const std::string& program) {
    KeptCertificate k;
    k.certificate = certificate_plan(scene, settings);
    k.scene_hash = timeless_hash(scene);
    k.program = program;
    k.key = key_of(k.scene_hash, k.program, k.certificate);
    return k;
}

bool of_this_program(const KeptCertificate& kept) { return kept.program == store::run_identity(); }

std::string json_of(const KeptCertificate& kept) {
    const Certificate& c = kept.certificate;
    Json entries = Json::array(), pairs = Json::array();
    for (const auto& e : c.entries) entries.push_back(entry_json(c, e));
    for (const auto& p : c.pairs)
        pairs.push_back({{"first", p.first}, {"second", p.second}, {"taps", taps_json(c, p.taps)}});
    const Json j{{"scene", c.scene},
                 {"scene_hash", kept.scene_hash},
                 {"key", kept.key},
                 {"program", Json::parse(kept.program)},
                 {"format", format},
                 {"modes", c.modes},
                 {"tap_rate_hz", c.tap_rate},
                 {"duration_s", c.duration},
                 {"from_s", c.from},
                 {"taps", c.taps},
                 {"entries", entries},
                 {"pairs", pairs},
                 {"noise_floor", taps_json(c, c.floor)}};
    return store::sealed(j.dump(1));
}

std::string cost_json_of(const KeptCertificate& kept) {
    Json entries = Json::array();
    for (const auto& e : kept.certificate.entries)
        entries.push_back({{"reference", e.reference},
                           {"options", options_json(e.options)},
                           {"wall_seconds", e.reason.empty() ? e.wall_seconds : store::nan}});
    return Json{{"scene", kept.certificate.scene},
                {"key", kept.key},
                {"entries", entries},
                {"made", store::made_by()}}
               .dump(1) +
           "\n";
}

std::optional<KeptCertificate> read_certificate(const std::filesystem::path& path,
                                                std::string& why) {
    std::error_code error;
    why.clear();
    if (!std::filesystem::is_regular_file(path, error)) {
        why = "there is no such file";
        return std::nullopt;
    }
    try {
        const Json j = store::parsed(store::unsealed(store::read_whole(path)));
        if (j.at("format") != format)
            throw std::runtime_error("it is of another format, " + j.at("format").dump());
        KeptCertificate kept;
        kept.program = j.at("program").dump();
        kept.key = j.at("key");
        kept.scene_hash = j.at("scene_hash");
        Certificate& c = kept.certificate;
        c.scene = j.at("scene");
        c.modes = store::whole<int>(j.at("modes"));
        c.tap_rate = j.at("tap_rate_hz");
        c.duration = j.at("duration_s");
        c.from = j.value("from_s", 0.0);
        c.taps = j.at("taps").get<std::vector<std::string>>();
        for (const Json& e : j.at("entries")) c.entries.push_back(entry_of(c, e));
        for (const Json& p : j.at("pairs")) {
            c.pairs.push_back({store::whole<int>(p.at("first")), store::whole<int>(p.at("second")),
                               taps_of(c, p.at("taps"))});
            for (const int entry : {c.pairs.back().first, c.pairs.back().second})
                if (entry < 0 || entry >= static_cast<int>(c.entries.size()))
                    throw std::runtime_error("a pair of entries that are not there");
        }
        c.floor = taps_of(c, j.at("noise_floor"));
        return kept;
    } catch (const std::exception& e) {  // Json::exception, UsageError
        why = e.what();
        return std::nullopt;
    }
}

std::filesystem::path cost_path(const std::filesystem::path& certificate) {
    std::filesystem::path path = certificate;
    return path.replace_extension(".cost.json");
}

void read_costs(const std::filesystem::path& certificate, KeptCertificate& kept) {
    try {
        const Json j = store::parsed(store::read_whole(cost_path(certificate)));
        if (j.at("key") != kept.key || j.at("entries").size() != kept.certificate.entries.size())
            return;
        for (std::size_t i = 0; i < kept.certificate.entries.size(); ++i)
            if (const Json& seconds = j.at("entries").at(i).at("wall_seconds"); seconds.is_number())
                kept.certificate.entries[i].wall_seconds = seconds;
    } catch (const std::exception&) {  // the costs are gone; the certificate holds without them
    }
}

}  // namespace jvari::bench::trust

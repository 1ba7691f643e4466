#include "bench/trust/kept_run.hpp"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "bench/store/console.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/records.hpp"
#include "scenes/scene_file.hpp"

namespace jvari {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;
constexpr int format = 1;                  // of the file
constexpr double worth_keeping = 0.5;      // [s] of stepping
constexpr std::size_t checksum_size = 16;  // hexadecimal digits in front of the CBOR
}  // namespace

fs::path kept_runs_folder() {
    if (!keeps_runs(machine().commit)) return {};
    if (const char* set = std::getenv("JVARI_CACHE")) return set;
    if (const char* set = std::getenv("XDG_CACHE_HOME"); set && *set) return fs::path(set) / "jvari";
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "jvari";
    return {};
}

std::string run_key(const Descriptor& reference, const Scene& scene, const Settings& s) {
    const Machine& m = machine();
    return hash_of(Json{format, m.version, m.commit, m.build, m.compiler, m.flags, m.cpu, reference.name, scene_hash(scene),
                        text_of(s.sample_rate), text_of(s.tap_rate), s.modes, s.options}
                       .dump());
}

bool keeps_runs(const std::string& commit) {
    return commit != "unknown" && !commit.empty() && !commit.ends_with("-dirty");
}

void write_run(const fs::path& path, const std::string& key, const Run& r) {
    Json facts = Json::array(), columns = Json::array();
    for (const Fact& f : r.facts) facts.push_back({f.name, f.value, f.unit});
    for (int k = 0; k < r.trace.taps(); ++k) columns.push_back(std::vector<double>(r.trace.column(k).begin(), r.trace.column(k).end()));
    const Json j{{"key", key},
                 {"outcome", r.status.outcome},
                 {"failed_step", r.status.step},
                 {"dofs", r.dofs},
                 {"steps", r.steps},
                 {"wall_seconds", r.wall_seconds},
                 {"facts", facts},
                 {"worst_block", r.worst_block},
                 {"tap_rate", r.trace.tap_rate},
                 {"columns", columns},
                 {"stride", r.trace.stride},
                 {"rows", r.trace.rows},
                 {"names", r.trace.names}};
    std::string bytes;
    Json::to_cbor(j, bytes);
    write_fresh(path, hash_of(bytes) + bytes);
}

std::optional<Run> read_run(const fs::path& path, const std::string& key) noexcept {
    try {
        if (!fs::is_regular_file(path)) return std::nullopt;
        const std::string file = read_whole(path), bytes = file.substr(std::min(checksum_size, file.size()));
        if (!file.starts_with(hash_of(bytes))) return std::nullopt;
        const Json j = Json::from_cbor(bytes);
        if (j.at("key") != key) return std::nullopt;
        Run r;
        r.status = {j.at("outcome").get<Outcome>(), j.at("failed_step").get<long>()};
        r.dofs = j.at("dofs");
        r.steps = j.at("steps");
        r.wall_seconds = j.at("wall_seconds");
        r.worst_block = j.at("worst_block");
        for (const Json& f : j.at("facts")) r.facts.push_back({f.at(0), f.at(1), f.at(2)});
        Trace& t = r.trace;
        t.tap_rate = j.at("tap_rate");
        t.rows = j.at("rows");
        t.stride = j.at("stride");
        t.names = j.at("names").get<std::vector<std::string>>();
        if (t.rows < 0 || t.rows > t.stride || j.at("columns").size() != t.names.size()) return std::nullopt;
        t.tap.assign(t.stride * t.names.size(), 0.0);
        for (int k = 0; k < t.taps(); ++k) {
            const auto column = j.at("columns").at(k).get<std::vector<double>>();
            if (column.size() != static_cast<std::size_t>(t.rows)) return std::nullopt;
            std::copy(column.begin(), column.end(), t.tap.begin() + k * t.stride);
        }
        return r;
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

Run kept_run(const fs::path& folder, const std::string& key, const std::function<Run()>& make) {
    if (folder.empty()) return make();
    const fs::path path = folder / (key + ".run");
    if (auto kept = read_run(path, key)) return std::move(*kept);
    Run r = make();
    if (r.wall_seconds < worth_keeping) return r;
    try {
        fs::create_directories(folder);
        write_run(path, key, r);
    } catch (const std::exception&) {  // it is a convenience
    }
    return r;
}

}  // namespace jvari

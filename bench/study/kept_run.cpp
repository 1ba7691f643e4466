#include "bench/study/kept_run.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/records.hpp"
#include "bench/store/system/file_lock.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::study {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;
// of the file: a checksum, a line of JSON, the columns as this machine holds them
constexpr int file_format = 2;
constexpr long most_values = 1L << 26;     // of all columns: half a gigabyte
constexpr std::size_t checksum_size = 32;  // hexadecimal digits
}  // namespace

fs::path kept_runs_folder() {
    if (const char* set = std::getenv("JVARI_CACHE")) return set;
    if (const char* set = std::getenv("XDG_CACHE_HOME"); set && *set)
        return fs::path(set) / "jvari";
    if (const char* home = std::getenv("HOME"); home && *home)
        return fs::path(home) / ".cache" / "jvari";
    return {};
}

std::string run_key(const Descriptor& reference, const Scene& scene, const Settings& s) {
    return store::hash_of(Json{file_format, store::run_identity(), reference.name,
                               scene_hash(scene), store::text_of(s.sample_rate),
                               store::text_of(s.tap_rate), s.modes, s.options}
                              .dump());
}

void write_run(const fs::path& path, const std::string& key, const Run& r) {
    Json facts = Json::array();
    for (const Fact& f : r.facts) facts.push_back({f.name, store::text_of(f.value), f.unit});
    const Json head{{"key", key},
                    {"outcome", name_of(r.status.outcome)},
                    {"failed_step", r.status.step},
                    {"dofs", r.dofs},
                    {"steps", r.steps},
                    {"wall_seconds", r.wall_seconds},
                    {"facts", facts},
                    {"worst_block", r.worst_block},
                    {"tap_rate", r.trace.tap_rate},
                    {"stride", r.trace.stride},
                    {"rows", r.trace.rows},
                    {"names", r.trace.names}};
    std::string content = head.dump() + "\n";
    for (int k = 0; k < r.trace.taps(); ++k)
        content.append(reinterpret_cast<const char*>(r.trace.column(k).data()),
                       r.trace.column(k).size_bytes());
    store::write_fresh(path, store::hash_of(content) + content);
}

std::optional<Run> read_run(const fs::path& path, const std::string& key) noexcept {
    try {
        if (!fs::is_regular_file(path)) return std::nullopt;
        const std::string file = store::read_whole(path),
                          content = file.substr(std::min(checksum_size, file.size()));
        const auto head_size = content.find('\n');
        if (!file.starts_with(store::hash_of(content)) || head_size == std::string::npos)
            return std::nullopt;
        const Json j = store::parsed(content.substr(0, head_size));
        if (j.at("key") != key) return std::nullopt;
        Run r;
        r.status = {store::outcome_named(j.at("outcome")), store::whole<long>(j.at("failed_step"))};
        r.dofs = store::whole<int>(j.at("dofs"));
        r.steps = store::whole<long>(j.at("steps"));
        r.wall_seconds = j.at("wall_seconds");
        r.worst_block = j.at("worst_block");
        for (const Json& f : j.at("facts"))
            r.facts.push_back({f.at(0), store::number_of(f.at(1)), f.at(2)});
        Trace& t = r.trace;
        t.tap_rate = j.at("tap_rate");
        t.rows = store::whole<long>(j.at("rows"));
        t.stride = store::whole<long>(j.at("stride"));
        t.names = j.at("names").get<std::vector<std::string>>();
        if (t.stride < 1 || t.rows < 0 || t.rows > t.stride) return std::nullopt;
        if (!t.names.empty() && t.stride > most_values / static_cast<long>(t.names.size()))
            return std::nullopt;
        const std::size_t column = static_cast<std::size_t>(t.rows) * sizeof(double);
        if (content.size() - head_size - 1 != column * t.names.size()) return std::nullopt;
        t.tap.assign(t.stride * t.names.size(), 0.0);
        for (int k = 0; k < t.taps(); ++k)
            std::memcpy(t.tap.data() + k * t.stride,
                        content.data() + head_size + 1 + static_cast<std::size_t>(k) * column,
                        column);
        return r;
    } catch (const std::exception&) { return std::nullopt; }
}

Run kept_run(const fs::path& folder, const std::string& key, const std::function<Run()>& make,
             double least) {
    if (folder.empty()) return make();
    const fs::path path = folder / (key + ".run");
    if (auto kept = read_run(path, key)) return std::move(*kept);
    std::error_code error;
    fs::create_directories(folder, error);
    const store::FileLock lock(path, "makes " + path.string());
    if (auto kept = read_run(path, key)) return std::move(*kept);
    Run r = make();
    if (r.wall_seconds < least) return r;
    try {
        store::sweep_parts(folder);
        write_run(path, key, r);
    } catch (const std::exception&) {  // it is a convenience
    }
    return r;
}

}  // namespace jvari::bench::study

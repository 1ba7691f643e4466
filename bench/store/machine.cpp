#include "bench/store/machine.hpp"
#include "bench/store/json.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/records.hpp"
#include "schemes/registry.hpp"
#include "schemes/vector_instructions.hpp"

namespace jvari::bench::store {

namespace {
std::string cpu_name() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);)
        if (line.rfind("model name", 0) == 0)
            if (const auto colon = line.find(": "); colon != std::string::npos)
                return line.substr(colon + 2);
    return "unknown";
}
std::string system_name() {
    utsname u{};
    return uname(&u) == 0 ? std::string(u.sysname) + " " + u.release + " " + u.machine : "unknown";
}
}  // namespace

const Machine& machine() {
    static const Machine m{JVARI_VERSION,
                           build_sources.commit,
                           build_sources.run_sources,
                           build_sources.cell_sources,
                           JVARI_COMPILER,
                           JVARI_FLAGS,
                           JVARI_BUILD,
                           vector_instructions(),
                           cpu_name(),
                           system_name(),
                           static_cast<int>(std::thread::hardware_concurrency())};
    return m;
}

namespace {
nlohmann::ordered_json identity_of(const std::string& sources, const Machine& m) {
    return {"jvari", sources, m.compiler, m.flags, m.build, m.vectors};
}
// Hashes a plugin's file, or the contents that an external scheme declares.
std::string contents_hash(const std::string& guest) {
    const Guest* known = find_guest(guest);
    return hash_of(known && !known->contents.empty() ? known->contents : read_whole(guest));
}
}  // namespace

std::string run_identity(const Machine& m) {
    nlohmann::ordered_json program = identity_of(m.run_sources, m);
    for (const Guest* g : guests()) program.push_back(contents_hash(g->path));
    return compact(program);
}

std::string program_identity(const std::vector<std::string>& plugins, const Machine& m) {
    nlohmann::ordered_json program = identity_of(m.cell_sources, m);
    for (const std::string& path : plugins) program.push_back(contents_hash(path));
    return compact(program);
}

namespace {
std::string command() {  // command line as typed, from the kernel
    std::ifstream words("/proc/self/cmdline", std::ios::binary);
    std::string text, word;
    for (bool first = true; std::getline(words, word, '\0'); first = false) {
        if (first) word = word.substr(word.rfind('/') + 1);
        text += (first ? "" : " ") + shell_word(word);
    }
    return as_utf8(text);
}
}  // namespace

Stamp stamp_now() {
    const Machine& m = machine();
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    Stamp s{m.cpu + ", " + std::to_string(m.cores) + " cores, " + m.vectors + ", " + m.compiler +
                " " + m.flags,
            host,
            now_utc(),
            nan,
            {}};
    if (double load = 0; getloadavg(&load, 1) == 1) s.load = load;
    std::ifstream("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor") >> s.governor;
    return s;
}

nlohmann::ordered_json json_of(const Stamp& s) {
    return {{"name", s.name},
            {"host", s.host},
            {"at", s.at},
            {"load", text_of(s.load)},
            {"governor", s.governor}};
}

Stamp stamp_of(const nlohmann::ordered_json& j) {
    return {j.at("name"), j.at("host"), j.at("at"), number_of(j.at("load")), j.at("governor")};
}

nlohmann::ordered_json made_by() {
    const Machine& m = machine();
    nlohmann::ordered_json provenance{
        {"program", "jvari"},        {"version", m.version}, {"commit", m.commit},
        {"compiler", m.compiler},    {"flags", m.flags},     {"build", m.build},
        {"sources", m.cell_sources}, {"vectors", m.vectors}, {"cpu", m.cpu},
        {"cores", m.cores},          {"system", m.system},   {"date", now_utc()}};
    provenance["command"] = command();
    // average load over the last minute
    if (double load[3]; getloadavg(load, 3) > 0)
        provenance["load"] = std::round(100 * load[0]) / 100;
    for (const Guest* g : guests())
        provenance["plugins"].push_back({{"file", g->path},
                                         {"hash", contents_hash(g->path)},
                                         {"compiler", g->compiler},
                                         {"flags", g->flags}});
    return provenance;
}

std::string now_utc() {
    const std::time_t now = std::time(nullptr);
    std::tm t{};
    gmtime_r(&now, &t);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &t);
    return text;
}

}  // namespace jvari::bench::store

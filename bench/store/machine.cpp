#include "bench/store/machine.hpp"

#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/commit.hpp"  // written at build time by commit.cmake
#include "bench/store/checksum.hpp"
#include "bench/store/fresh_file.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::store {

namespace {
std::string cpu_name() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    for (std::string line; std::getline(cpuinfo, line);)
        if (line.rfind("model name", 0) == 0)
            if (const auto colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
    return "unknown";
}
std::string system_name() {
    utsname u{};
    return uname(&u) == 0 ? std::string(u.sysname) + " " + u.release + " " + u.machine : "unknown";
}
}  // namespace

const Machine& machine() {
    static const Machine m{JVARI_VERSION, JVARI_COMMIT, JVARI_COMPILER, JVARI_FLAGS,
                           JVARI_BUILD,   cpu_name(),   system_name(),  static_cast<int>(std::thread::hardware_concurrency())};
    return m;
}

std::string program_identity(const std::vector<std::string>& plugins, const Machine& m) {
    nlohmann::ordered_json program{"jvari", m.version, m.commit, m.build};
    for (const std::string& path : plugins) program.push_back(hash_of(read_whole(path)));
    return program.dump();
}

std::string made_by() {
    const Machine& m = machine();
    nlohmann::ordered_json made{{"program", "jvari"}, {"version", m.version}, {"commit", m.commit}, {"compiler", m.compiler},
                                {"flags", m.flags},   {"build", m.build},     {"cpu", m.cpu},       {"cores", m.cores},
                                {"system", m.system}, {"date", now_utc()}};
    for (const LoadedPlugin& l : loaded_plugins())
        made["plugins"].push_back(
            {{"file", l.path}, {"hash", hash_of(read_whole(l.path))}, {"compiler", l.plugin->compiler}, {"flags", l.plugin->flags}});
    return made.dump();
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

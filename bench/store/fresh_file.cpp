#include "bench/store/fresh_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "bench/store/usage.hpp"

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
constexpr const char* part = "part";  // a file on its way: .NAME.HOST.PROCESS.part; hosts share folders, and count their processes alone
constexpr auto forsaken = std::chrono::hours(1), forsaken_elsewhere = std::chrono::hours(24);

std::string host_name() {
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    return host;
}

fs::path behind_links(fs::path path) {
    std::error_code error;
    for (int k = 0; k < 40 && fs::is_symlink(path, error); ++k) {
        const fs::path to = fs::read_symlink(path, error);
        path = to.is_absolute() ? to : path.parent_path() / to;
    }
    return path;
}

pid_t process_of(const fs::path& file) {  // that was writing this part; 0: it is none
    const std::string name = file.filename().string();
    const fs::path stem = file.stem();
    const std::string process = stem.extension().string();
    pid_t id = 0;
    if (name.front() != '.' || file.extension() != std::string(".") + part || process.size() < 2) return 0;
    const auto [end, error] = std::from_chars(process.data() + 1, process.data() + process.size(), id);
    return error == std::errc() && end == process.data() + process.size() && id > 0 ? id : 0;
}
}  // namespace

void must_be_writable(const fs::path& named) {
    const fs::path path = behind_links(named);
    std::error_code error;
    if (fs::is_symlink(path, error)) throw UsageError(fmt::format("cannot write {}: its links lead in a circle", named.string()));
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!path.has_filename() || fs::is_directory(path, error))
        throw UsageError(fmt::format("cannot write {}: it is a folder", path.string()));
    if (!fs::is_directory(folder, error))
        throw UsageError(fmt::format("cannot write {}: there is no folder {}", path.string(), folder.string()));
    if (access(folder.c_str(), W_OK) != 0) throw UsageError(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
    if (fs::exists(path, error) && !fs::is_regular_file(path, error))
        throw UsageError(fmt::format("cannot write {}: something that is no file stands there", path.string()));
}

FreshFile::FreshFile(fs::path path) : path_(behind_links(std::move(path))) {
    must_be_writable(path_);
    beside_ = path_;
    beside_.replace_filename(fmt::format(".{}.{}.{}.{}", path_.filename().string(), host_name(), getpid(), part));
}

FreshFile::~FreshFile() {
    std::error_code ignored;
    if (!kept_) fs::remove(beside_, ignored);
}

void FreshFile::keep() {
    const int file = open(beside_.c_str(), O_RDONLY | O_CLOEXEC);
    const bool synced = file >= 0 && fsync(file) == 0;
    const int reason = errno;
    if (file >= 0) close(file);
    if (!synced) throw Unwritable(fmt::format("cannot write {}: {}", path_.string(), std::strerror(reason)));
    std::error_code error;
    fs::rename(beside_, path_, error);
    if (error) throw Unwritable(fmt::format("cannot write {}: {}", path_.string(), error.message()));
    kept_ = true;
}

void write_fresh(const fs::path& path, const std::string& content) {
    FreshFile file(path);
    std::ofstream stream(file.path(), std::ios::binary);
    stream << content;
    stream.close();
    if (!stream) throw Unwritable(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
    file.keep();
}

void sweep_parts(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> parts;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const pid_t process = process_of(entry.path());
        if (process == 0) continue;
        const bool here = entry.path().string().ends_with(fmt::format(".{}.{}.{}", host_name(), process, part));
        if (here && (kill(process, 0) == 0 || errno != ESRCH)) continue;
        const auto written = fs::last_write_time(entry.path(), error);
        if (!error && fs::file_time_type::clock::now() - written > (here ? forsaken : forsaken_elsewhere)) parts.push_back(entry.path());
    }
    for (const fs::path& file : parts) fs::remove(file, error);
}

std::string read_whole(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream content;
    if (!stream || !(content << stream.rdbuf())) throw UsageError(fmt::format("cannot read {}", path.string()));
    return content.str();
}

}  // namespace jvari::bench::store

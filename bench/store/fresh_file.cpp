#include "bench/store/fresh_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "bench/store/console.hpp"

namespace jvari {

namespace fs = std::filesystem;

void must_be_writable(const fs::path& path) {
    std::error_code error;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!path.has_filename() || fs::is_directory(path, error))
        throw UsageError(fmt::format("cannot write {}: it is a folder", path.string()));
    if (!fs::is_directory(folder, error))
        throw UsageError(fmt::format("cannot write {}: there is no folder {}", path.string(), folder.string()));
    if (access(folder.c_str(), W_OK) != 0) throw UsageError(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
    if (fs::exists(path, error) && !fs::is_regular_file(path, error))
        throw UsageError(fmt::format("cannot write {}: something that is no file stands there", path.string()));
}

FreshFile::FreshFile(fs::path path) : path_(std::move(path)) {
    must_be_writable(path_);
    beside_ = path_;
    beside_.replace_filename(fmt::format(".{}.{}.part", path_.filename().string(), getpid()));
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

std::string read_whole(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream content;
    if (!stream || !(content << stream.rdbuf())) throw UsageError(fmt::format("cannot read {}", path.string()));
    return content.str();
}

}  // namespace jvari

#include "bench/store/fresh_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include "bench/store/usage.hpp"

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
// Names a temporary file: sixteen random digits stand between the two parts.
constexpr const char *part_begin = ".jvari-", *part_end = ".part";
constexpr auto forsaken = std::chrono::hours(24);

fs::path behind_links(fs::path path) {
    std::error_code error;
    for (int k = 0; k < 40 && fs::is_symlink(path, error); ++k) {
        const fs::path to = fs::read_symlink(path, error);
        path = to.is_absolute() ? to : path.parent_path() / to;
    }
    return path;
}
}  // namespace

void must_be_writable(const fs::path& named) {
    const fs::path path = behind_links(named);
    std::error_code error;
    if (fs::is_symlink(path, error))
        throw UsageError(
            fmt::format("cannot write {}: its links lead in a circle", named.string()));
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!path.has_filename() || fs::is_directory(path, error))
        throw UsageError(fmt::format("cannot write {}: it is a folder", path.string()));
    if (!fs::is_directory(folder, error))
        throw UsageError(
            fmt::format("cannot write {}: there is no folder {}", path.string(), folder.string()));
    if (access(folder.c_str(), W_OK) != 0)
        throw UsageError(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
    const bool there = fs::exists(path, error);
    // The name is too long.
    if (error) throw UsageError(fmt::format("cannot write {}: {}", path.string(), error.message()));
    if (there && !fs::is_regular_file(path, error))
        throw UsageError(
            fmt::format("cannot write {}: something that is no file stands there", path.string()));
}

void must_not_replace(const std::vector<NamedFile>& results, const std::vector<NamedFile>& read) {
    const auto same = [](const NamedFile& a, const NamedFile& b) {
        std::error_code error;
        const auto whole = [&error](const fs::path& p) {
            return fs::weakly_canonical(fs::absolute(behind_links(p), error), error);
        };
        return fs::equivalent(a.path, b.path, error) || whole(a.path) == whole(b.path);
    };
    for (std::size_t k = 0; k < results.size(); ++k) {
        const NamedFile& r = results[k];
        const std::string name = r.what + " " + r.path.string() + ": ";
        if (r.path.empty()) continue;
        if (r.path.extension() == ".toml")
            throw UsageError(name +
                             "scenes end in .toml, and this result is none. Choose another "
                             "ending");
        for (const NamedFile& other : read)
            if (!other.path.empty() && same(r, other))
                throw UsageError(name + "this is " + other.what +
                                 ", which would be lost. Choose another name");
        for (std::size_t j = 0; j < k; ++j)
            if (!results[j].path.empty() && same(r, results[j]))
                throw UsageError(name + results[j].what +
                                 " writes that file too, and one of them would be lost. Choose "
                                 "another name");
    }
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder))
        throw UsageError(
            fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
}

FreshFile::FreshFile(fs::path path) : path_(behind_links(std::move(path))) {
    must_be_writable(path_);
    std::random_device random;
    beside_ = path_;
    beside_.replace_filename(
        fmt::format("{}{:08x}{:08x}{}", part_begin, random(), random(), part_end));
    file_ = open(beside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file_ < 0)
        throw Unwritable(fmt::format("cannot write {}: {}", path_.string(), std::strerror(errno)));
}

FreshFile::~FreshFile() {
    close(file_);
    std::error_code ignored;
    if (!kept_) fs::remove(beside_, ignored);
}

void FreshFile::keep() {
    if (fsync(file_) != 0)
        throw Unwritable(fmt::format("cannot write {}: {}", path_.string(), std::strerror(errno)));
    std::error_code error;
    fs::rename(beside_, path_, error);
    if (error)
        throw Unwritable(fmt::format("cannot write {}: {}", path_.string(), error.message()));
    kept_ = true;
}

void write_fresh(const fs::path& path, const std::string& content) {
    FreshFile file(path);
    std::ofstream stream(file.path(), std::ios::binary);
    stream << content;
    stream.close();
    if (!stream)
        throw Unwritable(fmt::format("cannot write {}: {}", path.string(), std::strerror(errno)));
    file.keep();
}

fs::path Scratch::place() {
    const char* set = std::getenv("TMPDIR");
    return set && *set ? set : "/tmp";
}

Scratch::Scratch() {
    std::string name = (place() / "jvari-XXXXXX").string();
    if (mkdtemp(name.data())) path = name;
}

void Scratch::remove() const {
    std::error_code ignored;
    if (!path.empty()) fs::remove_all(path, ignored);
}

void sweep_parts(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> parts;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(part_begin) || !name.ends_with(part_end)) continue;
        const auto written = fs::last_write_time(entry.path(), error);
        if (!error && fs::file_time_type::clock::now() - written > forsaken)
            parts.push_back(entry.path());
    }
    for (const fs::path& file : parts) fs::remove(file, error);
}

std::string read_whole(const fs::path& path) {
    std::error_code error;
    if (fs::exists(path, error) && !fs::is_regular_file(path, error))
        throw UsageError(
            fmt::format("cannot read {}: something that is no file stands there", path.string()));
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream content;
    if (!stream || !(content << stream.rdbuf()))
        throw UsageError(fmt::format("cannot read {}", path.string()));
    return content.str();
}

}  // namespace jvari::bench::store

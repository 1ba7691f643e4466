#include "bench/store/system/file_lock.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <thread>

#include "bench/store/system/side_by_side.hpp"

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
constexpr const char* nobody = "another process";  // stands for the name if the file is empty

enum class Taken { here, elsewhere, impossible };

Taken take(int file, short kind = F_WRLCK) {
    struct stat status = {};
    if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return Taken::impossible;
    struct flock whole = {};
    whole.l_type = kind;
    whole.l_whence = SEEK_SET;
    if (fcntl(file, F_OFD_SETLK, &whole) == 0) return Taken::here;
    return errno == EAGAIN || errno == EACCES ? Taken::elsewhere : Taken::impossible;
}

std::string printable(std::string text) {
    for (char& c : text)
        if (c < ' ' || c > '~') c = '?';
    return text;
}

std::string name_in(int file) {  // holder's name; the holder may not have written it yet
    char text[300];
    const ssize_t n = pread(file, text, sizeof text, 0);
    const std::string name = printable({text, n > 0 ? static_cast<std::size_t>(n) : 0});
    return name.empty() ? nobody : name;
}

std::string own_name() {
    char host[65] = "";
    gethostname(host, sizeof host - 1);
    return fmt::format("process {} on {}", getpid(), host);
}

// Compares the open file with the file at `path`. A holder removes its lock file at the end, so
// another process may lock a file that nobody else will find.
bool stands_at(const fs::path& path, int file) {
    struct stat own = {}, there = {};
    return fstat(file, &own) == 0 && stat(path.c_str(), &there) == 0 &&
           own.st_ino == there.st_ino && own.st_dev == there.st_dev;
}
}  // namespace

FileLock::FileLock(const fs::path& file, const std::string& doing, bool wait)
    : path_(file.string() + ".lock") {
    constexpr int most_removed = 100;
    constexpr std::chrono::milliseconds shortest{20}, longest{250};
    // Polls, because no fcntl call waits for a limited time and a cancelled task would wait on.
    std::optional<Wait> waits;
    auto pause = shortest;
    for (int removed = 0; removed < most_removed && !file.empty();) {
        file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (file_ < 0) return;
        const Taken taken = take(file_);
        if (taken == Taken::here && stands_at(path_, file_)) break;
        const std::string who = taken == Taken::elsewhere ? name_in(file_) : "";
        close(file_);
        file_ = -1;
        if (taken == Taken::impossible) return;
        if (taken == Taken::here) {
            ++removed;
            continue;
        }
        if (!wait) {
            elsewhere_ = true;
            return;
        }
        if (!waits) waits.emplace();
        Wait::sleep(pause, who + ", which " + doing);
        pause = std::min(2 * pause, longest);
    }
    if (!locked()) return;
    const std::string who = own_name();
    // On a full disk the lock holds without a name.
    if (ftruncate(file_, 0) != 0 || pwrite(file_, who.data(), who.size(), 0) < 0) errno = 0;
    removed_too_.emplace([this] { unlink(path_.c_str()); });
}

FileLock::~FileLock() {
    if (!locked()) return;
    removed_too_.reset();
    unlink(path_.c_str());
    close(file_);
}

SharedLock::SharedLock(fs::path file, const std::string& doing) : path_(std::move(file)) {
    constexpr int most_tries = 100;
    constexpr std::chrono::milliseconds pause{10};
    for (int k = 0; k < most_tries && !path_.empty() && !take(printable(doing)); ++k)
        std::this_thread::sleep_for(pause);
    if (file_ >= 0) removed_too_.emplace([this] { remove_if_last(); });
}

SharedLock::~SharedLock() {
    if (file_ < 0) return;
    removed_too_.reset();
    remove_if_last();
    close(file_);
}

bool SharedLock::take(const std::string& doing) {
    const int file =
        open(path_.c_str(), O_RDWR | O_CREAT | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file < 0) return true;
    Taken taken = store::take(file);
    if (taken == Taken::impossible) return close(file), true;
    std::string there = doing;
    if (taken == Taken::elsewhere) {
        taken = store::take(file, F_RDLCK);
        there = name_in(file);
    } else if (stands_at(path_, file)) {
        // On a full disk the lock holds without text.
        if (ftruncate(file, 0) != 0 || pwrite(file, doing.data(), doing.size(), 0) < 0) errno = 0;
        taken = store::take(file, F_RDLCK);
    }
    const bool shared = taken == Taken::here && stands_at(path_, file);
    if (shared && (there == doing || there == nobody)) {
        file_ = file;
        return true;
    }
    close(file);
    if (shared) others_ = there;
    return shared;
}

void SharedLock::remove_if_last() const noexcept {
    if (store::take(file_) == Taken::here && stands_at(path_, file_)) unlink(path_.c_str());
}

std::unique_ptr<FileLock> lock_of(const fs::path& file, const std::string& doing,
                                  const Listener& listener) {
    std::unique_ptr<FileLock> lock;
    side_by_side({1}, 1, listener, "lock",
                 [&](std::size_t, Done&) { lock = std::make_unique<FileLock>(file, doing); });
    return lock;
}

}  // namespace jvari::bench::store

#include "bench/store/system/file_lock.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
std::string first_word(const char* file) {
    std::ifstream stream(file);
    std::string word;
    stream >> word;
    return word.empty() ? "-" : word;
}

std::string start_of(long process) {  // in ticks since the machine started: a process id may come twice, with another start
    std::ifstream stream("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    std::getline(stream, text);
    std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));  // the name before it may hold anything
    for (int k = 0; k < 20; ++k) fields >> text;
    return fields ? text : "-";
}

std::string place_name() {  // where a process id means what it means here
    char host[256] = "-";
    gethostname(host, sizeof host - 1);
    std::error_code error;
    const std::string space = fs::read_symlink("/proc/self/ns/pid", error).string();
    return std::string(host) + " " + first_word("/proc/sys/kernel/random/boot_id") + " " + (space.empty() ? "-" : space);
}

struct Seen {  // a lock, as it lies there
    std::string who;
    timespec touched{};
    bool operator==(const Seen& o) const {
        return who == o.who && touched.tv_sec == o.touched.tv_sec && touched.tv_nsec == o.touched.tv_nsec;
    }
};

Seen look(const fs::path& path) {
    Seen s;
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);  // opening asks the server, where stat may tell what it told before
    if (file < 0) return s;
    char text[512];
    const ssize_t n = read(file, text, sizeof text);
    s.who.assign(text, n > 0 ? static_cast<std::size_t>(n) : 0);
    if (struct stat status{}; fstat(file, &status) == 0) s.touched = status.st_mtim;
    close(file);
    return s;
}

bool is_gone(const std::string& who) {  // for certain: it was of this machine and is no more
    const std::string here = place_name() + " ";
    if (!who.starts_with(here)) return false;
    std::istringstream rest(who.substr(here.size()));
    long process = 0;
    std::string start;
    if (!(rest >> process >> start) || process <= 0) return false;
    return (kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH) || start_of(process) != start;
}

// Another may have been faster, and a third may hold the lock by now: that is seen once it was moved aside, and put back.
void take_away(const fs::path& path, const std::string& who) {
    const fs::path aside = path.string() + "." + std::to_string(getpid()) + ".gone";
    if (rename(path.c_str(), aside.c_str()) != 0) return;
    if (look(aside).who != who && link(aside.c_str(), path.c_str()) != 0) errno = 0;  // a fourth was faster still
    unlink(aside.c_str());
}
}  // namespace

std::string process_name() {
    return place_name() + " " + std::to_string(getpid()) + " " + start_of(getpid());
}

bool FileLock::take() {
    file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_ < 0) return errno != EEXIST;
    const std::string who = process_name();
    if (::write(file_, who.data(), who.size()) < 0) errno = 0;  // a full disk: an empty one counts as gone once nobody touches it
    return true;
}

FileLock::FileLock(fs::path path, const std::function<bool()>& there, const Patience& patience) : path_(std::move(path)) {
    using Clock = std::chrono::steady_clock;
    Seen last;
    auto since = Clock::now();
    for (std::chrono::milliseconds pause{10}; !there() && !take(); pause = std::min(2 * pause, patience.poll)) {
        const Seen now = look(path_);
        if (!(now == last)) last = now, since = Clock::now();
        if (is_gone(now.who) || Clock::now() - since > patience.stale) {
            take_away(path_, now.who);
            continue;
        }
        std::this_thread::sleep_for(pause);
    }
    if (!held()) return;
    released_too_.emplace([this] { unlink_own(); });
    heart_ = std::thread([this, every = patience.beat] { beat(every); });
}

void FileLock::beat(std::chrono::milliseconds every) {
    std::unique_lock lock(mutex_);
    while (!released_.wait_for(lock, every, [this] { return ending_; })) futimens(file_, nullptr);
}

FileLock::~FileLock() {
    if (!held()) return;
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    released_.notify_one();
    heart_.join();
    released_too_.reset();
    unlink_own();
    close(file_);
}

void FileLock::unlink_own() const {
    struct stat own = {}, there = {};  // it is another's where this one was taken for gone
    if (fstat(file_, &own) == 0 && stat(path_.c_str(), &there) == 0 && own.st_ino == there.st_ino && own.st_dev == there.st_dev)
        unlink(path_.c_str());
}

}  // namespace jvari::bench::store

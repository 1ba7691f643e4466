// One process at a time makes what others wait for: a lock is a file that only one of them can create, on a network file system too
// (O_EXCL, NFS 3 and later). It says who holds it. The holder touches it every few seconds.
//
// A lock whose holder is gone is taken away: one of this machine at once, by its process id and start; another machine's once its file was
// not touched for a while, by the clock of the one who waits. A holder that was suspended for so long may meet a second one. So a lock
// saves work, and what it guards appears by rename: two who make it write the same.
#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "bench/store/system/interruption.hpp"

namespace jvari::bench::store {

struct Patience {
    std::chrono::milliseconds beat{5000}, stale{120000}, poll{1000};  // poll: at most so long between two looks
};

class FileLock {
public:
    // Waits for the lock, or until `there()` says that nothing is left to do. Where no file can be created it waits for nobody.
    FileLock(std::filesystem::path, const std::function<bool()>& there, const Patience& = {});
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;
    bool held() const { return file_ >= 0; }

private:
    bool take();
    void beat(std::chrono::milliseconds every);
    void unlink_own() const;
    const std::filesystem::path path_;
    int file_ = -1;
    std::mutex mutex_;  // of what follows
    std::condition_variable released_;
    bool ending_ = false;
    std::thread heart_;
    std::optional<WhenInterrupted> released_too_;  // by an interruption: another machine would wait for long
};

// This process, as no other is named: "host boot namespace pid start".
std::string process_name();

}  // namespace jvari::bench::store

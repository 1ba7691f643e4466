// Locks let one process at a time compute a result that several processes want. The lock is an
// open-file-description lock (fcntl, F_OFD_SETLK) on FILE.lock. The system releases the lock when
// its holder dies, network file systems ask their server for it, and it works between threads as
// well.
//
// Deadlock is impossible, because a process that waits for a lock holds only locks of earlier
// kinds. The order of kinds begins with the tables of a folder, a certificate, the costs of a
// folder. Then follow a boundary or a failure of a map, a reference of a study, a reference in the
// user's cache, a job. The holder of a job waits for nothing.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "bench/store/system/interruption.hpp"
#include "bench/store/system/listener.hpp"

namespace jvari::bench::store {

class FileLock {
public:
    // Takes the lock for `file`. If another process or thread holds the lock, waits until it is
    // free, or continues without a lock (`elsewhere`). `doing` says what the holder does: "runs
    // free_string: modal_two_point".
    //
    // No lock is taken if none is possible: no write permission in the folder, a file system
    // without locks, something other than a file at the path, or the file "". A lock therefore only
    // saves work: results appear by rename, and two processes that compute the same result write
    // the same file.
    FileLock(const std::filesystem::path& file, const std::string& doing, bool wait = true);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;
    bool locked() const { return file_ >= 0; }
    bool elsewhere() const { return elsewhere_; }

private:
    const std::filesystem::path path_;
    int file_ = -1;
    bool elsewhere_ = false;
    std::optional<WhenInterrupted> removed_too_;
};

// For callers outside side_by_side: the listener is told who holds the lock, and can end the wait.
std::unique_ptr<FileLock> lock_of(const std::filesystem::path& file, const std::string& doing,
                                  const Listener&);

// Lock shared by all holders that do the same work, identified by the text `doing`. The file at the
// path contains the text, and its last holder removes the file.
class SharedLock {
public:
    // No lock is taken for the file "", as in FileLock.
    SharedLock(std::filesystem::path file, const std::string& doing);
    ~SharedLock();
    SharedLock(const SharedLock&) = delete;
    SharedLock& operator=(const SharedLock&) = delete;
    // work of the other holders if different, else ""
    const std::string& others() const { return others_; }

private:
    // false: another process was just taking or removing the lock
    bool take(const std::string& doing);
    void remove_if_last() const noexcept;

    const std::filesystem::path path_;
    int file_ = -1;
    std::string others_;
    std::optional<WhenInterrupted> removed_too_;
};

}  // namespace jvari::bench::store

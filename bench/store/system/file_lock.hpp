// One process at a time computes what several want. The lock is an open-file-description lock
// (fcntl, F_OFD_SETLK) on FILE.lock: the system releases it when its holder dies, network file
// systems ask their server for it, and it holds between threads as well.
//
// No two can wait for each other: who waits for a lock holds none but of an earlier kind in this
// order: the tables of a folder, a certificate, the costs of a folder, a boundary or a failure of a
// map, a reference of a study, a reference of the user's cache, a job. The holder of a job waits
// for nothing.
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
    // Takes the lock of `file`. Where another process or thread has it, waits until it is free, or
    // does without (`elsewhere`). `doing` is what the holder does: "runs free_string:
    // modal_two_point". Where no lock can be had, there is none: in a folder that cannot be
    // written, on a file system without locks, where something stands in its place that is no
    // file, or for the file "". So a lock saves work: what it guards appears by rename, and two
    // who compute it write the same.
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

// For who is not within side_by_side: the listener hears for whom it waits, and can end that.
std::unique_ptr<FileLock> lock_of(const std::filesystem::path& file, const std::string& doing,
                                  const Listener&);

// A lock that several hold at once who do the same, by its words. The file at that path holds them,
// and goes with its last holder.
class SharedLock {
public:
    // Of "" none, as of a FileLock.
    SharedLock(std::filesystem::path file, const std::string& doing);
    ~SharedLock();
    SharedLock(const SharedLock&) = delete;
    SharedLock& operator=(const SharedLock&) = delete;
    const std::string& others() const { return others_; }  // do what, if not the same; else ""

private:
    bool take(const std::string& doing);  // false: another was just taking or removing it
    void remove_if_last() const noexcept;

    const std::filesystem::path path_;
    int file_ = -1;
    std::string others_;
    std::optional<WhenInterrupted> removed_too_;
};

}  // namespace jvari::bench::store

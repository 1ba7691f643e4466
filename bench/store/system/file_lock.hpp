// One process at a time does what several want to see done. The lock is an open-file-description
// lock (fcntl, F_OFD_SETLK) on FILE.lock: the system releases it when its holder dies, network file
// systems ask their server for it, and it holds between threads as well.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bench/store/system/interruption.hpp"

namespace jvari::bench::store {

struct Busy {         // no std::exception: nothing has failed, it is to be tried again later
    std::string who;  // "process 1234 on node7, which runs free_string: modal_two_point"
};

class FileLock {
public:
    // Takes the lock of `file`, or throws Busy at once. `doing` is what the holder does: "runs
    // free_string: modal_two_point". Where no lock can be had, there is none: in a folder that
    // cannot be written, on a file system without locks, where something stands in its place that
    // is no file, or for the file "". So a lock saves work: what it guards appears by rename, and
    // two who make it write the same.
    FileLock(const std::filesystem::path& file, const std::string& doing);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;
    bool held() const { return file_ >= 0; }

private:
    const std::filesystem::path path_;
    int file_ = -1;
    std::optional<WhenInterrupted> removed_too_;
};

}  // namespace jvari::bench::store

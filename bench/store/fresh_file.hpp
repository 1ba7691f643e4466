// Files appear whole or not at all: written beside their place, then renamed onto it. Where a link stands there, its target is written.
#pragma once

#include <filesystem>
#include <string>

#include "bench/store/system/interruption.hpp"

namespace jvari::bench::store {

class FreshFile {
public:
    explicit FreshFile(std::filesystem::path);  // throws UsageError where it could not be written
    ~FreshFile();                               // removes what was written where it was not kept
    FreshFile(const FreshFile&) = delete;
    FreshFile& operator=(const FreshFile&) = delete;
    const std::filesystem::path& path() const { return beside_; }  // write here
    void keep();                                                   // flushes to the disk and renames; throws Unwritable

private:
    Undisturbed writing_;  // an interruption leaves no part behind
    std::filesystem::path path_, beside_;
    bool kept_ = false;
};

void write_fresh(const std::filesystem::path&, const std::string& content);  // throws UsageError, Unwritable
std::string read_whole(const std::filesystem::path&);                        // throws UsageError

// Throws UsageError where no file could be written there, before an hour of work is spent on it.
void must_be_writable(const std::filesystem::path&);

// Removes from a folder of ours what killed programs left: parts of files of processes that are no more, and that nobody has written to for
// an hour (a process of another container is not seen from here); of another machine's, what nobody has written to for a day.
void sweep_parts(const std::filesystem::path& folder);

}  // namespace jvari::bench::store

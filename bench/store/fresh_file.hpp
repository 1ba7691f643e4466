// Writes files whole or not at all: a temporary file beside the destination is renamed onto it. If
// the destination is a link, its target is written. The temporary file is new and has an
// unpredictable name, so no link planted by somebody else is followed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/store/system/interruption.hpp"

namespace jvari::bench::store {

class FreshFile {
public:
    explicit FreshFile(std::filesystem::path);  // throws UsageError, Unwritable
    ~FreshFile();  // removes the temporary file unless keep() was called
    FreshFile(const FreshFile&) = delete;
    FreshFile& operator=(const FreshFile&) = delete;
    const std::filesystem::path& path() const { return beside_; }  // write here
    // Flushes to the disk and renames; throws Unwritable.
    void keep();

private:
    Undisturbed writing_;  // an interruption leaves no temporary file behind
    std::filesystem::path path_, beside_;
    int file_ = -1;
    bool kept_ = false;
};

// Throws UsageError, Unwritable.
void write_fresh(const std::filesystem::path&, const std::string& content);
std::string read_whole(const std::filesystem::path&);  // throws UsageError

// Files of one call. Each is called by its option ("--out") or by its role ("the scene").
struct NamedFile {
    std::string what;
    std::filesystem::path path;
};
// Throws UsageError if a result would replace an input file or another result, or if its name ends
// in .toml, the ending reserved for scenes.
void must_not_replace(const std::vector<NamedFile>& results, const std::vector<NamedFile>& read);

void make_folder(const std::filesystem::path&);  // makes a missing folder; throws UsageError
// Throws UsageError if no file can be written there, before an hour of work is wasted.
void must_be_writable(const std::filesystem::path&);

// A temporary folder of our own in $TMPDIR, or in /tmp. It is removed at the end or at an
// interruption. The path is empty if no folder can be made.
class Scratch {
public:
    Scratch();
    ~Scratch() { remove(); }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    static std::filesystem::path place();
    std::filesystem::path path;

private:
    void remove() const;
    const WhenInterrupted removed_{[this] { remove(); }};
};

// Removes the remains of killed programs from one of our folders: temporary files that nobody has
// written to for a day.
void sweep_parts(const std::filesystem::path& folder);

}  // namespace jvari::bench::store

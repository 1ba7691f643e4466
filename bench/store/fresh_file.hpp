// Files appear whole or not at all: written beside their place, then renamed onto it. Where a link
// stands there, its target is written. What is written beside it has a name that nobody can
// foretell, and was not there before: no link that somebody planted is followed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/store/system/interruption.hpp"

namespace jvari::bench::store {

class FreshFile {
public:
    explicit FreshFile(std::filesystem::path);  // throws UsageError, Unwritable
    ~FreshFile();                               // removes what was written where it was not kept
    FreshFile(const FreshFile&) = delete;
    FreshFile& operator=(const FreshFile&) = delete;
    const std::filesystem::path& path() const { return beside_; }  // write here
    // flushes to the disk and renames; throws Unwritable
    void keep();

private:
    Undisturbed writing_;  // an interruption leaves no part behind
    std::filesystem::path path_, beside_;
    int file_ = -1;
    bool kept_ = false;
};

// throws UsageError, Unwritable
void write_fresh(const std::filesystem::path&, const std::string& content);
std::string read_whole(const std::filesystem::path&);  // throws UsageError

// Files of one call, each by the option that names it or by what it is: "--out", "the scene".
struct NamedFile {
    std::string what;
    std::filesystem::path path;
};
// Throws UsageError where a result would replace a file that is read or another result, or has the
// ending of scenes, .toml.
void must_not_replace(const std::vector<NamedFile>& results, const std::vector<NamedFile>& read);

void make_folder(const std::filesystem::path&);  // where there is none; throws UsageError
// Throws UsageError where no file could be written there, before an hour of work is spent on it.
void must_be_writable(const std::filesystem::path&);

// A folder of our own in $TMPDIR, or /tmp, gone at the end or at an interruption; its path is empty
// where none can be made.
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

// Removes from a folder of ours what killed programs left: parts of files that nobody has written
// to for a day.
void sweep_parts(const std::filesystem::path& folder);

}  // namespace jvari::bench::store

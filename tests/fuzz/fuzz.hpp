// Shared by the targets: what happens if an input breaks a promise, and where the files of a target
// are.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace jvari::test {

// Counts the inputs that were accepted. driver.cpp checks that the seeds good_... are: a target
// that refuses all inputs tests nothing.
inline long inputs_read = 0;

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

inline void promise(bool kept, const char* what, const std::string& of = {}) {
    if (kept) return;
    std::fprintf(stderr, "broken: %s\n%s\n", what, of.c_str());
    std::abort();
}

// A file that only this process uses, in memory if possible. Each input overwrites it.
class OwnFile {
public:
    explicit OwnFile(const std::string& name) {
        const bool memory = access("/dev/shm", W_OK) == 0;
        path_ =
            (memory ? std::filesystem::path("/dev/shm") : std::filesystem::temp_directory_path()) /
            ("jvari-fuzz-" + std::to_string(getpid()) + "-" + name);
    }
    ~OwnFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    OwnFile(const OwnFile&) = delete;
    OwnFile& operator=(const OwnFile&) = delete;
    const std::filesystem::path& holding(const std::string& content) {
        std::ofstream(path_, std::ios::binary) << content;
        return path_;
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace jvari::test

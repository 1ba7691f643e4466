// What git says: a program of the PATH asked without a shell.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace jvari::bench::diff {

struct Said {
    int code = 0;  // of the program; -errno where it could not be started
    std::string text;
};
Said git(const std::filesystem::path& folder, const std::vector<std::string>& words);  // in that folder; what it says of errors is not kept

}  // namespace jvari::bench::diff

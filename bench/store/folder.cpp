#include "bench/store/folder.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "bench/store/json.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::store {

namespace fs = std::filesystem;

namespace {
[[noreturn]] void refuse(const Folder& folder, const std::string& file, const char* why) {
    throw UsageError(fmt::format("{}/{}: {}", folder.path.string(), file, why));
}

std::optional<std::string> content(const fs::path& file) {  // nothing where there is none
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return std::nullopt;
    return read_whole(file);
}
}  // namespace

nlohmann::ordered_json Folder::manifest() const {
    const auto text = content(path / "manifest.json");
    if (!text)
        throw UsageError(path.string() +
                         ": no manifest.json, expected a folder that compare, suite or trim wrote");
    try {
        auto m = parsed(*text);
        return m.is_object() ? m : throw std::runtime_error("it holds no object");
    } catch (const std::exception& e) { refuse(*this, "manifest.json", e.what()); }
}

Table Folder::table(const std::string& file) const {
    const auto text = content(path / (file + ".csv"));
    if (!text) return {};
    try {
        return read_csv(as_utf8(*text));
    } catch (const std::exception& e) { refuse(*this, file + ".csv", e.what()); }
}

}  // namespace jvari::bench::store

// A folder of results over the commits that changed it: what each commit made of it, by the rules of difference.hpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/diff/difference.hpp"
#include "bench/store/system/listener.hpp"

namespace jvari::bench::diff {

struct Step {
    std::string commit, date, subject;
    std::optional<Difference> change;  // from the step before; none for the first, and where `why` says why
    std::string why;
};

// Oldest first. Throws UsageError where there is no git, no repository, or no commit of the
// folder.
std::vector<Step> history(const std::filesystem::path& folder, const store::Listener&);

std::string text_of(const std::vector<Step>&);
std::string json_of(const std::vector<Step>&);

}  // namespace jvari::bench::diff

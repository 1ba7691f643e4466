// The folder that results go to: of one comparison or one suite, so that no page mixes what was measured apart.
#pragma once

#include <filesystem>
#include <string>

#include "bench/store/listener.hpp"

namespace jvari::bench::command {

// Before anything is run. Throws UsageError where the folder holds the results of something else than `what` ("comparison of tanpura_c3",
// "suite smoke"); notes files that no such folder has, which stay where they are. A folder that is not there is empty.
void must_be_ours(const std::filesystem::path& folder, const std::string& what, const store::Listener&);

}  // namespace jvari::bench::command

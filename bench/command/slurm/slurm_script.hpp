// The script of a Slurm array whose tasks share the folder of a suite: each runs `jvari suite X --out DIR --resume`.
#pragma once

#include <string>
#include <vector>

#include "bench/suite/suite_file.hpp"

namespace jvari::bench::command {

// Throws UsageError where a name holds a control character: a line break would be a line of the script.
std::string slurm_script(const suite::Suite&, const std::string& name, const std::string& out, const std::vector<std::string>& plugins);

}  // namespace jvari::bench::command

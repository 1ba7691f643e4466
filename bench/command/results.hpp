// What the verbs that compare schemes say of their results.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/report/results_folder.hpp"
#include "bench/study/record.hpp"

namespace jvari::bench::command {

// The exit code of a study: done where a run of it was, or where there was nothing to run.
int code_of(const std::vector<study::Record>&);

// What `compare`, `judge` and `suite` say of their results as JSON, behind what is their own.
std::string with_results(nlohmann::ordered_json own, const report::Written&);

}  // namespace jvari::bench::command

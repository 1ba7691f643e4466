// A suite by several processes: what is planned, a share of it, and the script that has a cluster do it. bench/suites/README.md says how.
#pragma once

#include "bench/command/arguments.hpp"
#include "bench/command/console.hpp"
#include "bench/suite/suite_parts.hpp"

namespace jvari::bench::command {

int prepare_suite(const SuiteRequest&, suite::SuitePlan&, const suite::Parts&, const Console&);
int run_shard(const SuiteRequest&, suite::SuitePlan&, const suite::Parts&, const compare::Catalogue&, const Console&);
int print_script(const SuiteRequest&, const suite::Parts&, const Console&);

}  // namespace jvari::bench::command

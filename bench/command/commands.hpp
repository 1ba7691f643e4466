// The verbs. Each returns the program's exit code, or throws: UsageError, BadScene, SceneFileError (2), Refusal (3).
#pragma once

#include "bench/command/arguments.hpp"

namespace jvari::bench::command {

int new_command(const NewRequest&);
int list_command(const ListRequest&);
int run_command(const RunRequest&);
int compare_command(const CompareCall&);
int suite_command(const SuiteRequest&);
int trim_command(const TrimCall&);
int certify_command(const CertifyRequest&);
int report_command(const ReportRequest&);
int diff_command(const DiffRequest&);
int check_command(const CheckRequest&);

}  // namespace jvari::bench::command

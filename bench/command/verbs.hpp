// The verbs. A verb is a file: its arguments, which it adds to the command line with their help,
// and what it does with them.
#pragma once

#include "bench/command/arguments.hpp"

namespace jvari::bench::command {

Act new_verb(CLI::App& program);
Act list_verb(CLI::App& program);
Act run_verb(CLI::App& program);
Act compare_verb(CLI::App& program);
Act suite_verb(CLI::App& program);
Act trim_verb(CLI::App& program);
Act certify_verb(CLI::App& program);
Act report_verb(CLI::App& program);
Act diff_verb(CLI::App& program);
Act check_verb(CLI::App& program);
Act export_verb(CLI::App& program);
Act judge_verb(CLI::App& program);

// as --help lists them
constexpr Act (*verbs[])(CLI::App&) = {new_verb,   list_verb,  run_verb,     compare_verb,
                                       suite_verb, trim_verb,  certify_verb, report_verb,
                                       diff_verb,  check_verb, export_verb,  judge_verb};

}  // namespace jvari::bench::command

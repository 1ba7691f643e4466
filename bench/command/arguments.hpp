// Arguments that several verbs have, and what their texts may be.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/compare/request.hpp"

namespace jvari::bench::command {

struct Common {
    bool json = false, quiet = false;
    std::vector<std::string> plugins;
};

std::string a_number(const std::string& text, bool whole);  // "" where it is one that is > 0; else what was expected
extern const CLI::Validator positive, counting;             // a number > 0; a whole one
extern const CLI::Validator hertz, seconds,
    metres;  // a number > 0 that may have its unit behind it: the text becomes the number in SI units

void add_common(CLI::App& verb, Common&);
void add_scene(CLI::App& verb, std::string& scene);
void add_set(CLI::App& verb, std::vector<std::string>& set);
void add_modes(CLI::App& verb, int& modes);
void add_options(CLI::App& verb, std::vector<std::string>& options);
void add_jobs(CLI::App& verb, int& jobs);
void add_duration(CLI::App& verb, std::optional<double>& duration);
void add_schemes(CLI::App& verb, std::vector<std::string>& schemes, const char* what);
void add_reference(CLI::App& verb, std::string& reference);
void add_comparison_folder(CLI::App& verb, std::string& out);

// Both throw UsageError: what is no KEY.PATH=VALUE, what is no [SCHEME:]NAME=VALUE.
void must_be_assignments(const std::vector<std::string>& set);
std::vector<compare::SchemeOption> scheme_options(const std::vector<std::string>& texts);
// Each value of a list for itself; UsageError where an option is named twice.
std::vector<compare::SchemeOption> listed_options(const std::vector<std::string>& texts);

}  // namespace jvari::bench::command

// The command line as values: one struct per verb.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bench/compare/request.hpp"
#include "bench/trim/judge.hpp"

namespace jvari::bench::command {

struct Common {
    bool json = false, quiet = false;
    std::vector<std::string> plugins;
};

struct NewRequest : Common {
    std::string instrument, name;
};

struct ListRequest : Common {
    std::string what;  // "": everything
    bool markdown = false;
};

struct RunRequest : Common {
    std::string scene, scheme;
    std::optional<double> rate;  // [Hz]
    int modes = 0;
    std::optional<double> duration;  // [s]
    std::optional<double> tap_rate;  // [Hz]
    bool energy = false;
    std::vector<std::string> set;
    std::vector<compare::SchemeOption> options;
    std::string out, wav_format, plot;
    bool mono = false;
};

struct CompareCall : Common, compare::CompareRequest {
    bool resume = false;
};

struct ReportRequest : Common {
    std::string folder;
};

struct SuiteRequest : Common {
    std::string suite, out;
    bool resume = false;
    std::string print;  // "slurm"
    int jobs = 0;       // 0: as many as there are cores
};

struct TrimCall : Common, trim::Request {};

struct CertifyRequest : Common {
    std::string scene, out, reference;
    int modes = 0;
    std::optional<double> duration, tap_rate, oversampled_rate;  // [s], [Hz], [Hz]
    std::vector<std::string> set;
    bool again = false;
};

struct DiffRequest : Common {
    std::string before, after;  // folders
    std::string history;        // one folder, in place of the two
};

struct CheckRequest : Common {
    std::vector<std::string> schemes;  // none: those of the plugins
    std::string junit;
};

using Request = std::variant<NewRequest, ListRequest, RunRequest, CompareCall, SuiteRequest, TrimCall, CertifyRequest, ReportRequest,
                             DiffRequest, CheckRequest>;

const char* welcome();  // what there is to do, in ten lines: for those who call it without a verb

// Throws UsageError. No value: help or the version was asked for and printed.
std::optional<Request> read_arguments(int argc, const char* const* argv);

}  // namespace jvari::bench::command

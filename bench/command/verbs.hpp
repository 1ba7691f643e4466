// Verbs. Each verb is a file: it adds arguments with their help to the command line, and runs the
// command.
#pragma once

#include <CLI/CLI.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/report/results.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/study/record.hpp"

namespace jvari::bench::command {

// ---- Arguments: shared by several verbs, with checks for the text.

struct Common {
    bool json = false, quiet = false;
};
struct Running : Common {  // base for verbs that run schemes
    std::vector<std::string> plugins;
};

struct Value {  // an option's value: name in the help, and check
    const char* type;
    CLI::Validator check = {};
};
// Number > 0; whole number > 0; whole number >= 0; then numbers > 0 with an optional unit. The
// check replaces the text by the number in SI units.
extern const Value positive, counting, counting_or_0, hertz, seconds, metres;

// Runs a verb once its arguments are read, and returns the exit code of the program. Throws
// UsageError, BadScene, SceneFileError (2), Refusal (3).
using Act = std::function<int()>;

class Arguments {
public:
    explicit Arguments(CLI::App& verb) : verb_(verb) {}
    template <class T>
    CLI::Option* option(const char* name, T& to, const Value& value, const std::string& help) {
        return verb_.add_option(name, to, help)->type_name(value.type)->transform(value.check);
    }
    template <class T>
    CLI::Option* option(const compare::FieldWords& field, T& to, const Value& value) {
        std::string flag = std::string("--") + field.name;
        std::ranges::replace(flag, '_', '-');
        return option(flag.c_str(), to, value,
                      std::string(field.meaning) + "; absent: " + field.absent);
    }
    void flag(const char* name, bool& to, const char* help) { verb_.add_flag(name, to, help); }

    void common(Common&);
    void common(Running&);
    void scene(std::string&);
    void set(std::vector<std::string>&);
    void modes(int&);
    void options(std::vector<std::string>&);
    void jobs(int&);
    void comparison_folder(std::string&);

    void group();  // groups options under headings

protected:
    CLI::App& verb_;
};

template <class Request>
class Verb : public Arguments {
    const std::shared_ptr<Request> request_ = std::make_shared<Request>();

public:
    Verb(CLI::App& program, const char* name, const char* about)
        : Arguments(*program.add_subcommand(name, about)) {}
    Request& r = *request_;  // arguments; `act` gets them once they are read
    Act does(auto act, const std::string& footer) {
        common(r);
        group();
        verb_.footer(footer);
        return [request = request_, act] { return act(*request); };
    }
};

std::vector<compare::SchemeOption> scheme_options(const std::vector<std::string>& texts);
// Splits the values of a list; throws UsageError if an option is named twice.
std::vector<compare::SchemeOption> listed_options(const std::vector<std::string>& texts);

// Lists a scene's files, and other files that a call reads.
std::vector<store::NamedFile> files_read(const Scene&, const std::string& scene,
                                         const std::vector<std::string>& plugins);

// ---- The verbs

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

// Order in --help.
constexpr Act (*verbs[])(CLI::App&) = {new_verb,   list_verb,  run_verb,     compare_verb,
                                       suite_verb, trim_verb,  certify_verb, report_verb,
                                       diff_verb,  check_verb, export_verb,  judge_verb};

// ---- Output by the verbs for comparing schemes.

// Exit code for a study: done if at least one run succeeded or none was needed, refused if all were
// refused.
int code_of(const std::vector<study::Record>&);

// JSON results for `compare`, `judge` and `suite`, appended to the verb's own members.
std::string with_results(nlohmann::ordered_json own, const report::Written&);

}  // namespace jvari::bench::command

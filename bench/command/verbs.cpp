#include "bench/command/verbs.hpp"

#include <fmt/core.h>

#include <cmath>
#include <set>
#include <sstream>

#include "bench/judge/judge.hpp"
#include "bench/store/keys.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"

namespace jvari::bench::command {

namespace {
// Returns "" for a number, and rewrites the text so that CLI11 reads the same number: CLI11 would
// read 010 as 8 and 1e3 as 1. Otherwise returns the expected input.
std::string a_number(std::string& text) {
    const auto x = number_of(text);
    if (!x || !std::isfinite(*x) || !(*x > 0))
        return fmt::format("found {}, expected a number > 0", found_text(text));
    text = number_text(*x);
    return {};
}

std::string a_count(std::string& text, int least) {
    const auto x = number_of(text);
    if (!x || *x != std::floor(*x) || !(*x >= least && *x <= store::most_counted))
        return fmt::format("found {}, expected a whole number from {} to {}", found_text(text),
                           least, store::most_counted);
    text = fmt::format("{:.0f}", *x);
    return {};
}

// reads "44.1k", "10ms"
CLI::Validator in_units(std::vector<std::pair<std::string, double>> units) {
    return CLI::Validator(
        [units = std::move(units)](std::string& text) {
            for (const auto& [unit, scale] : units) {
                if (!text.ends_with(unit)) continue;
                std::string number = text.substr(0, text.size() - unit.size());
                if (a_number(number).empty())
                    text = fmt::format("{:.15g}", scale * store::number_of(number));
                break;
            }
            return a_number(text);
        },
        "");
}

Value assignment(const char* type) {
    return {type, CLI::Validator(
                      [type](std::string& text) {
                          const auto equals = text.find('=');
                          const bool named = equals != std::string::npos && equals > 0 &&
                                             text[0] != ':' && text[equals - 1] != ':';
                          return named ? "" : fmt::format("found \"{}\", expected {}", text, type);
                      },
                      "")};
}
}  // namespace

const Value positive{"X", CLI::Validator([](std::string&text) { return a_number(text); }, "")},
    counting{"N", CLI::Validator([](std::string&text) { return a_count(text, 1); }, "")},
    counting_or_0{"N", CLI::Validator([](std::string&text) { return a_count(text, 0); }, "")},
    hertz{"HZ", in_units({{"kHz", 1e3}, {"Hz", 1}, {"k", 1e3}})},
    seconds{"S", in_units({{"ms", 1e-3}, {"us", 1e-6}, {"s", 1}})},
    metres{"M", in_units({{"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}, {"\"", 0.0254}, {"m", 1}})};

void Arguments::group() {
    static const std::set<std::string> fine{
        "--modes",    "--reference-modes", "--rate", "--rates", "--tap-rate",
        "--duration", "--repeats",         "--jobs", "--resume"},
        where{"--out",    "--plot",  "--width", "--state", "--impacts",   "--junit",
              "--energy", "--facts", "--json",  "--quiet", "--playground"};
    for (CLI::Option* o : verb_.get_options())
        o->group(fine.contains(o->get_name())    ? "How long and how finely"
                 : where.contains(o->get_name()) ? "What comes out, and where to"
                                                 : "What");
}

void Arguments::common(Common& c) {
    flag("--json", c.json, "one JSON object on standard output, nothing else there");
    flag("--quiet", c.quiet,
         "errors only: no messages, no progress, no result as text (`list` still lists)");
}

void Arguments::common(Running& c) {
    common(static_cast<Common&>(c));
    option("--plugin", c.plugins, {"LIB.so"}, "shared object with further schemes (repeatable)")
        ->allow_extra_args(false);
    verb_
        .add_option_function<std::vector<std::string>>(
            "--external",
            [&c](const std::vector<std::string>& commands) {
                for (const std::string& command : commands)
                    c.plugins.push_back(judge::enter_external(command));
            },
            "any program as a scheme, named after its file without the ending: it is called with "
            "the paths of the problem (JSON) and of the trace that it writes, .csv with time_s and "
            "a column for each tap (repeatable)")
        ->type_name("COMMAND")
        ->allow_extra_args(false);
}

void Arguments::scene(std::string& scene) {
    option("scene", scene, {"SCENE"}, "a scene file, or a name that `jvari list scenes` shows")
        ->required();
}

void Arguments::set(std::vector<std::string>& set) {
    option("--set", set, assignment("KEY.PATH=VALUE"),
           "overrides a key of the scene, as string.0.barrier.0.stiffness=1e9 (repeatable)")
        ->allow_extra_args(false);
}

void Arguments::modes(int& modes) {
    option("--modes", modes, counting,
           "modes of each string, and as many nodes of modal_spatial_newton; finite differences "
           "have --option grid=N; absent: every mode below min(20 kHz, rate/2)");
}

void Arguments::options(std::vector<std::string>& options) {
    option("--option", options, assignment("[SCHEME:]NAME=VALUE"),
           "an option of a scheme, as NAME=VALUE or SCHEME:NAME=VALUE (repeatable). In compare the "
           "short form goes to every compared scheme that knows the name, never to the reference; "
           "several values, as compliance=own,matched, are run one by one")
        ->allow_extra_args(false);
}

void Arguments::jobs(int& jobs) {
    option("--jobs", jobs, counting,
           "accuracy runs side by side; as many as there are cores where absent. Timed runs go one "
           "at a time");
}

void Arguments::comparison_folder(std::string& out) {
    option("--out", out, {"DIR"},
           "folder for cells.csv, errors.csv, cost.csv, manifest.json, results.json, "
           "work_precision.svg, report.html");
}

std::vector<compare::SchemeOption> scheme_options(const std::vector<std::string>& texts) {
    std::vector<compare::SchemeOption> options;
    for (const std::string& text : texts)
        options.push_back(compare::SchemeOption::of(text.substr(0, text.find('=')),
                                                    text.substr(text.find('=') + 1)));
    return options;
}

std::vector<compare::SchemeOption> listed_options(const std::vector<std::string>& texts) {
    const std::vector<compare::SchemeOption> lists = scheme_options(texts);
    std::vector<compare::SchemeOption> options;
    for (std::size_t k = 0; k < lists.size(); ++k) {
        const compare::SchemeOption& list = lists[k];
        for (std::size_t j = 0; j < k; ++j)
            if (lists[j].scheme == list.scheme && lists[j].name == list.name)
                throw store::UsageError(fmt::format(
                    "--option {}: found more than once; several values stand in one list, {}={},{}",
                    list.name, list.name, lists[j].value, list.value));
        std::istringstream values(list.value);
        for (std::string value; std::getline(values, value, ',');)
            options.push_back({list.scheme, list.name, value});
        if (list.value.empty()) options.push_back(list);
    }
    return options;
}

std::vector<store::NamedFile> files_read(const Scene& scene, const std::string& name,
                                         const std::vector<std::string>& plugins) {
    std::vector<store::NamedFile> read;
    for (const std::string& file : files_of(scene, name))
        read.push_back({read.empty() ? "the scene" : "a table of the scene", file});
    for (const std::string& file : plugins) read.push_back({"a plugin", file});
    return read;
}

}  // namespace jvari::bench::command

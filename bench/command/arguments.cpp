#include "bench/command/arguments.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "bench/judge/external.hpp"
#include "bench/store/keys.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::command {

std::string a_number(const std::string& text, bool whole) {
    double x = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error == std::errc() && stop == text.data() + text.size() && std::isfinite(x) && x > 0 &&
        (!whole || (x == std::floor(x) && x <= store::most_counted)))
        return {};
    return fmt::format("found \"{}\", expected a {}", text,
                       whole ? fmt::format("whole number from 1 to {}", store::most_counted) : "number > 0");
}
namespace {
// A quantity may have its unit behind it, "44.1k" or "10ms": the text becomes the number in SI units.
CLI::Validator in_units(std::vector<std::pair<std::string, double>> units) {
    return CLI::Validator(
        [units = std::move(units)](std::string& text) {
            for (const auto& [unit, scale] : units) {
                if (!text.ends_with(unit)) continue;
                const std::string number = text.substr(0, text.size() - unit.size());
                if (a_number(number, false).empty()) text = fmt::format("{:.15g}", scale * store::number_of(number));
                break;
            }
            return a_number(text, false);
        },
        "", "quantity");
}
}  // namespace

const CLI::Validator positive([](const std::string& text) { return a_number(text, false); }, "", "positive");
const CLI::Validator counting([](const std::string& text) { return a_number(text, true); }, "", "counting");
const CLI::Validator hertz = in_units({{"kHz", 1e3}, {"Hz", 1}, {"k", 1e3}}), seconds = in_units({{"ms", 1e-3}, {"us", 1e-6}, {"s", 1}}),
                     metres = in_units({{"mm", 1e-3}, {"um", 1e-6}, {"m", 1}});

void add_common(CLI::App& verb, Common& c) {
    verb.add_flag("--json", c.json, "one JSON object on standard output, nothing else there");
    verb.add_option("--plugin", c.plugins, "shared object with further schemes (repeatable)")->type_name("LIB.so")->allow_extra_args(false);
    verb.add_option_function<std::vector<std::string>>(
            "--external",
            [&c](const std::vector<std::string>& commands) {
                for (const std::string& command : commands) c.plugins.push_back(judge::enter_external(command));
            },
            "any program as a scheme: it is called with the paths of the problem (JSON) and of the trace that it writes (repeatable)")
        ->type_name("COMMAND")
        ->allow_extra_args(false);
    verb.add_flag("--quiet", c.quiet, "errors only: no messages, no progress, no result as text (`list` still lists)");
}

void add_scene(CLI::App& verb, std::string& scene) {
    verb.add_option("scene", scene, "a scene file, or a name that `jvari list scenes` shows")->required()->type_name("SCENE");
}

void add_set(CLI::App& verb, std::vector<std::string>& set) {
    verb.add_option("--set", set, "overrides a key of the scene, as string.0.barrier.0.stiffness=1e9 (repeatable)")
        ->type_name("KEY.PATH=VALUE")
        ->allow_extra_args(false);
}

void add_modes(CLI::App& verb, int& modes) {
    verb.add_option("--modes", modes,
                    "modes of each string, or interior nodes for a scheme on a grid; absent: every mode below min(20 kHz, rate/2)")
        ->type_name("N")
        ->check(counting);
}

void add_options(CLI::App& verb, std::vector<std::string>& options) {
    verb.add_option(
            "--option", options,
            "an option of a scheme, as NAME=VALUE or SCHEME:NAME=VALUE (repeatable). In compare the short form goes to every compared "
            "scheme that knows the name, never to the reference; several values, as compliance=own,matched, are run one by one")
        ->type_name("[SCHEME:]NAME=VALUE")
        ->allow_extra_args(false);
}

void add_jobs(CLI::App& verb, int& jobs) {
    verb.add_option("--jobs", jobs, "accuracy runs side by side; as many as there are cores where absent. Timed runs go one at a time")
        ->type_name("N")
        ->check(counting);
}

void add_duration(CLI::App& verb, std::optional<double>& duration) {
    verb.add_option("--duration", duration, "in place of the scene's")->type_name("S")->transform(seconds);
}

void add_schemes(CLI::App& verb, std::vector<std::string>& schemes, const char* what) {
    verb.add_option("--schemes", schemes, what)->delimiter(',')->type_name("A,B,...");
}

void add_reference(CLI::App& verb, std::string& reference) {
    verb.add_option("--reference", reference, "a reference or a scheme; absent: the highest reference that represents the scene")
        ->type_name("NAME");
}

void add_comparison_folder(CLI::App& verb, std::string& out) {
    verb.add_option("--out", out, "folder for cells.csv, errors.csv, cost.csv, manifest.json, work_precision.svg, report.html")
        ->type_name("DIR");
}

void must_be_assignments(const std::vector<std::string>& set) {
    for (const std::string& s : set)
        if (s.find('=') == std::string::npos || s.front() == '=') throw store::UsageError("--set " + s + ": expected KEY.PATH=VALUE");
}
std::vector<compare::SchemeOption> scheme_options(const std::vector<std::string>& texts) {
    std::vector<compare::SchemeOption> options;
    for (const std::string& text : texts) {
        const auto equals = text.find('=');
        if (equals == std::string::npos || equals == 0) throw store::UsageError("--option " + text + ": expected [SCHEME:]NAME=VALUE");
        auto o = compare::SchemeOption::of(text.substr(0, equals), text.substr(equals + 1));
        if (o.name.empty() || text.front() == ':') throw store::UsageError("--option " + text + ": expected [SCHEME:]NAME=VALUE");
        options.push_back(std::move(o));
    }
    return options;
}

std::vector<compare::SchemeOption> listed_options(const std::vector<std::string>& texts) {
    const std::vector<compare::SchemeOption> lists = scheme_options(texts);
    std::vector<compare::SchemeOption> options;
    for (std::size_t k = 0; k < lists.size(); ++k) {
        const compare::SchemeOption& list = lists[k];
        for (std::size_t j = 0; j < k; ++j)
            if (lists[j].scheme == list.scheme && lists[j].name == list.name)
                throw store::UsageError(fmt::format("--option {}: found more than once; several values stand in one list, {}={},{}",
                                                    list.name, list.name, lists[j].value, list.value));
        std::istringstream values(list.value);
        for (std::string value; std::getline(values, value, ',');) options.push_back({list.scheme, list.name, value});
        if (list.value.empty()) options.push_back(list);
    }
    return options;
}

}  // namespace jvari::bench::command

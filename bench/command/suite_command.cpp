// jvari suite: runs a declared set of comparisons and spectrograms. DIR gets cells/, cells.csv,
// errors.csv, cost.csv, sounds/, manifest.json and the report.
#include <fmt/core.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/run.hpp"
#include "bench/suite/maps.hpp"
#include "bench/suite/suite.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct SuiteRequest : Running {
    std::string suite, out;
    bool resume = false;
    int jobs = 0;  // 0: one per core
};

std::string table_text(const study::Plan& plan, const study::Study& run,
                       const study::Cells& cells) {
    const std::size_t headline = compare::headline_error(cells, study::all_rows(cells));
    TextTable table{{{"scene", true},
                     {"scheme", true},
                     {"rate"},
                     {"modes", false, 2},
                     {"status", true, 1},
                     {study::measures()[headline].column.substr(6)},
                     {"s per s"},
                     {"", true, 3}},
                    {}};
    std::map<std::string, int> statuses;
    for (const study::TabledCell& c : cells) {
        ++statuses[c.status];
        std::string what = c.scene;
        for (const auto& [key, value] : c.swept) what += " " + key + "=" + value;
        table.rows.push_back(
            {' ',
             {what, c.variant(), store::text_of(c.rate), store::text_of(c.modes), c.status,
              compare::error_text(compare::bound_of(c, headline), "{:.2e}"),
              std::isnan(c.cost_s_per_s) ? "" : fmt::format("{:.3g}", c.cost_s_per_s), c.reason}});
    }
    std::string text = table.text(Console::width());
    text += fmt::format("{} cells, {} run, {} timed, {} read back:", plan.jobs.size(), run.ran,
                        run.timed, run.read_back);
    for (const auto& [status, count] : statuses) text += fmt::format(" {} {}", count, status);
    return text;
}

std::string kept_text(const study::Plan& plan, const study::Plan& maps, const fs::path& folder) {
    if (folder.empty()) return "interrupted: nothing is kept, for there is no --out DIR";
    return fmt::format("interrupted: {} are kept in {}; --resume goes on from there",
                       study::kept_of(plan, maps, folder), folder.string());
}

void note_missing_locks(const fs::path& folder, const Console& console) {
    const store::FileLock lock(folder / "cells" / "any", "begins", false);
    if (!lock.locked() && !lock.elsewhere())
        console.note(folder.string() +
                     ": no file can be locked here. Processes that share this folder would each "
                     "run every cell: start only one");
}

// Reports a population by its strings, not by its cells.
int end_population(const SuiteRequest& r, const suite::Suite& suite, const study::Plan& plan,
                   const study::Study& run, const Console& console) {
    const study::Cells cells = study::cells_of(plan, run.records);
    const suite::StringTables strings = suite::string_tables(suite, cells, run.records);
    report::ResultsFolder results(r.out, console);
    results.add_tables(cells);
    for (const auto& [name, table] : {std::pair{"strings.csv", &strings.strings},
                                      {"outcomes.csv", &strings.outcomes},
                                      {"advice.csv", &strings.advice},
                                      {"fronts.csv", &strings.fronts}})
        results.add(name, store::csv(*table));
    Json manifest = report::manifest_of(suite, plan);
    manifest.erase("scenes");  // scenes/ already contains them, frozen
    manifest["strings"] = suite.sets.size();
    results.add_manifest(manifest);
    results.add_report();
    console.print(suite.name + "\n" + strings.text);
    if (!r.out.empty()) console.print("written: " + r.out);
    const int code = code_of(run.records);
    console.print_json(with_results({{"suite", suite.name},
                                     {"status", exit_code::status(code)},
                                     {"ran", run.ran},
                                     {"timed", run.timed},
                                     {"read_back", run.read_back},
                                     {"strings", store::rows_json(strings.strings)},
                                     {"outcomes", store::rows_json(strings.outcomes)},
                                     {"advice", store::rows_json(strings.advice)}},
                                    {manifest, {}, {}, results.files}));
    return code;
}

int suite_command(const SuiteRequest& r) {
    const Console console(r.json, r.quiet);
    if (r.resume && r.out.empty())
        throw store::UsageError("--resume: there is no --out DIR to resume from");
    const suite::Suite suite = suite::read_suite(r.suite);
    const compare::Catalogue catalogue(r.plugins);
    compare::note_slow_plugins(console);
    const std::vector<suite::Advised> advised = suite::advice_of(suite, catalogue, console);
    study::Plan plan = suite::plan_of(suite.sets, catalogue, r.plugins, advised),
                points = suite::plan_of(suite.maps, catalogue, r.plugins);
    for (const std::string& note : plan.notes) console.note(note);
    const fs::path folder = r.out;
    const report::OwnFolder own(folder, "suite " + suite.name,
                                study::identity_of(plan) + study::identity_of(points), console);
    if (r.resume) note_missing_locks(folder, console);
    suite::freeze(suite, folder, r.resume);
    const store::WhenInterrupted last_word([&] { console.note(kept_text(plan, points, folder)); });
    if (r.resume)
        for (study::Plan* p : {&plan, &points})
            study::keep_references_in(*p, folder / "references");
    const suite::MapRun maps = suite::run_maps(own.cells, r.resume, suite.maps, points, catalogue,
                                               r.plugins, r.jobs, console);
    std::vector<suite::Failure> failures;
    if (!folder.empty())
        failures =
            suite::failures_of(own.cells, r.resume, maps, catalogue, r.plugins, r.jobs, console);
    const study::Study run = study::run(plan, own.cells, r.resume, r.jobs, console);
    if (suite.population) return end_population(r, suite, plan, run, console);
    const report::Written written =
        report::written(folder, suite, plan, run, maps, failures, console);
    const study::Cells& cells = written.cells;
    // Print after writing the files, so that nothing is lost if nobody reads the terminal.
    if (!suite.maps.empty()) console.print(suite.name + "\n" + suite::maps_text(maps));
    if (!plan.jobs.empty()) console.print(suite.name + "\n" + table_text(plan, run, cells));
    console.print(compare::cheapest_lines(written.cheapest, cells));
    if (!advised.empty()) console.print(suite::verdicts_on(advised, cells));
    for (const std::string& warning : compare::warnings_of(cells))
        console.print("warning: " + warning, store::Mark::doubtful);
    if (!r.out.empty()) console.print("written: " + folder.string());
    const int code = code_of(run.records);
    console.print_json(with_results({{"suite", suite.name},
                                     {"status", exit_code::status(code)},
                                     {"ran", run.ran},
                                     {"timed", run.timed},
                                     {"read_back", run.read_back}},
                                    written));
    return code;
}
}  // namespace

Act suite_verb(CLI::App& program) {
    Verb<SuiteRequest> v(
        program, "suite",
        "a declared set of comparisons, sweeps and stability maps over scenes and schemes");
    v.option("suite", v.r.suite, {"FILE"}, "a suite file, or a name that `jvari list suites` shows")
        ->required();
    v.option("--out", v.r.out, {"DIR"},
             "folder for cells/, a table of each kind that the suite measures, manifest.json, "
             "report.html and its pictures");
    v.flag("--resume", v.r.resume,
           "reads back the cells that DIR holds and runs the others; any number of processes may "
           "do so at once in one DIR");
    v.jobs(v.r.jobs);
    return v.does(suite_command, "Example: jvari suite paper-deshmukh --out sitar --resume");
}

}  // namespace jvari::bench::command

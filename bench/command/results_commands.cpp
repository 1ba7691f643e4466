#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/report/report.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"
#include "bench/store/records.hpp"
#include "bench/suite/difference.hpp"

namespace jvari::bench::command {

namespace {
namespace fs = std::filesystem;
}  // namespace

std::string with_results(nlohmann::ordered_json own, const report::Written& r) {
    own["manifest"] = r.manifest;
    own["cells"] = compare::json_of(r.cells);
    own["cheapest"] = store::rows_json(compare::table_of(r.cheapest, r.cells));
    own["files"] = r.files;
    return store::indented(own);
}

int code_of(const std::vector<study::Record>& records) {
    const auto is = [](const char* status) {
        return [status](const study::Record& r) { return r.cell.status() == status; };
    };
    if (records.empty() || std::ranges::any_of(records, is("ok"))) return exit_code::done;
    return std::ranges::all_of(records, is("refused")) ? exit_code::refused : exit_code::run_failed;
}

// ---- jvari report: makes the page and the pictures for a folder of results.

namespace {
using Json = nlohmann::ordered_json;

struct ReportRequest : Common {
    std::string folder, width;
    bool playground = false;
};

int report_command(ReportRequest r) {
    const Console console(r.json, r.quiet);
    const double width = r.width.empty() ? 0 : report::width_of(r.width);
    const std::string play = r.playground ? report::playground() : "";
    Json files = Json::array();
    for (const std::string& name : report::write_report(r.folder, console, width)) {
        files.push_back((fs::path(r.folder) / name).string());
        console.print("written: " + files.back().get<std::string>());
    }
    if (const fs::path page = fs::path(r.folder) / "report.html"; r.playground)
        store::write_fresh(page, report::with_playground(store::read_whole(page), play));
    console.print_json(store::indented({{"folder", r.folder}, {"files", files}}));
    return exit_code::done;
}
}  // namespace

Act report_verb(CLI::App& program) {
    Verb<ReportRequest> v(
        program, "report",
        "page and pictures, made again from a folder that compare or suite wrote");
    v.option("folder", v.r.folder, {"DIR"},
             "what compare, suite or trim wrote; results.json alone will do")
        ->required();
    v.option("--width", v.r.width, {"WIDTH"}, "of the pictures, as 85mm for a column of a paper");
    v.flag("--playground", v.r.playground,
           "puts the page that ./play builds into the report, opened on its scene: 1.4 MB more");
    return v.does(report_command, "Example: jvari report report");
}

// ---- jvari diff: lists the changes between two folders of results.

namespace {
struct DiffRequest : Common {
    std::string before, after;  // folders
};

int diff_command(const DiffRequest& r) {
    const Console console(r.json, r.quiet);
    const suite::Results before = suite::read_results(r.before),
                         after = suite::read_results(r.after);
    const suite::Difference d = suite::difference(before, after);
    console.print(suite::text_of(d, before, after));
    console.print_json(suite::json_of(d, before, after));
    return d.worse() ? exit_code::run_failed : exit_code::done;
}
}  // namespace

Act diff_verb(CLI::App& program) {
    Verb<DiffRequest> v(
        program, "diff",
        "two folders of results: what got worse, what got better, what only one has");
    v.option("before", v.r.before, {"A"}, "a folder that compare or suite wrote")->required();
    v.option("after", v.r.after, {"B"}, "another, of the same scene or suite")->required();
    return v.does(diff_command,
                  "Example: jvari diff results/smoke report\n"
                  "\n"
                  "Exit code 4 where something got worse: an error by more than noise and "
                  "certificates, a certificate, a status, an outcome of a map,\n"
                  "or the cost of a scheme beyond its quartiles and the drift of all; and where a "
                  "cell of A is missing in B. Costs of two machines\n"
                  "are not compared.");
}

}  // namespace jvari::bench::command

// jvari report: the page and the pictures of a folder of results.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/report/page.hpp"
#include "bench/report/report.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

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
    v.option("folder", v.r.folder, {"DIR"}, "holds manifest.json and cells.csv, maps.csv or both")
        ->required();
    v.option("--width", v.r.width, {"WIDTH"}, "of the pictures, as 85mm for a column of a paper");
    v.flag("--playground", v.r.playground,
           "puts the page that ./play builds into the report, opened on its scene: 1.4 MB more");
    return v.does(report_command, "Example: jvari report report");
}

}  // namespace jvari::bench::command

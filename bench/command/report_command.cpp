// jvari report: the page and the pictures of a folder of results.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/command/commands.hpp"
#include "bench/command/console.hpp"
#include "bench/report/figure_chart.hpp"
#include "bench/report/report.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/indented.hpp"

namespace jvari::bench::command {

namespace {
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;
}  // namespace

int report_command(const ReportRequest& r) {
    const Console console(r.json, r.quiet);
    Json files = Json::array();
    const auto tell = [&](const std::string& name) {
        files.push_back((fs::path(r.folder) / name).string());
        console.print("written: " + (fs::path(r.folder) / name).string());
    };
    for (const report::DrawnFigure& f : report::redraw_figures(r.folder, console)) {
        store::write_fresh(fs::path(r.folder) / f.file, f.svg);
        tell(f.file);
    }
    for (const std::string& name : report::write_report(r.folder, console)) tell(name);
    console.print_json(store::indented({{"folder", r.folder}, {"files", files}}));
    return exit_code::done;
}

}  // namespace jvari::bench::command

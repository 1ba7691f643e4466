#include "bench/map_command.hpp"

#include "bench/failures.hpp"
#include "bench/fresh_file.hpp"
#include "bench/suite_plan.hpp"

namespace jvari {

namespace fs = std::filesystem;

std::vector<std::string> chart_maps(const Suite& suite, const Catalogue& catalogue, const SuiteRequest& r, const Console& console) {
    if (suite.maps.empty()) return {};
    const fs::path folder = r.out;
    if (!r.out.empty())
        for (const char* name : {"points", "failures"}) {
            std::error_code error;
            fs::create_directories(folder / name, error);
            must_be_writable(folder / name / "any");
        }
    Truths truths(catalogue);
    const MapRun run = run_maps(suite.maps, truths, program_identity(r.plugins), r.out.empty() ? fs::path() : folder / "points", r.resume,
                                r.jobs, console);
    console.print(suite.name + "\n" + maps_text(run));
    std::vector<std::string> files;
    if (r.out.empty()) return files;
    const auto write = [&](const fs::path& name, const std::string& content) {
        write_fresh(folder / name, content);
        files.push_back((folder / name).string());
    };
    write("maps.csv", csv(maps_table(run)));
    const std::vector<Reproducer> failures = reproducers_of(run, truths, r.jobs, console);
    Reproducers files_of;
    for (const Reproducer& f : failures) files_of[{f.trial.scheme->name, f.expected.verdict}] = "failures/" + f.file;
    write_failures(folder / "failures", failures);
    write("boundaries.csv", csv(boundaries_table(run, files_of)));
    return files;
}

}  // namespace jvari

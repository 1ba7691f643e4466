#include "bench/map/map_report.hpp"

#include <fmt/core.h>

#include "bench/map/failures.hpp"
#include "bench/map/map_tables.hpp"
#include "bench/store/fresh_file.hpp"

namespace jvari::bench::map {

namespace fs = std::filesystem;

RecordedMaps run_and_record_maps(const std::vector<Map>& maps, const compare::Catalogue& catalogue, MapRequest r,
                                 const store::Listener& listener) {
    if (maps.empty()) return {};
    const fs::path folder = r.folder;
    const bool kept = !folder.empty();
    if (kept)
        for (const char* name : {"points", "failures"}) {
            std::error_code error;
            fs::create_directories(folder / name, error);
            store::must_be_writable(folder / name / "any");
        }
    if (kept) r.folder = folder / "points";
    Truths truths(catalogue, kept && r.resume ? folder / "references" : fs::path());
    const MapRun run = run_maps(maps, truths, r, listener);
    RecordedMaps recorded{{}, maps_text(run)};
    if (!kept) return recorded;
    const auto write = [&](const fs::path& name, const std::string& content) {
        store::write_fresh(folder / name, content);
        recorded.files.push_back((folder / name).string());
    };
    write("maps.csv", store::csv(maps_table(run)));
    const std::vector<Reproducer> failures = reproducers_of(run, catalogue, r, listener);
    Reproducers files_of;
    for (const Reproducer& f : failures) files_of[{f.trial.scheme->name, f.expected.verdict}] = "failures/" + f.file;
    write_failures(folder / "failures", failures);
    write("boundaries.csv", store::csv(boundaries_table(run, files_of)));
    return recorded;
}

}  // namespace jvari::bench::map

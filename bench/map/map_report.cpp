#include "bench/map/map_report.hpp"

#include <fmt/core.h>

#include "bench/map/failures.hpp"
#include "bench/map/map_tables.hpp"
#include "bench/store/fresh_file.hpp"

namespace jvari::bench::map {

namespace fs = std::filesystem;

RecordedMaps run_and_record_maps(const std::vector<Map>& maps, const compare::Catalogue& catalogue, const MapRequest& r,
                                 const store::Listener& listener) {
    if (maps.empty()) return {};
    const bool kept = !r.folder.empty();
    if (kept)
        for (const char* name : {"points", "failures"}) {
            std::error_code error;
            fs::create_directories(r.folder / name, error);
            store::must_be_writable(r.folder / name / "any");
        }
    Truths truths(catalogue);
    const MapRun run =
        run_maps(rows_of(maps, catalogue), truths, r.program, kept ? r.folder / "points" : fs::path(), r.points, r.jobs, listener);
    RecordedMaps recorded{{}, maps_text(run), {}};
    for (const PointPlace& p : run.missing)
        recorded.missing.push_back(fmt::format("{}: {} at {} = {}{}", p.map->name, p.scheme->name, p.map->x.key, p.x,
                                               p.y.empty() ? "" : ", " + p.map->y.key + " = " + p.y));
    if (!kept) return recorded;
    const auto write = [&](const fs::path& name, const std::string& content) {
        store::write_fresh(r.folder / name, content);
        recorded.files.push_back((r.folder / name).string());
    };
    write("maps.csv", store::csv(maps_table(run)));
    const std::vector<Reproducer> failures = reproducers_of(run, truths, r.jobs, listener);
    Reproducers files_of;
    for (const Reproducer& f : failures) files_of[{f.trial.scheme->name, f.expected.verdict}] = "failures/" + f.file;
    write_failures(r.folder / "failures", failures);
    write("boundaries.csv", store::csv(boundaries_table(run, files_of)));
    return recorded;
}

}  // namespace jvari::bench::map

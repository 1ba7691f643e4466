// Results of a suite: manifest, tables of cells and maps, failures, sounds and page.
#include <map>
#include <nlohmann/json.hpp>

#include "bench/compare/record/cheapest.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/report/results.hpp"
#include "bench/store/machine.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/run.hpp"
#include "scenes/scene_file.hpp"

namespace jvari::bench::report {

using Json = nlohmann::ordered_json;

Json manifest_of(const suite::Suite& suite, const study::Plan& plan) {
    std::map<std::string, std::string> sources;
    std::map<std::string, std::string> scenes;  // in a sweep the first scene
    for (const study::Job& c : plan.jobs) {
        sources[c.cell.scheme->name] = c.cell.scheme->source;
        if (!scenes.contains(c.point->scene.name))
            scenes[c.point->scene.name] = write_scene(c.point->scene);
    }
    Json manifest = store::made_by();
    manifest.update({{"suite", suite.name},
                     {"source", suite.source},
                     {"cells", plan.jobs.size()},
                     {"maps", suite.maps.size()},
                     {"schemes", sources},
                     {"scenes", scenes}});
    return manifest;
}

Written written(const std::filesystem::path& folder, const suite::Suite& suite,
                const study::Plan& plan, const study::Study& run, const suite::MapRun& maps,
                const std::vector<suite::Failure>& failures, const store::Listener& listener) {
    Written w{
        manifest_of(suite, plan), compare::with_front(study::cells_of(plan, run.records)), {}, {}};
    w.cheapest = compare::cheapest_of(w.cells);
    if (folder.empty()) return w;
    ResultsFolder results(folder, listener);
    if (!maps.points.empty()) {
        results.add("maps.csv", store::csv(suite::maps_table(maps)));
        results.add("boundaries.csv", store::csv(suite::boundaries_table(maps, failures)));
        suite::write_failures(folder / "failures", failures);
    }
    if (!plan.jobs.empty()) results.add_tables(w.cells);
    suite::write_sounds(folder, plan, run.records);
    results.add_manifest(w.manifest);
    if (!plan.jobs.empty() || !suite.maps.empty()) results.add_report();
    w.files = std::move(results.files);
    return w;
}

}  // namespace jvari::bench::report

#include "bench/suite/maps.hpp"

#include <fmt/core.h>

#include <cmath>
#include <map>

#include "bench/store/fresh_file.hpp"
#include "bench/study/judgement.hpp"

namespace jvari::bench::suite {

store::Table maps_table(const MapRun& run) {
    store::Table t;
    t.columns = {"map",
                 "scene",
                 "scheme",
                 "x_key",
                 "x",
                 "y_key",
                 "y",
                 "outcome",
                 "detail",
                 "reference",
                 "largest_over_bound",
                 "energy_gain",
                 "pull",
                 "error"};
    for (const JudgedPoint& p : run.points) {
        const study::Summary& s = p.tried.record.cell.summary;
        const bool ran = p.tried.record.cell.ran();
        const auto number = [ran](double x) { return store::text_of(ran ? x : store::nan); };
        t.rows.push_back({p.at.map->name, p.at.map->scene, p.at.scheme->name, p.at.map->x.key,
                          p.at.x, p.at.map->y.key, p.at.y, name_of(p.tried.judgement.verdict),
                          p.tried.judgement.detail, ran ? p.tried.record.against.reference : "",
                          number(s.largest_over_bound), number(s.energy_gain),
                          number(study::pull_of(s.smallest_contact_force, s.largest_contact_force)),
                          number(p.tried.error)});
    }
    return t;
}

store::Table boundaries_table(const MapRun& run, const Reproducers& reproducers) {
    store::Table t;
    t.columns = {"map",        "scheme",          "x_key",  "y_key",  "y",
                 "between",    "x_low",           "x_high", "theory", "relative_difference",
                 "reproducer", "theory_holds_for"};
    for (const Boundary& b : run.boundaries) {
        std::string file;
        for (const study::Verdict side : {b.low, b.high})
            if (const auto r =
                    b.map->reproduce ? reproducers.find({b.scheme->name, side}) : reproducers.end();
                r != reproducers.end())
                file = r->second;
        t.rows.push_back({b.map->name, b.scheme->name, b.map->x.key, b.map->y.key, b.y,
                          fmt::format("{}|{}", name_of(b.low), name_of(b.high)), b.x_low, b.x_high,
                          store::text_of(b.theory), store::text_of(b.relative_difference()), file,
                          std::isnan(b.theory) ? "" : motion_of(b.map->theory)});
    }
    return t;
}

std::string maps_text(const MapRun& run) {
    std::string text;
    for (std::size_t i = 0; i < run.points.size();) {
        const PointPlace& first = run.points[i].at;
        std::map<study::Verdict, int> count;
        for (; i < run.points.size() && run.points[i].at.map == first.map &&
               run.points[i].at.scheme == first.scheme;
             ++i)
            ++count[run.points[i].tried.judgement.verdict];
        text += fmt::format("  {:<28} {:<42}", first.map->name, first.scheme->name);
        for (const auto& [verdict, n] : count) text += fmt::format(" {} {}", name_of(verdict), n);
        text += "\n";
    }
    for (const Boundary& b : run.boundaries)
        if (!std::isnan(b.theory))
            text += fmt::format(
                "  {:<28} {:<42} {}|{} at {} = {:.5g}{}{}, theory {:.5g}: {:+.2g} %\n    theory "
                "holds for {}\n",
                b.map->name, b.scheme->name, name_of(b.low), name_of(b.high), b.map->x.key,
                0.5 * (store::number_of(b.x_low) + store::number_of(b.x_high)),
                b.y.empty() ? "" : ", " + b.map->y.key + " = ", b.y, b.theory,
                100 * b.relative_difference(), motion_of(b.map->theory));
    return text + fmt::format("{} points, {} boundaries: {} run, {} read back\n", run.points.size(),
                              run.boundaries.size(), run.ran, run.read_back);
}

RecordedMaps run_and_record_maps(const std::vector<Map>& maps, const compare::Catalogue& catalogue,
                                 const MapRequest& request, const store::Listener& listener) {
    if (maps.empty()) return {};
    const MapRun run = run_maps(maps, catalogue, request, listener);
    RecordedMaps recorded{{}, maps_text(run)};
    if (request.folder.empty()) return recorded;
    const auto write = [&](const std::string& name, const std::string& content) {
        store::write_fresh(request.folder / name, content);
        recorded.files.push_back((request.folder / name).string());
    };
    write("maps.csv", store::csv(maps_table(run)));
    const std::vector<Reproducer> failures = reproducers_of(run, catalogue, request, listener);
    Reproducers files_of;
    for (const Reproducer& f : failures)
        files_of[{f.trial.scheme->name, f.expected.verdict}] = "failures/" + f.file;
    write_failures(request.folder / "failures", failures);
    write("boundaries.csv", store::csv(boundaries_table(run, files_of)));
    return recorded;
}

}  // namespace jvari::bench::suite

// Functions of the module: run, run_many, compare, report, suite, trim. Each passes its arguments
// to the engine and returns the result.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "bench/compare/advice.hpp"
#include "bench/compare/bound.hpp"
#include "bench/compare/compare.hpp"
#include "bench/compare/record/findings.hpp"
#include "bench/compare/scene_notes.hpp"
#include "bench/judge/judge.hpp"
#include "bench/report/report.hpp"
#include "bench/report/results.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/study/cells.hpp"
#include "bench/study/run.hpp"
#include "bench/suite/maps.hpp"
#include "bench/suite/suite.hpp"
#include "bench/trim/trim.hpp"
#include "python/listening.hpp"
#include "python/values.hpp"
#include "schemes/registry.hpp"

namespace jvari::python {

using namespace bench;

// Plugin paths; accessed only with the interpreter's lock.
inline std::vector<std::string>& all_plugins() {
    static std::vector<std::string> paths;
    return paths;
}

inline std::vector<std::string> plugins() {  // plugins with schemes that can run here
    std::vector<std::string> here = all_plugins();
    if (in_a_scheme())
        std::erase_if(here, [](const std::string& p) { return p.starts_with("scheme "); });
    return here;
}

inline void add_plugin(const std::filesystem::path& path) {
    const std::string file = std::filesystem::absolute(path);
    std::vector<std::string> all = all_plugins();
    if (std::ranges::find(all, file) != all.end()) return;
    all.push_back(file);
    const compare::Catalogue loaded(all);
    all_plugins() = all;
    compare::note_slow_plugins(PythonListener());
}

inline std::vector<std::string> scheme_names() {
    std::vector<std::string> names;
    const compare::Catalogue catalogue(plugins());
    for (const auto* list : {&catalogue.schemes, &catalogue.references})
        for (const Descriptor* d : *list) names.emplace_back(d->name);
    return names;
}

struct Job {  // a run without its scene
    const Descriptor* scheme;
    Settings settings;
};
inline Job job_of(const std::string& scheme, double rate, std::optional<double> tap_rate, int modes,
                  const py::dict& options) {
    if (in_a_scheme() && find_guest("scheme " + scheme))
        throw store::UsageError("scheme " + scheme +
                                ": a scheme in Python cannot run one in Python");
    const Descriptor& d = compare::Catalogue(plugins()).find(scheme);
    return {&d, compare::settings_of_run(d, rate, tap_rate, at_least(0, modes, "modes"),
                                         options_of(options))};
}

// Chooses settings by compare::advise, with `within` or without a scheme.
inline std::shared_ptr<TakenRun> run_one(const py::object& of, const std::string& scheme,
                                         std::optional<double> rate, int modes,
                                         std::optional<double> duration,
                                         std::optional<double> tap_rate, bool energy,
                                         const py::dict& options, const std::string& within,
                                         const std::string& measure, const std::string& tap,
                                         std::optional<double> time_limit) {
    Scene scene = NamedScene::of(of).scene;
    if (duration) scene.duration = *duration;
    compare::note_scene(scene, PythonListener());
    std::string advice;
    Job job;
    const compare::AdviceRequest request{within, measure,  tap,
                                         scheme, tap_rate, options_of(options)};
    if (!compare::asks_for_advice(request, rate.has_value(), modes)) {
        job = job_of(scheme, rate.value_or(44100), tap_rate, modes, options);
    } else {
        const compare::Catalogue catalogue(plugins());
        const compare::Advice a = unlocked(
            [&] { return compare::advise(scene, request, catalogue, PythonListener()).back(); });
        if (!compare::is_to_run(a, within)) throw Refusal(compare::text_of(a));
        job = {a.scheme, a.settings};
        advice = store::indented(compare::json_of(a));
    }
    compare::note_modes(*job.scheme, scene, job.settings, PythonListener());
    return unlocked([&] {
        RunOptions o;
        o.energy = energy;
        o.progress = [](long, long) { look_for_signals(); };
        if (time_limit) o.progress = store::within(*time_limit, o.progress);
        const double start = store::processor_seconds();
        auto taken = std::make_shared<TakenRun>(run(*job.scheme, scene, job.settings, o), scene);
        taken->processor_seconds = store::processor_seconds() - start;
        taken->advice = advice;
        return taken;
    });
}

// Relative L2 uncertainty for each tap over the windows of Trust, None if unknown; and how it was
// determined.
inline std::string uncertainty_of(const study::Trust& t, const Scene& scene) {
    constexpr std::size_t certificate = std::string_view("certificate_").size();
    nlohmann::ordered_json j{{"against", t.against}, {"doubled", t.doubled}};
    for (std::size_t tap = 0; tap < scene.taps.size(); ++tap)
        for (std::size_t w = 0; w < study::Trust::columns.size(); ++w) {
            if (study::measures()[w].heard) continue;  // the trace has all modes
            const double known = t.of_scene(static_cast<int>(tap), w);
            auto& figure = j["taps"][scene.taps[tap].name][study::Trust::columns[w] + certificate];
            if (!std::isnan(known)) figure = known;
        }
    return store::indented(j);
}

// Returns the reference solution that compare uses for errors.
inline std::shared_ptr<TakenRun> reference_of(const py::object& of, const std::string& reference,
                                              int modes, std::optional<double> duration,
                                              std::optional<double> tap_rate,
                                              std::optional<double> time_limit, int jobs) {
    const NamedScene s = NamedScene::of(of);
    compare::CompareRequest r;
    r.scene = s.name, r.set = s.set, r.duration = duration, r.tap_rate = tap_rate;
    r.reference = reference;
    at_least(0, jobs, "jobs");
    const compare::Catalogue catalogue(plugins());
    study::Plan plan;
    study::Point& p = plan.points.emplace_back();
    p.scene = compare::load_scene(r);
    p.references = compare::references_of(r, catalogue, p.scene);
    p.truth_modes = at_least(0, modes, "modes");
    p.time_limit = time_limit.value_or(HUGE_VAL);
    study::address(plan, store::program_identity(plugins()));
    return unlocked([&] {
        study::References all;
        all.hold(p);
        const study::References::Of found = all.make(p, jobs, PythonListener());
        if (!found.truth) throw Refusal(found.refused);
        auto taken = std::make_shared<TakenRun>(found.truth->reference.run, p.scene);
        taken->uncertainty = uncertainty_of(found.against().trust, p.scene);
        return taken;
    });
}

inline Column run_many(const std::vector<py::object>& scenes, const std::string& scheme,
                       double rate, int modes, std::optional<double> duration,
                       std::optional<double> tap_rate, const py::dict& options, int jobs) {
    const Job job = job_of(scheme, rate, tap_rate, modes, options);
    at_least(0, jobs, "jobs");
    std::vector<Scene> all;
    for (const py::object& o : scenes) {
        all.push_back(NamedScene::of(o).scene);
        if (duration) all.back().duration = *duration;
        const auto same = [](const Tap& a, const Tap& b) {
            return a.name == b.name && a.quantity == b.quantity;
        };
        if (all.back().duration != all.front().duration ||
            !std::ranges::equal(all.back().taps, all.front().taps, same))
            throw store::UsageError("run_many: scene " + std::to_string(all.size() - 1) +
                                    " lasts another time or has taps of other names or quantities "
                                    "than the first; duration=... sets one time for all");
    }
    const long rows =
        all.empty() ? 0 : std::lround(all.front().duration * job.settings.tap_rate) + 1;
    const long taps = all.empty() ? 0 : static_cast<long>(all.front().taps.size());
    Column out({static_cast<py::ssize_t>(all.size()), static_cast<py::ssize_t>(rows),
                static_cast<py::ssize_t>(taps)});
    double* to = out.mutable_data();
    unlocked([&] {
        store::side_by_side(std::vector<double>(all.size(), 1), jobs, PythonListener(), "runs",
                            [&](std::size_t i, store::Done& done) {
                                RunOptions o;
                                o.progress = [&done](long n, long of) {
                                    done = static_cast<double>(n) / static_cast<double>(of);
                                };
                                const Run r = run(*job.scheme, all[i], job.settings, o);
                                double* own = to + static_cast<long>(i) * rows * taps;
                                std::fill_n(own, rows * taps,
                                            std::numeric_limits<double>::quiet_NaN());
                                for (int k = 0; k < r.trace.taps(); ++k) {
                                    const std::span<const double> values = r.trace.column(k);
                                    for (std::size_t n = 0; n < values.size(); ++n)
                                        own[static_cast<long>(n) * taps + k] = values[n];
                                }
                            });
    });
    return out;
}

// Rows returned by compare or judge are a list for `report` to draw: the list keeps its comparison.
struct Compared {
    compare::Comparison comparison;
    compare::CompareRequest request;
};
inline std::vector<std::string> written(const Compared& c) {
    return report::written(c.comparison, c.request, PythonListener()).files;
}
template <class Act>
py::object compared(const compare::CompareRequest& request, Act act) {
    const report::OwnFolder own(request.out, "comparison of " + compare::load_scene(request).name,
                                compare::identity_of(request), PythonListener());
    study::Kept keep;
    keep.folder = own.cells;
    std::unique_ptr<Compared> all;
    const std::string rows = unlocked(
        [&] {
            all = std::make_unique<Compared>(act(keep), request);
            if (!request.out.empty()) written(*all);
            return store::indented(compare::json_of(compare::cells_of(all->comparison)));
        },
        [&request] {
            return request.out.empty() ? "nothing is kept but long runs of references"
                                       : "errors of cells are kept in " + request.out;
        });
    py::object list = py::module_::import("jvari").attr("Rows")(parsed(rows));
    list.attr("_comparison") =
        py::capsule(all.release(), [](void* c) { delete static_cast<Compared*>(c); });
    return list;
}
inline std::vector<std::string> report_of(const py::object& of, const std::filesystem::path& out) {
    if (!py::hasattr(of, "_comparison")) {
        if (py::isinstance<py::list>(of) || !out.empty())
            throw store::UsageError(
                "report: expected the rows as compare or judge gave them and a "
                "folder, or a folder alone, which is drawn again");
        if (!is_path(of)) refuse("report", of, "rows as compare or judge gave them, or a folder");
        const std::string folder = path_text(of);
        return unlocked([&] { return report::write_report(folder, PythonListener()); });
    }
    Compared c = *of.attr("_comparison").cast<py::capsule>().get_pointer<Compared>();
    if (out.empty()) throw store::UsageError("report: expected the folder that is to be written");
    c.request.out = out.string();
    return unlocked([&] {
        const report::OwnFolder own(out, "comparison of " + c.comparison.scene().name,
                                    compare::identity_of(c.request), PythonListener());
        return written(c);
    });
}

inline py::object compare_rows(const py::object& scene, const std::vector<std::string>& schemes,
                               const std::vector<double>& rates,
                               const std::variant<int, std::vector<int>>& modes,
                               const std::string& reference, int reference_modes, bool controls,
                               std::optional<double> duration, std::optional<double> tap_rate,
                               const py::dict& options, int repeats,
                               const std::filesystem::path& out, int jobs, const py::dict& cost,
                               std::optional<double> time_limit) {
    const NamedScene s = NamedScene::of(scene);
    compare::CompareRequest r;
    r.out = out.string();
    r.time_limit = time_limit;
    r.scene = s.name;
    r.set = s.set;
    r.schemes = schemes;
    r.rates = rates;
    if (const int* n = std::get_if<int>(&modes))
        r.modes.assign(at_least(0, *n, "modes") > 0 ? 1 : 0, *n);
    else
        for (const int each : std::get<std::vector<int>>(modes))
            r.modes.push_back(at_least(1, each, "modes"));
    r.reference = reference;
    r.reference_modes = at_least(0, reference_modes, "reference_modes");
    r.controls = controls;
    r.duration = duration;
    r.tap_rate = tap_rate;
    r.options = options_of(options);
    r.repeats = at_least(1, repeats, "repeats");
    r.jobs = at_least(0, jobs, "jobs");
    const compare::Catalogue catalogue(plugins());
    std::map<std::string, judge::Costs> costs;
    for (const auto& [name, by_rate] : cost)
        for (const auto& [rate, seconds] : by_rate.cast<py::dict>())
            costs[name.cast<std::string>()][rate.cast<double>()] = seconds.cast<double>();
    for (const auto& [name, by_rate] : costs) judge::must_be_untimed(catalogue.find(name));
    return compared(r, [&](study::Kept& k) {
        compare::Comparison c = compare::compare(r, catalogue, PythonListener(), k);
        for (const auto& [name, by_rate] : costs) judge::report_costs(c, name, by_rate);
        return c;
    });
}

inline py::dict tables_of(const suite::Suite& suite, const std::filesystem::path& folder,
                          bool resume, int jobs) {
    const std::vector<std::string> files = plugins();
    const compare::Catalogue catalogue(files);
    const study::Plan plan = suite::plan_of(suite.sets, catalogue, files),
                      points = suite::plan_of(suite.maps, catalogue, files);
    for (const std::string& note : plan.notes) PythonListener().note(note);
    at_least(0, jobs, "jobs");
    const report::OwnFolder own(folder, "suite " + suite.name,
                                study::identity_of(plan) + study::identity_of(points),
                                PythonListener());
    std::string cells;
    std::vector<std::pair<std::string, store::Table>> tables;
    unlocked(
        [&] {
            const suite::MapRun maps = suite::run_maps(own.cells, resume, suite.maps, points,
                                                       catalogue, files, jobs, PythonListener());
            std::vector<suite::Failure> failures;
            if (!folder.empty())
                failures = suite::failures_of(own.cells, resume, maps, catalogue, files, jobs,
                                              PythonListener());
            const study::Study run = study::run(plan, own.cells, resume, jobs, PythonListener());
            cells = store::indented(compare::json_of(
                report::written(folder, suite, plan, run, maps, failures, PythonListener()).cells));
            tables.emplace_back("maps", suite::maps_table(maps));
            tables.emplace_back("boundaries", suite::boundaries_table(maps, failures));
        },
        [&] {
            return folder.empty() ? "nothing is kept, for there is no out"
                                  : study::kept_of(plan, points, folder) + " are kept in " +
                                        folder.string() + "; resume=True goes on from there";
        });
    py::dict rows;
    rows["cells"] = parsed(cells);
    for (const auto& [name, table] : tables) rows[py::str(name)] = rows_of(table);
    return rows;
}
inline py::dict suite_tables(const std::filesystem::path& file, const std::filesystem::path& out,
                             bool resume, int jobs) {
    return tables_of(suite::read_suite(file.string()), out, resume, jobs);
}
inline py::list suite_rows(const std::filesystem::path& file, const std::filesystem::path& out,
                           bool resume, int jobs) {
    suite::Suite suite = suite::read_suite(file.string());
    suite.maps.clear();
    return tables_of(suite, out, resume, jobs)["cells"];
}

struct TrimmedRows {
    bool found;
    py::object path, needs;
    std::string toml;
};
inline TrimmedRows trim_rows(const py::object& scene, const std::string& within,
                             const std::string& of, const std::string& tap,
                             const std::string& scheme, std::optional<double> duration,
                             double tap_rate, const std::string& reference, int reference_modes,
                             const std::filesystem::path& out, int jobs) {
    const NamedScene s = NamedScene::of(scene);
    const trim::Request r{s.name,
                          of,
                          within,
                          tap,
                          scheme,
                          reference,
                          out.string(),
                          s.set,
                          plugins(),
                          duration,
                          tap_rate,
                          at_least(0, reference_modes, "reference_modes"),
                          at_least(0, jobs, "jobs")};
    const report::OwnFolder own(out, "trim of " + s.scene.name, trim::identity_of(r),
                                PythonListener());
    const compare::Catalogue catalogue(plugins());
    store::Table path, needs;
    std::string toml;
    const bool found = unlocked(
        [&] {
            trim::Judge judge(r, catalogue, PythonListener());
            const trim::Trimmed t = trim::trimmed(judge, r, catalogue, PythonListener());
            path = trim::path_table(t, judge);
            needs = trim::needs_table(t);
            if (t.path.within_tolerance) toml = trim::trimmed_toml(t, judge);
            return t.path.within_tolerance;
        },
        [&] {
            return out.empty() ? "nothing is kept, for there is no out"
                               : "what was judged is kept in " + out.string() +
                                     "; the same call goes on from there";
        });
    return {found, rows_of(path), rows_of(needs), toml};
}

}  // namespace jvari::python

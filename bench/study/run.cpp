#include "bench/study/run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "bench/store/fresh_file.hpp"
#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/study/cause.hpp"
#include "bench/study/cost.hpp"
#include "scenes/excitation.hpp"

namespace jvari::bench::study {

namespace {
namespace fs = std::filesystem;

Record run_job(const Job& job, const References::Of& known, const ProgressOf& progress) {
    const Point& point = *job.point;
    Record r{job.cell, {}, {}, {}};
    Cell& cell = r.cell;
    const Trace* truth = known.truth ? &known.truth->reference.run.trace : nullptr;
    try {
        const bool heard = job.errors.empty() || std::ranges::any_of(job.errors, [](auto m) {
                               return measures()[m].heard;
                           });
        const Trace trace =
            run_cell(cell, point.scene, heard && truth,
                     store::within(std::min(point.time_limit, job.patience), progress));
        if (truth) {
            const auto errors_from = [&](const Trace& t) {
                return errors_of(trace, t, job.errors, free_from(point.true_scene()));
            };
            const Reference* own =
                known.model ? of_modes(cell, *known.model, *known.truth) : nullptr;
            cell.errors = errors_from(*truth);
            if (own)
                cell.in_model =
                    &own->run.trace == truth ? cell.errors : errors_from(own->run.trace);
        }
        if (job.sounds && truth && cell.reason.empty())
            cell.cause = cause_of(point.true_scene(), trace, *truth, headline_of(point.scene).nut,
                                  free_from(point.true_scene()));
        if (job.sounds && cell.reason.empty())
            cell.sound =
                store::sound_of(trace.column(headline_of(point.scene).nut), trace.tap_rate);
        if (job.measure) job.measure({point, cell, trace, truth}, r);
    } catch (const std::exception& e) {  // an exception from a scheme affects only its own row
        fail(cell, e);
    }
    if (job.beside) r.beside = job.beside(point, known.truth);
    if (!known.refused.empty()) cell.reason += (cell.reason.empty() ? "" : "; ") + known.refused;
    r.against = known.against();
    return r;
}

std::optional<Record> kept_record(const Job& job, const Kept& keep) {
    if (!keep.resume || keep.folder.empty()) return std::nullopt;
    return read_record(keep.folder / (job.id + ".json"), job.identity, job.cell);
}

// Orders the missing jobs so that few wait for a reference: each thread begins with another point.
// A process that shares the folder begins at a random point.
std::vector<std::size_t> spread(const Plan& plan, const std::vector<std::size_t>& missing,
                                std::size_t threads, bool shared) {
    std::map<const Point*, std::pair<std::size_t, std::size_t>> points;  // number, jobs so far
    std::vector<std::array<std::size_t, 4>> order;
    for (const std::size_t i : missing) {
        auto& [number, jobs] =
            points.try_emplace(plan.jobs[i].point, points.size(), 0).first->second;
        order.push_back({number, jobs++, number, i});
    }
    const std::size_t first = shared ? std::random_device()() % points.size() : 0;
    for (auto& [turn, job, number, i] : order)
        turn = (number + points.size() - first) % points.size() / threads;
    std::ranges::sort(order);
    std::vector<std::size_t> all;
    for (const auto& place : order) all.push_back(place.back());
    return all;
}

// Runs the jobs, or reads them back if another process has run them meanwhile.
void run_missing(const Plan& plan, const std::vector<std::size_t>& missing, References& references,
                 Kept& keep, int threads, const store::Listener& listener, Study& into) {
    std::vector<double> sizes;
    for (const std::size_t i : missing)
        sizes.push_back(std::max(plan.jobs[i].cell.settings.sample_rate, 44100.0) *
                        std::max(1, plan.jobs[i].cell.settings.modes) *
                        plan.jobs[i].point->scene.duration);
    store::side_by_side(
        sizes, threads, listener, "errors",
        [&](std::size_t k, store::Done& done) {
            const Job& job = plan.jobs[missing[k]];
            const auto progress = [&done](long rows, long of) {
                done = static_cast<double>(rows) / static_cast<double>(of);
            };
            std::optional<Record> record =
                record_of(job, references, keep, progress, done.may_wait());
            if (!record) return done.postpone();
            into.records[missing[k]] = std::move(*record);
            if (job.judged) references.release(*job.point);
        },
        [&](std::size_t k) { return what_of(plan.jobs[missing[k]]); });
}

// Times the jobs of one set in one interleaved run, so that disturbances affect them equally.
void time_set(const Plan& plan, const std::vector<std::size_t>& indices, const Kept& keep,
              Study& into, const store::Listener& listener) {
    std::vector<Contender> contenders;
    for (const std::size_t i : indices)
        contenders.push_back({&into.records[i].cell, &plan.jobs[i].point->scene});
    time_cells(contenders, plan.jobs[indices.front()].repeats, listener);
    for (const std::size_t i : indices) {
        const Job& job = plan.jobs[i];
        if (!keep.folder.empty())
            store::write_fresh(keep.folder / clock_file(job),
                               clock_json(into.records[i].cell.clock, job.identity));
        ++into.timed;
    }
}

// Times all sets, one process per folder at a time. No process runs jobs meanwhile, because each
// begins here only after all jobs are done. A folder has the costs of one machine.
void time_sets(const Plan& plan, const Kept& keep, Study& into, const store::Listener& listener) {
    std::vector<std::size_t> timed;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i)
        if (plan.jobs[i].repeats > 0 && !*plan.jobs[i].cell.scheme->untimed &&
            into.records[i].cell.ran())
            timed.push_back(i);
    if (timed.empty()) return;
    const auto lock = store::lock_of(keep.folder.empty() ? keep.folder : keep.folder / "clock",
                                     "times the cells of this folder", listener);
    std::map<int, std::vector<std::size_t>> sets;  // jobs without a cost
    const std::string here = store::stamp_now().name;
    std::string elsewhere;
    for (const std::size_t i : timed) {
        const Job& job = plan.jobs[i];
        const bool read = keep.resume && !keep.folder.empty();
        const std::optional<Timing> known =
            read ? read_clock(keep.folder / clock_file(job), job.identity) : std::nullopt;
        if (known) into.records[i].cell.clock = *known;
        else sets[job.set].push_back(i);
        if (known && known->stamp.name != here) elsewhere = known->stamp.name;
    }
    if (sets.empty()) return;
    if (!elsewhere.empty()) {
        const std::string folder = keep.folder.string();
        listener.note(
            fmt::format("the costs in {} come from another machine, {}; cells without a cost are "
                        "not timed here. Remove {}/*.clock "
                        "to time all of them on this machine",
                        folder, elsewhere, folder));
        return;
    }
    for (const auto& [number, set] : sets) time_set(plan, set, keep, into, listener);
}
}  // namespace

std::optional<Record> record_of(const Job& job, References& references, Kept& keep,
                                const ProgressOf& progress, bool wait) {
    std::optional<Record> record = kept_record(job, keep);
    if (!record) {
        References::Of known;  // Before the lock, because the holder of the lock must not wait.
        if (job.judged) known = references.make(*job.point, 1, store::Listener());
        const fs::path file = keep.folder.empty() ? fs::path() : keep.folder / (job.id + ".json");
        const store::FileLock lock(file, "runs " + what_of(job), wait);
        if (lock.elsewhere()) return {};
        record = kept_record(job, keep);
        if (!record) {
            record = run_job(job, known, progress);
            ++keep.ran;
            const bool given_up =
                record->cell.failure == "past_time_limit" && job.patience < job.point->time_limit;
            const bool worth = record->cell.summary.processor_seconds >= keep.least;
            if (!file.empty() && worth && !given_up)
                store::write_fresh(file, json_of(*record, job.identity));
        }
    }
    ++keep.kept;
    return record;
}

Study run(const Plan& plan, References& references, Kept& keep, int threads,
          const store::Listener& listener) {
    Study result;
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
        const Job& job = plan.jobs[i];
        std::optional<Record> kept = kept_record(job, keep);
        if (!kept) missing.push_back(i);
        else if (job.judged) references.release(*job.point);
        result.records.push_back(kept ? std::move(*kept) : Record{job.cell, {}, {}, {}});
    }
    keep.of = static_cast<int>(plan.jobs.size());
    keep.kept = keep.of - static_cast<int>(missing.size());
    if (!missing.empty()) {
        const auto at_once = static_cast<std::size_t>(store::threads_of(threads));
        const bool shared = keep.resume && !keep.folder.empty();
        run_missing(plan, spread(plan, missing, at_once, shared), references, keep, threads,
                    listener, result);
    }
    result.ran = keep.ran;
    result.read_back = keep.of - result.ran;
    time_sets(plan, keep, result, listener);
    return result;
}

Study run(const Plan& plan, const fs::path& folder, bool resume, int threads,
          const store::Listener& listener) {
    References references(plan.jobs);
    Kept keep{folder, resume};
    return run(plan, references, keep, threads, listener);
}

std::string kept_of(const Plan& cells, const Plan& points, const fs::path& folder) {
    std::error_code error;
    std::vector<std::string> kept;
    for (const auto& [plan, what] :
         {std::pair{&cells, "cells"}, std::pair{&points, "points of maps"}})
        if (!plan->jobs.empty())
            kept.push_back(fmt::format(
                "{} of {} {}",
                std::ranges::count_if(plan->jobs,
                                      [&](const Job& c) {
                                          return fs::exists(folder / "cells" / (c.id + ".json"),
                                                            error);
                                      }),
                plan->jobs.size(), what));
    const auto runs = std::count_if(
        fs::directory_iterator(folder / "references", error), fs::directory_iterator(),
        [](const fs::directory_entry& e) { return e.path().extension() == ".run"; });
    if (runs > 0) kept.push_back(fmt::format("{} runs of references", runs));
    std::string text = kept.empty() ? "0 cells" : kept.front();
    for (std::size_t i = 1; i < kept.size(); ++i)
        text += (i + 1 < kept.size() ? ", " : " and ") + kept[i];
    return text;
}

void keep_references_in(Plan& plan, const fs::path& folder) {
    for (Point& p : plan.points)
        for (ReferenceChoice& c : p.references) c.kept_in = folder;
}

}  // namespace jvari::bench::study

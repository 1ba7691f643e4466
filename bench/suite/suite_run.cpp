#include "bench/suite/suite_run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "bench/compare/cost.hpp"
#include "bench/compare/time_limit.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/side_by_side.hpp"
#include "bench/suite/row_facet.hpp"

namespace jvari::bench::suite {

namespace {
struct Truth {  // the run of a reference, made by the first cell that needs it, gone with the last
    std::once_flag once;
    std::unique_ptr<compare::Reference> reference;
    compare::Errors floor;
    std::string refused;
    std::atomic<int> needed_by = 0;

    void make(const PlannedPoint& p, double time_limit) {
        std::call_once(once, [&] {
            try {
                reference = std::make_unique<compare::Reference>(
                    compare::run_reference(p.references, p.scene, 1, store::Console(false, true), time_limit));
                floor = compare::errors_of(reference->moved.trace, reference->run.trace);
            } catch (const std::exception& e) {
                refused = e.what();
            }
        });
    }
};

class Accuracy {  // the cells to run
public:
    Accuracy(const SuitePlan& plan, std::vector<std::size_t> missing, std::filesystem::path folder, SuiteRun& into)
        : plan_(plan), todo_(std::move(missing)), folder_(std::move(folder)), into_(into) {
        for (const std::size_t i : todo_)
            if (plan_.cells[i].set->measures(Facet::errors)) {
                auto& truth = truths_[plan_.cells[i].point->reference_key];
                if (!truth) truth = std::make_unique<Truth>();
                ++truth->needed_by;
            }
    }

    void run(int jobs, const store::Console& console) {
        std::vector<double> sizes;
        for (const std::size_t i : todo_)
            sizes.push_back(std::max(plan_.cells[i].cell.settings.sample_rate, 44100.0) * plan_.cells[i].point->scene.duration);
        store::side_by_side(sizes, jobs, console, "cells", [this](std::size_t k, store::Done& done) {
            const PlannedCell& planned = plan_.cells[todo_[k]];
            SuiteRecord& record = into_.records[todo_[k]];
            record = cell(planned, done);
            if (!folder_.empty()) store::write_fresh(folder_ / (planned.id + ".json"), json_of(record, planned.identity));
        });
    }

private:
    SuiteRecord cell(const PlannedCell& planned, store::Done& fraction) {
        const double limit = planned.set->time_limit.value_or(HUGE_VAL);
        Truth* truth = nullptr;
        if (planned.set->measures(Facet::errors)) {
            truth = truths_.at(planned.point->reference_key).get();
            truth->make(*planned.point, limit);
        }
        const bool known = truth && truth->reference;
        compare::Cell cell = planned.cell;
        Trace trace;
        std::string status;
        const auto told = [&fraction](long done, long rows) {
            fraction.store(static_cast<double>(done) / static_cast<double>(rows), std::memory_order_relaxed);
        };
        try {
            trace =
                compare::measure(cell, planned.point->scene, known ? &truth->reference->run.trace : nullptr, compare::within(limit, told));
        } catch (const Refusal& e) {
            status = "refused";
            cell.reason = e.what();
        } catch (const compare::PastItsLimit& e) {
            status = "past_time_limit";
            cell.reason = e.what();
        } catch (const std::exception& e) {
            status = "error";
            cell.reason = e.what();
        }
        cell.refused = !status.empty();
        if (truth && !known) cell.reason += (cell.reason.empty() ? "" : "; ") + truth->refused;
        SuiteRecord record =
            record_of(planned, cell, known ? truth->floor : compare::Errors{}, known ? truth->reference->trust : trust::Trust{});
        if (!status.empty()) record.row.rows[0][record.row.column("status")] = status;
        if (known) record.reference = truth->reference->choice.name();
        if (planned.set->measures(Facet::spectrogram) && !cell.refused)
            record.levels = levels_of(trace.column(planned.point->tap), trace.tap_rate);
        for (const RowFacet& f : row_facets())
            if (planned.set->measures(f.facet) && !cell.refused)
                record.rows[f.facet] = f.rows({planned.point->scene, *cell.scheme, cell.settings, trace,
                                               known ? &truth->reference->run.trace : nullptr, planned.point->tap, *planned.set});
        if (truth && --truth->needed_by == 0) truth->reference.reset();
        return record;
    }

    const SuitePlan& plan_;
    const std::vector<std::size_t> todo_;
    const std::filesystem::path folder_;
    SuiteRun& into_;
    std::map<std::string, std::unique_ptr<Truth>> truths_;
};

// Cells of one set meet each other in one interleaved run, so that what the machine does meanwhile meets them alike.
void time_missing(const SuitePlan& plan, const std::filesystem::path& folder, SuiteRun& into, const store::Console& console) {
    for (store::Rows indices : sets_of(plan)) {
        const CellSet& set = *plan.cells[indices.front()].set;
        std::erase_if(indices, [&into](std::size_t i) { return !into.records[i].ran || into.records[i].timed; });
        if (!set.measures(Facet::cost) || indices.empty()) continue;
        std::vector<compare::Cell> cells;
        for (const std::size_t i : indices) {
            cells.push_back(plan.cells[i].cell);
            cells.back().summary.wall_seconds = into.records[i].seconds;
        }
        std::vector<compare::Contender> contenders;
        for (std::size_t k = 0; k < indices.size(); ++k) {
            const PlannedPoint& p = *plan.cells[indices[k]].point;
            contenders.push_back({&cells[k], &p.scene, p.element == compare::Element::probe});
        }
        compare::time_cells(contenders, set.repeats, console);
        for (std::size_t k = 0; k < indices.size(); ++k) {
            const PlannedCell& planned = plan.cells[indices[k]];
            SuiteRecord& record = into.records[indices[k]];
            add_clock(record, planned, cells[k]);
            if (!folder.empty()) store::write_fresh(folder / (planned.id + ".json"), json_of(record, planned.identity));
            ++into.timed;
        }
    }
}
}  // namespace

SuiteRun run_suite(const SuitePlan& plan, const std::filesystem::path& folder, bool resume, int jobs, const store::Console& console) {
    SuiteRun result;
    result.records.resize(plan.cells.size());
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < plan.cells.size(); ++i) {
        std::optional<SuiteRecord> kept;
        if (resume && !folder.empty()) kept = read_record(folder / (plan.cells[i].id + ".json"), plan.cells[i].identity);
        if (kept) result.records[i] = std::move(*kept);
        else missing.push_back(i);
    }
    result.ran = static_cast<int>(missing.size());
    result.read_back = static_cast<int>(plan.cells.size() - missing.size());
    if (!missing.empty()) Accuracy(plan, std::move(missing), folder, result).run(jobs, console);
    time_missing(plan, folder, result, console);
    return result;
}

}  // namespace jvari::bench::suite

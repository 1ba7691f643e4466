#include "bench/suite/suite_run.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "bench/compare/cost.hpp"
#include "bench/compare/time_limit.hpp"
#include "bench/compare/truth.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/side_by_side.hpp"
#include "bench/suite/row_facet.hpp"

namespace jvari::bench::suite {

namespace {
struct Known {  // the run of a reference, made by the first cell that needs it, gone with the last
    std::once_flag once;
    std::unique_ptr<compare::Truth> truth;
    compare::Errors floor;
    std::string refused;
    std::atomic<int> needed_by = 0;

    template <class Make>
    void make(Make run) {
        std::call_once(once, [&] {
            try {
                truth = std::make_unique<compare::Truth>(run());
                floor = compare::errors_of(truth->reference.moved.trace, truth->reference.run.trace);
            } catch (const std::exception& e) {
                refused = e.what();
            }
        });
    }
    const compare::Reference* reference() const { return truth ? &truth->reference : nullptr; }
    const Trace* trace() const { return truth ? &truth->reference.run.trace : nullptr; }
    void release() {
        if (--needed_by == 0) truth.reset();
    }
};

class Accuracy {  // the cells to run
public:
    Accuracy(const SuitePlan& plan, std::vector<std::size_t> missing, std::filesystem::path folder, SuiteRun& into)
        : plan_(plan), todo_(std::move(missing)), folder_(std::move(folder)), into_(into) {
        for (const std::size_t i : todo_)
            if (plan_.cells[i].set->measures(Facet::errors)) {
                for (const std::string& key : {plan_.cells[i].point->reference_key, plan_.cells[i].point->truth_key}) {
                    if (key.empty()) continue;
                    auto& known = known_[key];
                    if (!known) known = std::make_unique<Known>();
                    ++known->needed_by;
                }
            }
    }

    void run(int jobs, const store::Listener& listener) {
        std::vector<double> sizes;
        for (const std::size_t i : todo_)
            sizes.push_back(std::max(plan_.cells[i].cell.settings.sample_rate, 44100.0) * plan_.cells[i].point->scene.duration);
        store::side_by_side(sizes, jobs, listener, "cells", [this](std::size_t k, store::Done& done) {
            const PlannedCell& planned = plan_.cells[todo_[k]];
            SuiteRecord& record = into_.records[todo_[k]];
            record = cell(planned, done);
            if (!folder_.empty()) store::write_fresh(folder_ / (planned.id + ".json"), json_of(record, planned.identity));
        });
    }

private:
    SuiteRecord cell(const PlannedCell& planned, store::Done& fraction) {
        const double limit = planned.set->time_limit.value_or(HUGE_VAL);
        const PlannedPoint& point = *planned.point;
        const store::Listener silent;
        Known *model = nullptr, *truth = nullptr;
        if (planned.set->measures(Facet::errors)) {
            model = truth = known_.at(point.reference_key).get();
            model->make([&] { return compare::Truth{compare::run_reference(point.references, point.scene, 1, silent, limit), {}}; });
        }
        if (truth && !point.truth_key.empty()) {
            truth = known_.at(point.truth_key).get();
            truth->make([&] { return compare::run_truth(point.references, point.scene, point.truth_modes, 1, silent, limit); });
        }
        const bool known = truth && truth->reference();
        compare::Cell cell = planned.cell;
        Trace trace;
        std::string status;
        const auto told = [&fraction](long done, long rows) {
            fraction.store(static_cast<double>(done) / static_cast<double>(rows), std::memory_order_relaxed);
        };
        try {
            trace = compare::run_cell(cell, point.scene, compare::within(limit, told));
            if (known) compare::judge(cell, trace, *truth->trace(), *model->trace());
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
        Against against;
        if (known) {
            const compare::Reference& r = *truth->reference();
            against = {truth->floor, r.trust, model->truth ? model->reference()->trust : trust::Trust{}, r.choice.settings.modes,
                       truth->truth->said};
        }
        SuiteRecord record = record_of(planned, cell, against);
        if (!status.empty()) record.row.rows[0][record.row.column("status")] = status;
        if (known) record.reference = truth->reference()->choice.name();
        if (planned.set->measures(Facet::spectrogram) && !cell.refused)
            record.levels = levels_of(trace.column(planned.point->tap), trace.tap_rate);
        for (const RowFacet& f : row_facets())
            if (planned.set->measures(f.facet) && !cell.refused)
                record.rows[f.facet] = f.rows({planned.point->scene, *cell.scheme, cell.settings, trace, known ? truth->trace() : nullptr,
                                               planned.point->tap, *planned.set});
        if (truth && truth != model) truth->release();
        if (model) model->release();
        return record;
    }

    const SuitePlan& plan_;
    const std::vector<std::size_t> todo_;
    const std::filesystem::path folder_;
    SuiteRun& into_;
    std::map<std::string, std::unique_ptr<Known>> known_;
};

// Cells of one set meet each other in one interleaved run, so that what the machine does meanwhile meets them alike.
void time_missing(const SuitePlan& plan, const std::filesystem::path& folder, SuiteRun& into, const store::Listener& listener) {
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
        compare::time_cells(contenders, set.repeats, listener);
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

SuiteRun run_suite(const SuitePlan& plan, const std::filesystem::path& folder, bool resume, int jobs, const store::Listener& listener) {
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
    if (!missing.empty()) Accuracy(plan, std::move(missing), folder, result).run(jobs, listener);
    time_missing(plan, folder, result, listener);
    return result;
}

}  // namespace jvari::bench::suite

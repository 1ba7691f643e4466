#include "bench/suite/suite_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "bench/compare/cost.hpp"
#include "bench/compare/time_limit.hpp"
#include "bench/compare/truth.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/suite/facet.hpp"

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
            if (plan_.cells[i].set->measures(measured::errors)) {
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
        store::side_by_side(
            sizes, jobs, listener, "cells",
            [this](std::size_t k, store::Done& done) {
                const PlannedCell& planned = plan_.cells[todo_[k]];
                SuiteRecord& record = into_.records[todo_[k]];
                record = cell(planned, done);
                if (!folder_.empty()) store::write_fresh(folder_ / (planned.id + ".json"), json_of(record, planned.identity));
            },
            [this](std::size_t k) { return what_of(plan_.cells[todo_[k]]); });
    }

private:
    SuiteRecord cell(const PlannedCell& planned, store::Done& fraction) {
        const double limit = planned.set->time_limit.value_or(HUGE_VAL);
        const PlannedPoint& point = *planned.point;
        const store::PartOf part(fraction);
        Known *model = nullptr, *truth = nullptr;
        if (planned.set->measures(measured::errors)) {
            model = truth = known_.at(point.reference_key).get();
            model->make([&] { return compare::Truth{compare::run_reference(point.references, point.scene, 1, part, limit), {}}; });
        }
        if (truth && !point.truth_key.empty()) {
            truth = known_.at(point.truth_key).get();
            truth->make([&] { return compare::run_truth(point.references, point.scene, point.truth_modes, 1, part, limit); });
        }
        const bool known = truth && truth->reference();
        compare::Cell cell = planned.cell;
        Trace trace;
        std::string status;
        const auto told = [&fraction](long done, long rows) { fraction = static_cast<double>(done) / static_cast<double>(rows); };
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
        if (planned.set->measures(measured::spectrogram) && !cell.refused)
            record.levels = levels_of(trace.column(planned.point->tap), trace.tap_rate);
        for (const Facet& f : facets())
            if (planned.set->measures(f.name) && f.rows && !cell.refused)
                record.rows[f.name] = f.rows({planned.point->scene, *cell.scheme, cell.settings, trace, known ? truth->trace() : nullptr,
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

// How long a run of the cell takes here, and whether it runs at all: that of its accuracy, or one more.
bool runs(const PlannedCell& planned, compare::Cell& cell, const SuiteRecord& record) {
    if (record.known()) {
        cell.summary.wall_seconds = record.seconds;
        return record.ran;
    }
    try {
        compare::run_cell(cell, planned.point->scene, compare::within(planned.set->time_limit.value_or(HUGE_VAL), [](long, long) {}));
        return true;
    } catch (const std::exception&) {  // the accuracy run says why
        return false;
    }
}

// Cells of one set meet each other in one interleaved run, so that what the machine does meanwhile meets them alike. Where one of them has
// no clock of the machine that timed the others, all are timed here.
std::vector<Clocks> time_set(const SuitePlan& plan, const store::Rows& indices, const std::filesystem::path& folder, bool resume,
                             SuiteRun& into, const store::Listener& listener) {
    std::vector<Clocks> clocks(indices.size());
    if (resume && !folder.empty()) clocks = clocks_in(folder, plan, indices);
    if (machine_of(clocks).all) return clocks;
    const std::string here = store::stamp_now().name;
    std::vector<std::size_t> todo;  // of indices
    std::vector<compare::Cell> cells;
    for (std::size_t k = 0; k < indices.size(); ++k) {
        if (clocks[k].contains(here)) continue;
        compare::Cell cell = plan.cells[indices[k]].cell;
        cell.refused = !runs(plan.cells[indices[k]], cell, into.records[indices[k]]);
        todo.push_back(k);
        cells.push_back(std::move(cell));
    }
    std::vector<compare::Contender> contenders;
    for (std::size_t t = 0; t < todo.size(); ++t) {
        const PlannedPoint& p = *plan.cells[indices[todo[t]]].point;
        contenders.push_back({&cells[t], &p.scene, p.element && compare::is_added(*p.element) ? p.element : std::nullopt});
    }
    compare::time_cells(contenders, plan.cells[indices.front()].set->repeats, listener);
    for (std::size_t t = 0; t < todo.size(); ++t) {
        const compare::Cell& c = cells[t];
        const PlannedCell& planned = plan.cells[indices[todo[t]]];
        const KeptClock clock{!c.refused, c.refused ? spread_of({}) : c.wall, c.refused ? spread_of({}) : c.processor, c.worst_block,
                              c.refused ? store::stamp_now() : c.stamp};
        if (!folder.empty()) store::write_fresh(folder / clock_file(planned, clock.stamp), clock_json(clock, planned.identity));
        clocks[todo[t]].insert_or_assign(clock.stamp.name, clock);
        into.timed += clock.ran;
    }
    return clocks;
}

// Into the rows of those cells: the costs of one machine, of others where that has none.
void show_clocks(const SuitePlan& plan, const store::Rows& indices, const std::vector<Clocks>& clocks, SuiteRun& into) {
    const std::string machine = machine_of(clocks).machine;
    for (std::size_t k = 0; k < indices.size(); ++k) {
        SuiteRecord& record = into.records[indices[k]];
        if (clocks[k].empty() || !record.known() || !record.ran) continue;
        const auto own = clocks[k].find(machine);
        const KeptClock& clock = own == clocks[k].end() ? clocks[k].begin()->second : own->second;
        if (clock.ran) add_clock(record, plan.cells[indices[k]], clock);
    }
}

store::Rows ran_of(const store::Rows& indices, const SuiteRun& run) {  // those that can be timed, as far as is known
    store::Rows rows;
    for (const std::size_t i : indices)
        if (!run.records[i].known() || run.records[i].ran) rows.push_back(i);
    return rows;
}
}  // namespace

SuiteWork all_of(const SuitePlan& plan) {
    SuiteWork work;
    for (std::size_t i = 0; i < plan.cells.size(); ++i) work.cells.push_back(i);
    for (const store::Rows& set : sets_of(plan))
        if (plan.cells[set.front()].set->measures(measured::cost)) work.clocks.push_back(set);
    return work;
}

SuiteRun run_suite(const SuitePlan& plan, const SuiteWork& work, const std::filesystem::path& folder, bool resume, int jobs,
                   const store::Listener& listener) {
    SuiteRun result;
    result.records.resize(plan.cells.size());
    std::vector<std::size_t> missing;
    for (const std::size_t i : work.cells) {
        std::optional<SuiteRecord> kept;
        if (resume && !folder.empty()) kept = read_record(folder / (plan.cells[i].id + ".json"), plan.cells[i].identity);
        if (kept) result.records[i] = std::move(*kept);
        else missing.push_back(i);
    }
    result.ran = static_cast<int>(missing.size());
    result.read_back = static_cast<int>(work.cells.size() - missing.size());
    if (!missing.empty()) Accuracy(plan, std::move(missing), folder, result).run(jobs, listener);
    for (const store::Rows& set : work.clocks)
        if (const store::Rows rows = ran_of(set, result); !rows.empty())
            show_clocks(plan, rows, time_set(plan, rows, folder, resume, result, listener), result);
    return result;
}

SuiteRun run_suite(const SuitePlan& plan, const std::filesystem::path& folder, bool resume, int jobs, const store::Listener& listener) {
    return run_suite(plan, all_of(plan), folder, resume, jobs, listener);
}

SuiteRun gather_suite(SuitePlan& plan, const std::filesystem::path& folder) {
    SuiteRun result;
    std::vector<PlannedCell> there;
    for (PlannedCell& cell : plan.cells)
        if (auto kept = read_record(folder / (cell.id + ".json"), cell.identity)) {
            there.push_back(std::move(cell));
            result.records.push_back(std::move(*kept));
        } else {
            result.missing.push_back(what_of(cell));
        }
    plan.cells = std::move(there);
    result.read_back = static_cast<int>(plan.cells.size());
    for (const store::Rows& set : all_of(plan).clocks) {
        const store::Rows rows = ran_of(set, result);
        const std::vector<Clocks> clocks = clocks_in(folder, plan, rows);
        show_clocks(plan, rows, clocks, result);
        for (std::size_t k = 0; k < rows.size(); ++k)
            if (clocks[k].empty()) result.missing.push_back("the clock of " + what_of(plan.cells[rows[k]]));
    }
    return result;
}

std::string kept_of(const SuitePlan& plan, const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    const auto files = [&](const char* in, const char* extension) {
        return std::count_if(fs::directory_iterator(folder / in, error), fs::directory_iterator(),
                             [extension](const fs::directory_entry& e) { return e.path().extension() == extension; });
    };
    std::vector<std::string> kept;
    if (!plan.cells.empty()) {
        const auto lies = [&](const PlannedCell& c) { return fs::exists(folder / "cells" / (c.id + ".json"), error); };
        kept.push_back(fmt::format("{} of {} cells", std::count_if(plan.cells.begin(), plan.cells.end(), lies), plan.cells.size()));
    }
    if (const auto n = files("points", ".json"); n > 0 || plan.cells.empty()) kept.push_back(fmt::format("{} points of maps", n));
    if (const auto n = files("references", ".run"); n > 0) kept.push_back(fmt::format("{} runs of references", n));
    std::string text = kept.front();
    for (std::size_t i = 1; i < kept.size(); ++i) text += (i + 1 < kept.size() ? ", " : " and ") + kept[i];
    return text;
}

void keep_references_in(SuitePlan& plan, const std::filesystem::path& folder) {
    for (PlannedPoint& p : plan.points)
        for (compare::ReferenceChoice& c : p.references) c.kept_in = folder;
}

int make_references(const SuitePlan& plan, int jobs, const store::Listener& listener) {
    std::map<std::string, std::function<void(const store::Listener&)>> all;  // by their keys
    for (const PlannedCell& c : plan.cells) {
        if (!c.set->measures(measured::errors) || !c.point->references.front().kept) continue;
        const PlannedPoint& p = *c.point;
        const double limit = c.set->time_limit.value_or(HUGE_VAL);
        all[p.reference_key] = [&p, limit](const store::Listener& part) { compare::run_reference(p.references, p.scene, 1, part, limit); };
        if (!p.truth_key.empty())
            all[p.truth_key] = [&p, limit](const store::Listener& part) {
                compare::run_truth(p.references, p.scene, p.truth_modes, 1, part, limit);
            };
    }
    std::vector<std::function<void(const store::Listener&)>> makes;
    for (auto& [key, make] : all) makes.push_back(std::move(make));
    store::side_by_side(std::vector<double>(makes.size(), 1), jobs, listener, "references", [&makes](std::size_t i, store::Done& done) {
        try {
            makes[i](store::PartOf(done));
        } catch (const std::exception&) {  // the rows of its cells say why
        }
    });
    return static_cast<int>(makes.size());
}

}  // namespace jvari::bench::suite

#include "bench/suite/suite_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "bench/compare/cost.hpp"
#include "bench/compare/truth.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/system/side_by_side.hpp"
#include "bench/store/system/time_limit.hpp"
#include "bench/suite/facet.hpp"

namespace jvari::bench::suite {

namespace {
// The run of a reference, made by the first cell that needs it, gone with the last. Whoever meets it while another thread or process makes
// it throws Busy, and its cell is run later.
class Known {
public:
    template <class Make>
    void make(Make run) {
        if (made_) return;
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock) throw store::Busy{"another thread, which runs a reference"};
        if (made_) return;
        try {
            truth_ = std::make_unique<compare::Truth>(run());
            floor_ = compare::errors_of(reference()->moved.trace, reference()->run.trace);
        } catch (const store::Busy& busy) {
            busy_ = busy;
            again_ = Clock::now() + std::chrono::milliseconds(500);
            throw;
        } catch (const std::exception& e) {
            refused_ = e.what();
        }
        made_ = true;
    }
    // Throws Busy where it was a moment ago: then its cell need not be taken. That spares a network file system thousands of locks.
    void look() {
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (lock && Clock::now() < again_) throw store::Busy(busy_);
    }
    const compare::Truth* truth() const { return truth_.get(); }
    const compare::Reference* reference() const { return truth_ ? &truth_->reference : nullptr; }
    const Trace* trace() const { return truth_ ? &truth_->reference.run.trace : nullptr; }
    const compare::Errors& floor() const { return floor_; }
    const std::string& refused() const { return refused_; }
    void is_needed() { ++needed_by_; }
    void release() {
        if (--needed_by_ == 0) truth_.reset();
    }

private:
    using Clock = std::chrono::steady_clock;
    std::mutex mutex_;  // of what follows, until it is made
    std::unique_ptr<compare::Truth> truth_;
    compare::Errors floor_;
    std::string refused_;
    store::Busy busy_;
    Clock::time_point again_{};
    std::atomic<bool> made_ = false;
    std::atomic<int> needed_by_ = 0;
};

class Accuracy {  // the cells to run
public:
    Accuracy(const SuitePlan& plan, std::vector<std::size_t> missing, std::filesystem::path folder, bool resume, SuiteRun& into)
        : plan_(plan), todo_(std::move(missing)), folder_(std::move(folder)), resume_(resume), into_(into) {
        for (const std::size_t i : todo_)
            for (const std::string& key : references_of(plan_.cells[i])) {
                auto& known = known_[key];
                if (!known) known = std::make_unique<Known>();
                known->is_needed();
            }
    }

    void run(int jobs, const store::Listener& listener) {
        std::vector<double> sizes;
        for (const std::size_t i : todo_)
            sizes.push_back(std::max(plan_.cells[i].cell.settings.sample_rate, 44100.0) * plan_.cells[i].point->scene.duration);
        store::side_by_side(
            sizes, jobs, listener, "cells",
            [this](std::size_t k, store::Done& done) { into_.records[todo_[k]] = one(plan_.cells[todo_[k]], done); },
            [this](std::size_t k) { return what_of(plan_.cells[todo_[k]]); });
        into_.ran = ran_;
        into_.read_back += static_cast<int>(todo_.size()) - ran_;
    }

private:
    static std::vector<std::string> references_of(const PlannedCell& c) {
        std::vector<std::string> keys;
        if (c.set->measures(measured::errors)) keys.push_back(c.point->reference_key);
        if (!keys.empty() && !c.point->truth_key.empty()) keys.push_back(c.point->truth_key);
        return keys;
    }

    // Run here, or read back where another process has run it meanwhile.
    SuiteRecord one(const PlannedCell& planned, store::Done& done) {
        const std::vector<std::string> references = references_of(planned);
        for (const std::string& key : references) known_.at(key)->look();
        const std::filesystem::path file = folder_.empty() ? folder_ : folder_ / (planned.id + ".json");
        const store::FileLock lock(file, "runs " + what_of(planned));
        std::optional<SuiteRecord> record;
        if (resume_ && !folder_.empty()) record = read_record(file, planned.identity);
        if (!record) {
            record = cell(planned, done);
            if (!folder_.empty()) store::write_fresh(file, json_of(*record, planned.identity));
            ++ran_;
        }
        for (const std::string& key : references) known_.at(key)->release();
        return std::move(*record);
    }

    SuiteRecord cell(const PlannedCell& planned, store::Done& fraction) {
        const double limit = planned.set->time_limit.value_or(HUGE_VAL);
        const PlannedPoint& point = *planned.point;
        const store::PartOf part(fraction);
        Known *model = nullptr, *truth = nullptr;
        if (planned.set->measures(measured::errors)) {
            model = truth = known_.at(point.reference_key).get();
            model->make([&] { return compare::Truth{compare::run_reference(point.references, point.scene, 1, part, limit), {}, {}}; });
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
            trace = compare::run_cell(cell, point.scene, store::within(limit, told));
            if (known) {
                const compare::Reference* own = model->truth() ? compare::of_modes(cell, *model->reference(), *truth->truth()) : nullptr;
                compare::judge(cell, trace, *truth->trace(), own ? &own->run.trace : nullptr);
            }
        } catch (const Refusal& e) {
            status = "refused";
            cell.reason = e.what();
        } catch (const store::PastItsLimit& e) {
            status = "past_time_limit";
            cell.reason = e.what();
        } catch (const std::exception& e) {
            status = "error";
            cell.reason = e.what();
        }
        cell.refused = !status.empty();
        if (truth && !known) cell.reason += (cell.reason.empty() ? "" : "; ") + truth->refused();
        Against against;
        if (known) {
            const compare::Reference& r = *truth->reference();
            against = {truth->floor(), r.trust, model->truth() ? model->reference()->trust : trust::Trust{}, r.choice.settings.modes,
                       truth->truth()->said};
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
        return record;
    }

    const SuitePlan& plan_;
    const std::vector<std::size_t> todo_;
    const std::filesystem::path folder_;
    const bool resume_;
    SuiteRun& into_;
    std::map<std::string, std::unique_ptr<Known>> known_;
    std::atomic<int> ran_ = 0;
};

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
        cell.refused = !into.records[indices[k]].ran;
        cell.summary.wall_seconds = into.records[indices[k]].seconds;
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
        if (clocks[k].empty() || !record.ran) continue;
        const auto own = clocks[k].find(machine);
        const KeptClock& clock = own == clocks[k].end() ? clocks[k].begin()->second : own->second;
        if (clock.ran) add_clock(record, plan.cells[indices[k]], clock);
    }
}

// One process of the folder times while no other does. None of them runs cells then: each begins here once all are there.
void time_sets(const SuitePlan& plan, const std::filesystem::path& folder, bool resume, SuiteRun& into, const store::Listener& listener) {
    std::vector<store::Rows> sets = sets_of(plan);
    for (store::Rows& set : sets)
        std::erase_if(set, [&](std::size_t i) { return !plan.cells[i].set->measures(measured::cost) || !into.records[i].ran; });
    std::erase_if(sets, [](const store::Rows& set) { return set.empty(); });
    if (sets.empty()) return;
    const auto lock = store::lock_once_free(folder.empty() ? folder : folder / "clock", "times the cells of this folder", listener);
    for (const store::Rows& set : sets) show_clocks(plan, set, time_set(plan, set, folder, resume, into, listener), into);
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
    result.read_back = static_cast<int>(plan.cells.size() - missing.size());
    if (!missing.empty()) Accuracy(plan, std::move(missing), folder, resume, result).run(jobs, listener);
    time_sets(plan, folder, resume, result, listener);
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

}  // namespace jvari::bench::suite

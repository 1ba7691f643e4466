#include "bench/study/cell.hpp"

#include <fmt/core.h>

#include "bench/store/system/time_limit.hpp"
#include "schemes/run.hpp"

namespace jvari::bench::study {

std::string Cell::status() const {
    return !ran() ? failure : !needed ? "not_needed" : name_of(summary.status.outcome);
}

Trace run_cell(Cell& cell, const Scene& scene, const ProgressOf& progress) {
    RunOptions options;
    options.energy = true;
    options.progress = progress;
    const auto scheme = make_scheme(*cell.scheme, scene, cell.settings);
    const double from = store::processor_seconds();
    Run result = run(*scheme, scene, cell.settings, options);
    const double took = store::processor_seconds() - from;
    cell.summary = summary_of(*cell.scheme, scene, cell.settings, result);
    cell.summary.processor_seconds = took;
    if (result.status.outcome != Outcome::ok)
        cell.reason =
            fmt::format("{} at step {}, after {:.6g} s", name_of(result.status.outcome), result.status.step, cell.summary.duration);
    return std::move(result.trace);
}

void fail(Cell& cell, const std::exception& e) {
    cell.failure = dynamic_cast<const Refusal*>(&e)               ? "refused"
                   : dynamic_cast<const store::PastItsLimit*>(&e) ? "past_time_limit"
                                                                  : "error";
    cell.reason = e.what();
}

}  // namespace jvari::bench::study

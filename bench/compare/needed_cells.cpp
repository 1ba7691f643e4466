#include "bench/compare/needed_cells.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/compare/bound.hpp"
#include "bench/store/records.hpp"
#include "bench/study/judgement.hpp"

namespace jvari::bench::compare {

namespace {
constexpr double as_good = 0.9;  // of two errors
constexpr double less_work =
    // beyond what schemes differ by in the time for a step and a number of their state: four over a
    // lumped contact
    32;

double work_of(const study::Cell& c) {
    return static_cast<double>(c.summary.steps) * c.summary.dofs;
}

bool surely_less(const study::Cell& a, const study::Cell& b) {
    if (b.added && a.scheme == b.scheme && a.settings.options == b.settings.options)
        return a.modes() <= b.modes() && a.settings.sample_rate <= b.settings.sample_rate &&
               work_of(a) < work_of(b);
    return work_of(a) > 0 && less_work * work_of(a) <= work_of(b);
}

bool usable(const study::Cell& c, double error) {
    return c.ran() && c.reason.empty() && study::flags_of(c.summary).empty() &&
           std::isfinite(error);
}

bool does_as_well(double a, double b, double certificate) {
    const auto keeps = [certificate](double error, double most) {
        return error + certificate <= most;
    };
    if (keeps(a, *std::min_element(std::begin(accuracies), std::end(accuracies)))) return true;
    return as_good * a <= b &&
           std::all_of(std::begin(accuracies), std::end(accuracies),
                       [&](double most) { return keeps(a, most) || !keeps(b, most); });
}
}  // namespace

void mark_needed(std::vector<study::Cell>& cells, const std::vector<double>& errors,
                 double certificate) {
    const double certain = std::isnan(certificate) ? 0 : certificate;
    std::vector<std::size_t> order(cells.size()), kept;
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return work_of(cells[a]) < work_of(cells[b]);
    });
    for (const std::size_t i : order) {
        const auto instead = [&](std::size_t k) {
            return surely_less(cells[k], cells[i]) && does_as_well(errors[k], errors[i], certain);
        };
        const bool failed = !cells[i].ran() || !cells[i].reason.empty(),
                   good = usable(cells[i], errors[i]);
        // a failure at the modes that it takes unasked is a finding
        const bool may_go = cells[i].searched && !failed;
        const auto found = may_go ? std::find_if(kept.begin(), kept.end(), instead) : kept.end();
        if (!good && cells[i].added) {
            cells[i].needed = false;
            if (!failed)
                cells[i].reason =
                    "not to be trusted: " + names_of(study::flags_of(cells[i].summary));
        } else if (found != kept.end()) {
            const study::Cell& other = cells[*found];
            cells[i].needed = false;
            cells[i].reason =
                fmt::format("{}, {} modes at {:.4g} kHz does as well for less",
                            store::variant_name(other.scheme->name,
                                                store::options_text(other.settings.options)),
                            other.modes(), other.settings.sample_rate / 1000);
        } else if (good) {
            kept.push_back(i);
        }
    }
}

}  // namespace jvari::bench::compare

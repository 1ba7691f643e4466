// The energy ledger: stored[n] - stored[n-1] = supplied[n] - dissipated[n], in every row and in sum.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/check/judges.hpp"

namespace jvari::bench::check {

namespace {
struct Ledger {
    std::vector<double> residual, stored, dissipated;
    double scale = 1e-30;  // [J]
};
Ledger ledger_of(const Case& c) {
    const Trace t = fresh(c, {.energy = true}).trace;
    if (t.rows < 1) throw std::runtime_error("no row to keep a ledger of");
    Ledger l;
    const auto stored = t.energy_column(0), supplied = t.energy_column(1), dissipated = t.energy_column(2);
    for (long n = 0; n < t.rows; ++n) {
        l.scale = std::max(l.scale, stored[n]);
        l.residual.push_back(n == 0 ? supplied[0] + dissipated[0] : stored[n] - stored[n - 1] - supplied[n] + dissipated[n]);
    }
    l.stored.assign(stored.begin(), stored.begin() + t.rows);
    l.dissipated.assign(dissipated.begin(), dissipated.begin() + t.rows);
    return l;
}

constexpr const char* promises_none = "it promises no balance";

double row_bound(const Case& c) {
    return c.scheme.balance == Balance::exact ? 1e-11 : 1e-8;
}

Verdict within(double worst, double bound, const char* of) {
    return worst <= bound ? kept(fmt::format("{:.1e}", worst))
                          : broken(fmt::format("{} {:.2g} of the largest stored energy, at most {:.0e} is owed", of, worst, bound));
}
}  // namespace

Verdict keeps_its_ledger_in_every_row(const Case& c) {
    if (c.scheme.balance == Balance::none) return not_asked(promises_none);
    const Ledger l = ledger_of(c);
    double worst = 0;
    for (const double r : l.residual) worst = std::max(worst, std::abs(r));
    return within(worst / l.scale, row_bound(c), "a row is out by");
}

Verdict keeps_its_ledger_in_sum(const Case& c) {
    if (c.scheme.balance == Balance::none) return not_asked(promises_none);
    const Ledger l = ledger_of(c);
    double sum = 0, worst = 0;
    for (const double r : l.residual) worst = std::max(worst, std::abs(sum += r));
    return within(worst / l.scale, 10 * row_bound(c), "rows together are out by");
}

Verdict stores_no_negative_energy(const Case& c) {
    if (c.scheme.balance == Balance::none) return not_asked(promises_none);
    const Ledger l = ledger_of(c);
    const double bound = row_bound(c) * l.scale, least = *std::min_element(l.stored.begin(), l.stored.end());
    if (!(least >= -bound)) return broken(fmt::format("stores {:.2g} J", least));
    if (needed_by(c.scene).has(Feature::profile_barrier) && c.scheme.balance == Balance::to_tolerance)
        return kept("a rigid-profile rule may give energy; its scheme reports how much");
    const double loss = *std::min_element(l.dissipated.begin(), l.dissipated.end());
    return loss >= -bound ? kept() : broken(fmt::format("dissipates {:.2g} J in a row", loss));
}

}  // namespace jvari::bench::check

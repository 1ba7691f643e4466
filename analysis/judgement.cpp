// Source: judgement.hpp.
#include "analysis/judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "analysis/energy.hpp"
#include "scenes/excitation.hpp"

namespace jvari {

namespace {
constexpr std::array verdict_names = {"sound",    "unjudged",       "flagged",       "inaccurate",
                                      "adhesive", "energy_gaining", "not_converged", "diverged",
                                      "refused",  "error"};

double over_bound(const Scene& scene, const Trace& trace, int modes) {
    double most = nan;
    const std::vector<double> bounds = tap_bounds(scene, modes);
    for (int k = 0; k < trace.taps(); ++k) {
        if (std::isinf(bounds[k])) continue;
        most = std::fmax(most, 0);
        for (const double x : trace.column(k))
            most = std::max(most, std::isfinite(x) ? std::abs(x) / bounds[k] : HUGE_VAL);
    }
    return most;
}
}  // namespace

Figures figures_of(Balance promised, const Scene& scene, int modes, const Run& run) {
    const EnergyBalance balance = energy_balance(run.trace);
    const EnergyGain gain = energy_gain(run.trace);
    // A scheme without a promised balance may leave its columns empty: a balance of zeros "closes"
    // without any meaning.
    const bool silent = promised == Balance::none && !(balance.largest_stored > 0);
    Figures f{run.status,
              silent ? nan : balance.step,
              silent ? nan : balance.accumulated,
              fact_of(run.facts, facts::smallest_contact_force),
              fact_of(run.facts, facts::largest_contact_force),
              fact_of(run.facts, facts::deepest_penetration),
              gain.largest,
              over_bound(scene, run.trace, modes),
              run.facts};
    std::erase_if(f.facts, [](const Fact& fact) {
        return fact.name == facts::smallest_contact_force.name ||
               fact.name == facts::largest_contact_force.name ||
               fact.name == facts::deepest_penetration.name;
    });
    return f;
}

double pull_of(double least, double largest) {
    if (least >= -pull_floor) return 0;
    // fmax returns the other operand if `largest` is NaN
    return -least / std::fmax(largest, std::numeric_limits<double>::min());
}

Flags raised_by(const Figures& f) {
    return {pull_of(f.smallest_contact_force, f.largest_contact_force) > pull_allowed,
            fact_of(f.facts, facts::psi_out_of_contact) > psi_allowed,
            f.energy_residual_accumulated > energy_allowed,
            fact_of(f.facts, facts::modes_above_nyquist) > 0};
}

const char* name_of(Verdict v) { return verdict_names[static_cast<std::size_t>(v)]; }

Verdict verdict_named(const std::string& name) {
    const auto found = std::find(verdict_names.begin(), verdict_names.end(), name);
    if (found == verdict_names.end()) throw std::runtime_error("unknown outcome " + name);
    return static_cast<Verdict>(found - verdict_names.begin());
}

bool is_stable(Verdict v) { return v == Verdict::sound || v == Verdict::flagged; }
bool is_trusted(Verdict v) { return v == Verdict::sound || v == Verdict::unjudged; }

Verdict verdict_of(const Figures& f, Balance promised, double error) {
    const double pull = pull_of(f.smallest_contact_force, f.largest_contact_force);
    if (f.status.outcome == Outcome::diverged) return Verdict::diverged;
    if (f.status.outcome != Outcome::ok) return Verdict::not_converged;
    if (f.energy_gain > (promised == Balance::exact ? energy_allowed : gain_allowed_unpromised))
        return Verdict::energy_gaining;
    if (pull > pull_allowed) return Verdict::adhesive;
    if (error > error_allowed) return Verdict::inaccurate;
    if (raised_by(f).any()) return Verdict::flagged;
    const bool judged = !std::isnan(f.largest_over_bound) || !std::isnan(f.energy_gain) ||
                        !std::isnan(pull) || !std::isnan(error);
    return judged ? Verdict::sound : Verdict::unjudged;
}

}  // namespace jvari

#include "bench/study/judgement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/energy.hpp"

namespace jvari::bench::study {

namespace {
constexpr std::array outcome_names = {"sound",          "unjudged",      "flagged",  "inaccurate", "adhesive",
                                      "energy_gaining", "not_converged", "diverged", "refused"};
}  // namespace

double pull_of(double least, double largest) {
    if (least >= -pull_floor) return 0;
    return -least / std::fmax(largest, std::numeric_limits<double>::min());  // of an unknown one and 0 the other
}

std::vector<Flag> flags_of(const Summary& s) {
    std::vector<Flag> flags;
    if (pull_of(s.smallest_contact_force, s.largest_contact_force) > pull_allowed)
        flags.push_back(
            {"adhesion",
             fmt::format("the contact pulls with {:.2g} N{}: only a contact with loss may pull", -s.smallest_contact_force,
                         s.largest_contact_force > 0 ? fmt::format(", and pushes with {:.2g} N at most", s.largest_contact_force) : "")});
    if (const double stuck = fact(s.facts, facts::psi_out_of_contact); stuck > psi_allowed)
        flags.push_back(
            {facts::psi_gap.name,
             fmt::format("the quadratised contact stores energy while the string is clear of it: psi is {:.2g} of its largest value",
                         stuck)});
    if (s.energy_residual_accumulated > energy_allowed)
        flags.push_back(
            {"energy", fmt::format("the energy ledger is open by {:.2g} of the largest stored energy", s.energy_residual_accumulated)});
    if (const double aliased = fact(s.facts, facts::modes_above_nyquist); aliased > 0)
        flags.push_back(
            {facts::modes_above_nyquist.name, fmt::format("{:.0f} modes lie at or above half the sample rate and alias", aliased)});
    return flags;
}

std::string names_of(const std::vector<Flag>& flags) {
    std::string names;
    for (const Flag& f : flags) names += (names.empty() ? "" : " ") + f.name;
    return names;
}

const char* name_of(Verdict v) {
    return outcome_names[static_cast<std::size_t>(v)];
}

Verdict verdict_named(const std::string& name) {
    const auto found = std::ranges::find(outcome_names, name);
    if (found == outcome_names.end()) throw std::runtime_error("unknown outcome " + name);
    return static_cast<Verdict>(found - outcome_names.begin());
}

bool is_stable(Verdict v) {
    return v == Verdict::sound || v == Verdict::flagged;
}

Judgement judge(const Cell& cell, double error) {
    if (!cell.ran()) return {Verdict::refused, cell.reason, 0};
    const Summary& s = cell.summary;
    const bool promised = cell.scheme->balance == Balance::exact;
    const double pull = pull_of(s.smallest_contact_force, s.largest_contact_force);
    if (s.status.outcome == Outcome::diverged) return {Verdict::diverged, fmt::format("at step {}", s.status.step), s.status.step};
    if (s.largest_displacement > std::sqrt(energy_budget))
        return {Verdict::diverged, fmt::format("displacement {:.3g} times what its energy allows", s.largest_displacement), 0};
    if (s.status.outcome != Outcome::ok) return {Verdict::not_converged, fmt::format("at step {}", s.status.step), s.status.step};
    if (s.energy_gain > (promised ? energy_allowed : gain_allowed_unpromised))
        return {Verdict::energy_gaining, fmt::format("{:.3g} of its energy gained", s.energy_gain), 0};
    if (pull > pull_allowed) return {Verdict::adhesive, fmt::format("pulls by {:.3g} of the largest contact force", pull), 0};
    if (error > error_allowed) return {Verdict::inaccurate, fmt::format("error {:.3g}", error), 0};
    if (const std::vector<Flag> flags = flags_of(s); !flags.empty()) return {Verdict::flagged, flags.front().sentence, 0};
    if (std::isnan(s.largest_displacement) && std::isnan(s.energy_gain) && std::isnan(pull) && std::isnan(error))
        return {Verdict::unjudged, "no energy, no smallest contact force and no reference to judge it by", 0};
    return {Verdict::sound, std::isnan(error) ? "" : fmt::format("error {:.3g}", error), 0};
}

}  // namespace jvari::bench::study

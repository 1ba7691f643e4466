#include "bench/study/judgement.hpp"

#include <fmt/core.h>
#include <cmath>

namespace jvari::bench::study {

std::vector<Flag> flags_of(const Summary& s) {
    const Flags raised = raised_by(s);
    std::vector<Flag> flags;
    if (raised.adhesion)
        flags.push_back(
            {"adhesion",
             fmt::format(
                 "the contact pulls with {:.2g} N{}: only a contact with loss may pull",
                 -s.smallest_contact_force,
                 s.largest_contact_force > 0
                     ? fmt::format(", and pushes with {:.2g} N at most", s.largest_contact_force)
                     : "")});
    if (raised.psi_gap)
        flags.push_back({facts::psi_gap.name,
                         fmt::format("the quadratised contact stores energy while the string is "
                                     "clear of it: psi is {:.2g} of its largest value",
                                     fact_of(s.facts, facts::psi_out_of_contact))});
    if (raised.energy)
        flags.push_back(
            {"energy",
             fmt::format("the energy ledger is open by {:.2g} of the largest stored energy",
                         s.energy_residual_accumulated)});
    if (raised.modes_above_nyquist)
        flags.push_back({facts::modes_above_nyquist.name,
                         fmt::format("{:.0f} modes lie at or above half the sample rate and alias",
                                     fact_of(s.facts, facts::modes_above_nyquist))});
    return flags;
}

std::string names_of(const std::vector<Flag>& flags) {
    std::string names;
    for (const Flag& f : flags) names += (names.empty() ? "" : " ") + f.name;
    return names;
}

Judgement judge(const Cell& cell, double error) {
    if (!cell.ran())
        return {cell.failure == "refused" ? Verdict::refused : Verdict::error, cell.reason, 0};
    const Summary& s = cell.summary;
    const Verdict v = verdict_of(s, cell.scheme->balance, error);
    switch (v) {
        case Verdict::diverged:
        case Verdict::not_converged:
            return {v, fmt::format("at step {}", s.status.step), s.status.step};
        case Verdict::energy_gaining:
            return {v, fmt::format("{:.3g} of its energy gained", s.energy_gain), 0};
        case Verdict::adhesive:
            return {v,
                    fmt::format("pulls by {:.3g} of the largest contact force",
                                pull_of(s.smallest_contact_force, s.largest_contact_force)),
                    0};
        case Verdict::flagged: return {v, flags_of(s).front().sentence, 0};
        case Verdict::unjudged:
            return {v, "no energy, no smallest contact force and no reference to judge it by", 0};
        // sound, inaccurate
        default: return {v, std::isnan(error) ? "" : fmt::format("error {:.3g}", error), 0};
    }
}

}  // namespace jvari::bench::study

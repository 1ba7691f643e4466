// What became of a cell, from its own figures and its error: the one place where the outcomes of stability maps are defined.
//
// In order of gravity; the gravest that applies is the outcome. Each threshold with its reason:
//   refused         the scheme does not represent the scene, or not at these settings
//   diverged        the run's own status; or a displacement that more than ten times the energy that was ever there could not make:
//                   |y| <= sqrt(E L/(2 T)) on a string under tension T, E = stored at the start and supplied since (a scheme beyond its
//                   limit can keep an indefinite energy constant to rounding while the string flies off)
//   not_converged   the run's own status: the contact equation was left unsolved
//   energy_gaining  stored energy above the ledger (in which a negative loss counts as none: obstacles add no energy) by more than
//                   energy_allowed of E where the scheme promises a balance to rounding, 1e-2 where it promises none: there the true energy
//                   is no invariant, and wavers by O((omega dt)^2) in stable runs
//   adhesive        the contact pulls by more than pull_allowed of its largest push (summary.hpp)
//   inaccurate      relative L2 error of the nut force over the run above 10 %: the headline signal of compare, and the threshold of its
//                   predictability horizon
//   unjudged        none of these, and no figure at all that could have told: no energy reported, no smallest contact force, no reference
//   sound           none of these, and at least one figure that would have told
#pragma once

#include <span>
#include <string>

#include "bench/study/cell.hpp"

namespace jvari::bench::study {

enum class Verdict { sound, unjudged, inaccurate, adhesive, energy_gaining, not_converged, diverged, refused };
std::span<const Verdict> verdicts();
const char* name_of(Verdict);
Verdict verdict_named(const std::string&);  // throws std::runtime_error

constexpr double error_allowed = 0.1;  // relative L2

struct Judgement {
    Verdict verdict = Verdict::unjudged;
    std::string detail;  // the figure that decided, or the reason of a refusal
    long step = 0;       // where a run failed by itself; else 0
};
Judgement judge(const Cell&, double error);  // of a cell that was run with its energy probed, or refused; NaN: there is no error

}  // namespace jvari::bench::study

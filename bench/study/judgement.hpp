// What is to be said against a run (analysis/judgement.hpp), in sentences.
#pragma once

#include <string>
#include <vector>

#include "bench/study/cell.hpp"

namespace jvari::bench::study {

using jvari::is_stable, jvari::pull_allowed, jvari::pull_of, jvari::Verdict, jvari::verdict_named;

struct Flag {
    std::string name;      // "adhesion"
    std::string sentence;  // what happened: "the contact pulls with 0.55 N, ..."
};
std::vector<Flag> flags_of(const Summary&);
std::string names_of(const std::vector<Flag>&);  // "adhesion psi_gap"; "" for none

struct Judgement {
    Verdict verdict = Verdict::unjudged;
    std::string detail;  // the figure that decided, or the reason why it was not run
    long step = 0;       // where a run failed by itself; else 0
};
// of a cell that was run with its energy probed, or failed; NaN: there is no error
Judgement judge(const Cell&, double error);

}  // namespace jvari::bench::study

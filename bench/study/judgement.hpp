// Objections to a run (analysis/judgement.hpp), in sentences.
#pragma once

#include <string>
#include <vector>

#include "bench/study/cell.hpp"

namespace jvari::bench::study {

using jvari::is_stable, jvari::pull_allowed, jvari::pull_of, jvari::Verdict, jvari::verdict_named;

struct Flag {
    std::string name;      // "adhesion"
    std::string sentence;  // describes the event: "the contact pulls with 0.55 N, ..."
};
std::vector<Flag> flags_of(const Summary&);
std::string names_of(const std::vector<Flag>&);  // "adhesion psi_gap"; "" for none

struct Judgement {
    Verdict verdict = Verdict::unjudged;
    std::string detail;  // deciding figure, or the reason why the cell did not run
    long step = 0;       // failing step; 0 if the run did not fail
};
// Judges a cell that ran with its energy probed, or failed. NaN: no error is known.
Judgement judge(const Cell&, double error);

}  // namespace jvari::bench::study

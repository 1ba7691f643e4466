// Which scheme is the cheapest that is as accurate as asked: 10 %, 1 % and 0.1 % of the waveform, 3
// dB and 1 dB of the third octaves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/compare/bound.hpp"

namespace jvari::bench::compare {

// For a problem and a target; of each problem those targets that its runs are long enough for.
//   A cell meets a target where error and certificate together (bound.hpp) do; third octaves have
//   no certificate and count as measured.
// Only cells that are timed and trusted count. The waveform's measure is the headline error of the
// scene. A control is known to be wrong somewhere: it is named only where it was asked to compete.
struct Answer {
    std::size_t of;  // a cell of the problem
    std::size_t measure;
    double most;  // the target
    // none; not_known: no cell meets it, and of some neither that it does nor that it does not is
    // certain
    const char* status;
    std::optional<std::size_t> cell;  // found
    Bound bound{};                    // of its error
    // cells that meet the target and are no dearer by this clock (analysis/cheapest.hpp)
    std::string ties{};
    // other schemes with a cheaper cell (not_known: any cell) of which it is not certain
    std::string perhaps{};
    // where the cell found has matched compliance, the cheapest without it, its error and cost; or
    // "none"
    std::string as_published{};
    // of what is found by third octaves, that the uncertainty of the reference is unknown where it
    // is; of not_known, what the reference is known to, and by which other taps it is known; of
    // none, for a waveform, what stands in the way (scene_notes.hpp)
    std::string why{};

    std::string goal() const;  // "10 %", "3 dB"
};
enum class Controls { stand_beside, compete };
std::vector<Answer> cheapest_of(const study::Cells&, Controls = Controls::stand_beside);
// trusted, and no control that stands beside
bool may_win(const study::TabledCell&, Controls);

// Columns scene, <swept keys>, measure, target, status, run, scheme, options, rate, modes, error,
// bound, cost_s_per_s, ties, perhaps, as_published, why.
store::Table table_of(const std::vector<Answer>&, const study::Cells&);
// for the terminal; "" without answers
std::string cheapest_text(const std::vector<Answer>&, const study::Cells&);

}  // namespace jvari::bench::compare

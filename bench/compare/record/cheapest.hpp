// Cheapest scheme for a required accuracy: 10 %, 1 % and 0.1 % on the waveform, 3 dB and 1 dB in
// the third octaves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/cheapest.hpp"
#include "bench/compare/bound.hpp"
#include "bench/store/system/listener.hpp"

namespace jvari::bench::compare {

// Answer for a problem and a target. A problem has the targets that its runs are long enough for. A
// cell meets a target if error plus certificate (bound.hpp) stay within; third octaves have no
// certificate and count as measured.
// Only timed and trusted cells count. The waveform's measure is the headline error in the scene. A
// control is known to be wrong somewhere, so a control is named only if the user asked for it to
// compete.
struct Answer {
    std::size_t of;  // a cell of the problem
    std::size_t measure;
    double most;  // the target
    // found, none or not_known. not_known: no cell certainly meets the target, and for some cells
    // neither outcome is certain
    const char* status;
    std::optional<std::size_t> cell;  // set if found
    Bound bound{};                    // bound for the cell's error
    // cells that meet the target and cannot be told from the cheapest by these timings
    // (analysis/cheapest.hpp)
    std::string ties{};
    // other schemes with a cheaper cell (not_known: any cell) that may meet the target
    std::string perhaps{};
    // if the cheapest has matched compliance: the cheapest without, with error and cost; or "none"
    std::string as_published{};
    // Explanation. found, by third octaves: says if the reference's uncertainty is unknown.
    // not_known: the reference's uncertainty, and other taps at which cells are surely within.
    // none, for a waveform: the obstacle (scene_notes.hpp).
    std::string why{};

    std::string goal() const;  // "10 %", "3 dB"
};
enum class Controls { stand_beside, compete };
std::vector<Answer> cheapest_of(const study::Cells&, Controls = Controls::stand_beside);
// True for a trusted cell; false for a control that stands beside.
bool may_win(const study::TabledCell&, Controls);

// Answers at all tolerances: the cheapest of the cells `rows` for one error, from each tolerance at
// which it changes. Indices are of cells.
struct AnswerFrom {
    double tolerance;
    Choice choice;
};
std::vector<AnswerFrom> answers_along(const study::Cells&, study::Rows, std::size_t measure,
                                      const std::string& tap, Controls);

// Columns scene, <swept keys>, measure, target, status, run, scheme, options, rate, modes, error,
// bound, cost_s_per_s, ties, perhaps, as_published, why.
store::Table table_of(const std::vector<Answer>&, const study::Cells&);
// for the terminal; empty without answers
store::Lines cheapest_lines(const std::vector<Answer>&, const study::Cells&);

}  // namespace jvari::bench::compare

// What a trimmed model has to keep, and how far: a measure of one tap and a tolerance.
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari::bench::trim {

// One of study::measures(), as trim names it: "l2_50ms", "%".
struct Measure {
    std::string name, title, unit;
    std::size_t place;
    double window;  // of time that it listens to [s]; HUGE_VAL: the whole run
};
const std::vector<Measure>& measures();

struct Target {
    const Measure* measure;
    double most;  // 0.01 for 1 %; dB as they are
};
// "1%", "0.01", "1dB". Throws UsageError for a measure that there is not, for a tolerance in
// another unit than the measure's, and for one above 0.5 that says no unit.
Target target_of(const std::string& measure, const std::string& within);
std::string text_of(const Measure&, double error);               // "1.3 %", "0.8 dB"
std::string certainty_text(const Measure&, double certificate);  // the same, or "unknown"

// ---- The scene's start and others of another family: higher modes, a sharp triangle near an end
// (rounded as by a plectrum), a pluck elsewhere. A model that is trimmed by one start is verified
// by the others, so that it is not tuned to one.

constexpr int starts = 5;
// 0: the scene's own. 1: sharp and near an end. 2: a higher mode. Further ones are elsewhere.
// Between six and nine tenths of its size.
Scene started(Scene, int start);
std::string name_of_start(const Scene& started);  // of its first string that is set in motion

}  // namespace jvari::bench::trim

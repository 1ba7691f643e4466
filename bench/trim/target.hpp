// What a trimmed model has to keep, and how far: a measure of one tap and a tolerance.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace jvari::bench::trim {

struct Measure {
    const char *name, *title;
    const char* unit;  // "%" for what is relative, "dB"
    double (*error)(std::span<const double> candidate, std::span<const double> truth, double rate);
    double window;  // of time that it listens to [s]; HUGE_VAL: the whole run
};
std::span<const Measure> measures();

struct Target {
    const Measure* measure;
    double most;  // 0.01 for 1 %; dB as they are
};
// "1%", "0.01", "1dB". Throws UsageError for a measure that there is not, for a tolerance in another unit than the measure's, and for one
// above 0.5 that says no unit.
Target target_of(const std::string& measure, const std::string& within);
std::string text_of(const Measure&, double error);               // "1.3 %", "0.8 dB"
std::string certainty_text(const Measure&, double certificate);  // the same, or "unknown"

}  // namespace jvari::bench::trim

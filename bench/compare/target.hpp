// What a run has to keep, and how far: a measure of one tap and a tolerance.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace jvari::bench::compare {

struct Target {
    std::size_t measure;  // its place among study::measures()
    double most;          // the tolerance: 0.01 for 1 %; dB as they are
    // "l2_50ms"; the measure's title without its unit; "%"
    std::string name, title, unit;
    // "1.3 %", "0.8 dB"; `unknown` for NaN
    std::string text(double error, const char* unknown = "-") const;
};
std::vector<Target> targets();  // of every measure that less is better of, without a tolerance
// "1%", "0.01", "1dB". Throws UsageError for a measure that there is not, for a tolerance in
// another unit than the measure's, and for one above 0.5 that says no unit.
Target target_of(const std::string& measure, const std::string& within);

}  // namespace jvari::bench::compare

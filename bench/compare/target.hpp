// Target of a run: a measure at one tap, and a tolerance.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace jvari::bench::compare {

struct Target {
    std::size_t measure;  // place in study::measures()
    double most;          // tolerance: 0.01 for 1 %; dB unchanged
    // "l2_50ms"; the measure's title without its unit; "%"
    std::string name, title, unit;
    // "1.3 %", "0.8 dB"; `unknown` for NaN
    std::string text(double error, const char* unknown = "-") const;
};
// targets for all measures with smaller-is-better, without a tolerance
std::vector<Target> targets();
// Parses "1%", "0.01", "1dB". Throws UsageError for an unknown measure, for a tolerance in another
// unit than the measure's, and for a tolerance above 0.5 without a unit.
Target target_of(const std::string& measure, const std::string& within);

}  // namespace jvari::bench::compare

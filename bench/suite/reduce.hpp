// One number of a series: what a claim takes of the rows that it picks.
#pragma once

#include <map>
#include <span>
#include <string>

namespace jvari::bench::suite {

using Series = std::map<double, double>;

struct Reduced {
    double value = 0, half_width = 0;  // half_width: of the 95 % interval of a slope
    std::string why = {};              // why there is no number; "" where there is one
};

struct Take {
    const char* name;
    Reduced (*of)(const Series&);  // of a series that has a row
};
std::span<const Take> takes();  // the first is taken unasked

}  // namespace jvari::bench::suite

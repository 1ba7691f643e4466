// One number of a series: what a claim takes of the rows that it picks.
#pragma once

#include <map>
#include <string>

#include "bench/suite/claim.hpp"

namespace jvari::bench::suite {

using Series = std::map<double, double>;

struct Reduced {
    double value = 0, half_width = 0;  // half_width: of the 95 % interval of a slope
    std::string why = {};              // why there is no number; "" where there is one
};
Reduced reduce(const Series&, Take);  // of a series that has a row

}  // namespace jvari::bench::suite

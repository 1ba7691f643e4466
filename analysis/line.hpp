// A straight line through points, with the confidence of its slope: weighted least squares (GSL), its scatter estimated from the residuals,
// the interval from Student's t with two degrees of freedom fewer than points.
#pragma once

#include <span>

namespace jvari {

struct Line {
    double slope, intercept;  // NaN where fewer than two values of x are there
    double half_width;        // of the confidence interval: slope +- half_width; +inf with two points, which leave no scatter to judge by
    double scatter;           // weighted root mean square of the residuals
};

// weight: relative weight of each point, empty for equal ones; all > 0. Everything is finite.
// Throws std::invalid_argument where the lengths differ.
Line fitted_line(std::span<const double> x, std::span<const double> y, std::span<const double> weight = {}, double confidence = 0.95);

}  // namespace jvari

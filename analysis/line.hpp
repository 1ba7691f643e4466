// Fits a straight line by weighted least squares (GSL). The confidence interval of the slope follows from the scatter of the residuals and
// Student's t, with two degrees of freedom fewer than there are points.
#pragma once

#include <span>

namespace jvari {

struct Line {
    double slope, intercept;  // NaN for fewer than two different x
    double half_width;        // the confidence interval is slope +- half_width; +inf with two points, which have no scatter
    double scatter;           // weighted root mean square of the residuals
};

// weight is the relative weight (> 0) of each point; empty means equal weights. All numbers must be finite.
// Throws std::invalid_argument if the lengths differ.
Line fitted_line(std::span<const double> x, std::span<const double> y, std::span<const double> weight = {}, double confidence = 0.95);

}  // namespace jvari

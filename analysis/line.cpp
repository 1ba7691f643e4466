// Source: line.hpp. gsl_fit_wlinear takes weights as inverse variances; ours are relative, so its covariance is scaled by the scatter it
// found, chi^2/(n - 2).
#include "analysis/line.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace jvari {

Line fitted_line(std::span<const double> x, std::span<const double> y, std::span<const double> weight, double confidence) {
    if (x.size() != y.size() || (!weight.empty() && weight.size() != x.size()))
        throw std::invalid_argument("the points of a line and their weights differ in length");
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const std::size_t n = x.size();
    const auto [first, last] = std::minmax_element(x.begin(), x.end());
    if (n < 2 || *first == *last) return {nan, nan, nan, nan};
    const std::vector<double> w = weight.empty() ? std::vector<double>(n, 1.0) : std::vector<double>(weight.begin(), weight.end());
    double intercept, slope, cov00, cov01, cov11, chisq, total = 0;
    gsl_fit_wlinear(x.data(), 1, w.data(), 1, y.data(), 1, n, &intercept, &slope, &cov00, &cov01, &cov11, &chisq);
    for (const double wi : w) total += wi;
    const double half_width = n > 2 ? gsl_cdf_tdist_Pinv(0.5 * (1 + confidence), static_cast<double>(n) - 2) *
                                          std::sqrt(cov11 * chisq / (static_cast<double>(n) - 2))
                                    : std::numeric_limits<double>::infinity();
    return {slope, intercept, half_width, std::sqrt(chisq / total)};
}

}  // namespace jvari

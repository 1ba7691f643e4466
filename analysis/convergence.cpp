// Least squares of log error against log rate (gsl_fit_linear).
#include "analysis/convergence.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "schemes/trace.hpp"

namespace jvari {

namespace {
constexpr double confidence = 0.95;

bool serves(double rate, double error) {
    return std::isfinite(rate) && rate > 0 && std::isfinite(error) && error > 0;
}
}  // namespace

Order observed_order(std::span<const double> rate, std::span<const double> error) {
    if (rate.size() != error.size())
        throw std::invalid_argument("rates and errors differ in length");
    std::vector<double> x, y;
    for (std::size_t i = 0; i < rate.size(); ++i) {
        if (!serves(rate[i], error[i])) continue;
        x.push_back(std::log(rate[i]));
        y.push_back(std::log(error[i]));
    }
    const std::size_t n = x.size();
    const auto [first, last] = std::minmax_element(x.begin(), x.end());
    if (n < 2 || *first == *last) return {nan, nan, static_cast<int>(n)};
    double intercept, slope, cov00, cov01, cov11, squares;
    gsl_fit_linear(x.data(), 1, y.data(), 1, n, &intercept, &slope, &cov00, &cov01, &cov11,
                   &squares);
    const double half_width =
        n > 2 ? gsl_cdf_tdist_Pinv(0.5 * (1 + confidence), static_cast<double>(n) - 2) *
                    std::sqrt(cov11)
              : inf;
    return {-slope, half_width, static_cast<int>(n)};
}

}  // namespace jvari

// Source: convergence.hpp. gsl_fit_wlinear takes weights as inverse variances; ours are relative, so its covariance is scaled by the
// scatter it found, chi^2/(n - 2).
#include "analysis/convergence.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace jvari {

namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

bool serves(double rate, double error) {
    return std::isfinite(rate) && rate > 0 && std::isfinite(error) && error > 0;
}
}  // namespace

Order observed_order(std::span<const double> rate, std::span<const double> error, std::span<const double> weight, double confidence) {
    if (rate.size() != error.size() || (!weight.empty() && weight.size() != rate.size()))
        throw std::invalid_argument("rates, errors and weights differ in length");
    std::vector<double> x, y, w;
    for (std::size_t i = 0; i < rate.size(); ++i) {
        const double wi = weight.empty() ? 1.0 : weight[i];
        if (!serves(rate[i], error[i]) || !(wi > 0)) continue;
        x.push_back(std::log(rate[i]));
        y.push_back(std::log(error[i]));
        w.push_back(wi);
    }
    const int n = static_cast<int>(x.size());
    const auto [first, last] = std::minmax_element(x.begin(), x.end());
    if (n < 2 || *first == *last) return {nan, nan, nan, nan, n};

    double intercept, slope, cov00, cov01, cov11, chisq, total = 0;
    gsl_fit_wlinear(x.data(), 1, w.data(), 1, y.data(), 1, n, &intercept, &slope, &cov00, &cov01, &cov11, &chisq);
    for (double wi : w) total += wi;
    const double t = n > 2 ? gsl_cdf_tdist_Pinv(0.5 * (1 + confidence), n - 2) : 0;
    return {-slope, n > 2 ? t * std::sqrt(cov11 * chisq / (n - 2)) : inf, std::exp(intercept), std::sqrt(chisq / total), n};
}

}  // namespace jvari

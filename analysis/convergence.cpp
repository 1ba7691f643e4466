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

double distance(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
    return std::sqrt(sum);
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

std::vector<Order> observed_orders(std::span<const double> rate, std::span<const double> error_of_windows, double confidence) {
    if (rate.empty() || error_of_windows.size() % rate.size() != 0)
        throw std::invalid_argument("the errors are not a whole number of windows, each with one error per rate");
    std::vector<Order> orders;
    for (std::size_t at = 0; at < error_of_windows.size(); at += rate.size())
        orders.push_back(observed_order(rate, error_of_windows.subspan(at, rate.size()), {}, confidence));
    return orders;
}

std::vector<double> pairwise_orders(std::span<const double> rate, std::span<const double> error) {
    if (rate.size() != error.size()) throw std::invalid_argument("rates and errors differ in length");
    std::vector<double> orders;
    for (std::size_t i = 1; i < rate.size(); ++i) {
        const bool good = serves(rate[i - 1], error[i - 1]) && serves(rate[i], error[i]) && rate[i] != rate[i - 1];
        orders.push_back(good ? std::log(error[i - 1] / error[i]) / std::log(rate[i] / rate[i - 1]) : nan);
    }
    return orders;
}

double order_of_three(std::span<const double> a, std::span<const double> b, std::span<const double> c, double multiple) {
    const std::size_t rows = std::min({a.size(), b.size(), c.size()});
    const double coarse = distance(a.first(rows), b.first(rows)), fine = distance(b.first(rows), c.first(rows));
    return serves(multiple, coarse) && serves(multiple, fine) ? std::log(coarse / fine) / std::log(multiple) : nan;
}

double richardson(double coarse, double fine, double multiple, double order) {
    return fine + (fine - coarse) / (std::pow(multiple, order) - 1);
}

std::vector<double> richardson(std::span<const double> coarse, std::span<const double> fine, double multiple, double order) {
    std::vector<double> limit(std::min(coarse.size(), fine.size()));
    const double share = 1 / (std::pow(multiple, order) - 1);
    for (std::size_t n = 0; n < limit.size(); ++n) limit[n] = fine[n] + share * (fine[n] - coarse[n]);
    return limit;
}

double richardson_error(std::span<const double> coarse, std::span<const double> fine, double multiple, double order) {
    const std::size_t rows = std::min(coarse.size(), fine.size());
    if (rows == 0) return nan;
    const std::vector<double> nothing(rows, 0.0);
    const double gap = distance(coarse, fine);
    if (gap == 0) return 0;
    const double error = gap / (std::pow(multiple, order) - 1) / distance(fine.first(rows), nothing);
    return std::isfinite(error) && error >= 0 ? error : inf;
}

}  // namespace jvari

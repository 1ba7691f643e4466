#include "analysis/convergence.hpp"

#include <cmath>
#include <stdexcept>

#include "analysis/line.hpp"

namespace jvari {

namespace {
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
    const Line line = fitted_line(x, y, w, confidence);
    return {-line.slope, line.half_width, std::exp(line.intercept), line.scatter, static_cast<int>(x.size())};
}

}  // namespace jvari

// Order of convergence with its confidence, and what two runs at different rates say of their common limit.
//
// error = C rate^-order is a straight line in logarithms: weighted least squares (GSL), its scatter estimated from the residuals,
// the interval from Student's t with two degrees of freedom fewer than points. Leaves out: which rates are in the asymptotic range;
// `scatter` and the pairwise orders show where they are not (near contact the order is about 1, and late windows saturate).
#pragma once

#include <span>
#include <vector>

namespace jvari {

struct Order {
    double order;       // NaN where fewer than two points serve
    double half_width;  // of the confidence interval: order +- half_width; +inf with two points, which leave no scatter to judge by
    double constant;    // C: the error at rate 1 (in the unit of the rate)
    double scatter;     // weighted root mean square of the residuals, in factors of e
    int points;         // used: an error that is not finite or not positive (failed, exact) is left out
};

// rate and error: one entry per run, any order; weight: relative weight of each, empty for equal ones (an entry <= 0 is left out).
// Throws std::invalid_argument where the lengths differ.
Order observed_order(std::span<const double> rate, std::span<const double> error, std::span<const double> weight = {},
                     double confidence = 0.95);

// The same per window: error holds one row per window, row-major (windows x rates).
std::vector<Order> observed_orders(std::span<const double> rate, std::span<const double> error_of_windows, double confidence = 0.95);

// ln(e[i]/e[i+1])/ln(rate[i+1]/rate[i]) between neighbours as they are given; NaN where an error does not serve.
std::vector<double> pairwise_orders(std::span<const double> rate, std::span<const double> error);

// Order from three runs with no reference, at rates r, m r, m^2 r (`multiple` m > 1): ln(||a-b||/||b-c||)/ln m over the rows that all have.
// NaN where b and c are the same.
double order_of_three(std::span<const double> a, std::span<const double> b, std::span<const double> c, double multiple);

// Richardson: from a run and one at `multiple` times its rate (same rows), fine + (fine - coarse)/(multiple^order - 1), row by row.
double richardson(double coarse, double fine, double multiple, double order);
std::vector<double> richardson(std::span<const double> coarse, std::span<const double> fine, double multiple, double order);

// The estimate's own size: ||fine - coarse||/(multiple^order - 1) / ||fine||, the relative L2 error that the fine run is thought to have.
// +inf where it is not finite, 0 where the two are the same; over the rows that both have, NaN where there are none.
double richardson_error(std::span<const double> coarse, std::span<const double> fine, double multiple, double order);

}  // namespace jvari

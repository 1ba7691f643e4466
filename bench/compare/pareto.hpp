// The Pareto front of cost and error, where a difference that is no finding decides nothing.
#pragma once

#include <span>
#include <vector>

namespace jvari {

struct Point {
    double cost, cost_lower, cost_upper;  // median and quartiles; all the same for a cost that does not scatter
    double error;                         // brought up to its noise floor by the caller: what lies below it is a tie
};

// A point is on the front where no other is surely better: another with less error at a cost that is less or a tie, or the same error at a
// cost that is surely less. A point without a finite cost and error is never on it.
std::vector<bool> pareto_front(std::span<const Point>);

}  // namespace jvari

// The cheapest of several runs that is as accurate as asked, and which others may be it.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace jvari {

// What is known of a run that is measured against a reference (error e), which is itself uncertain
// by c: by the triangle inequality it differs from the motion of the scene by e + c at most and by
// e - c at least, relative to the norm of the reference.
double at_most(double error, double uncertainty);   // NaN where c is unknown
double at_least(double error, double uncertainty);  // 0 at least; 0 where c is unknown

struct Offer {
    std::string scheme;
    double most, least;         // of its error
    double cost, lower, upper;  // its median and quartiles
};

// `best`: of the runs within `accuracy` the one of least cost. `ties` never change it: runs within
// whose quartiles of cost touch its own and that cost less than 1.2 times as much; first the one of
// least error of its own scheme, then of each other scheme the cheapest. `perhaps`: other schemes
// with a cheaper run (without a best: any run) of which it is not certain that it is within; each
// scheme once, by its cheapest such run, in the order of the offers.
struct Choice {
    std::optional<std::size_t> best;
    std::vector<std::size_t> ties, perhaps;
};
Choice cheapest_within(double accuracy, std::span<const Offer>);

}  // namespace jvari

// Finds the cheapest run with the requested accuracy, and other runs that may be cheapest.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace jvari {

// Bounds on a run's error e against a reference that is itself uncertain by c. By the triangle
// inequality the run differs from the scene's motion by e + c at most and by e - c at least,
// relative to the norm of the reference.
double at_most(double error, double uncertainty);   // NaN if c is unknown
double at_least(double error, double uncertainty);  // 0 at least; 0 if c is unknown

struct Offer {
    std::string scheme;
    double most, least;         // bounds on the error
    double cost, lower, upper;  // median and quartiles
};

// `best`: the run with the least cost among the runs within `accuracy`. `ties` never change `best`:
// runs within `accuracy` whose cost quartiles touch those of `best` and that cost less than 1.2
// times as much. The first tie has the least error among runs of the best scheme, and then follows
// the cheapest tie of each other scheme. `perhaps`: other schemes with a cheaper run (without a
// `best`: with any run) that may or may not be within `accuracy`. Each scheme occurs once, by its
// cheapest such run, in the order of the offers.
struct Choice {
    std::optional<std::size_t> best;
    std::vector<std::size_t> ties, perhaps;
    bool operator==(const Choice&) const = default;
};
Choice cheapest_within(double accuracy, std::span<const Offer>);

}  // namespace jvari

#include "analysis/cheapest.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

namespace {
// ratio to the least cost: dearer runs never tie, however much the times scatter
constexpr double a_tie = 1.2;

std::optional<std::size_t> least(std::span<const Offer> offers, const auto& which,
                                 double Offer::*value) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < offers.size(); ++i)
        if (which(offers[i]) && (!best || offers[i].*value < offers[*best].*value)) best = i;
    return best;
}

std::vector<std::size_t> other_schemes(std::span<const Offer> offers,
                                       std::optional<std::size_t> best, const auto& which) {
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        if ((best && offers[i].scheme == offers[*best].scheme) || !which(offers[i])) continue;
        const auto known = std::find_if(others.begin(), others.end(), [&](std::size_t k) {
            return offers[k].scheme == offers[i].scheme;
        });
        if (known == others.end()) others.push_back(i);
        else if (offers[i].cost < offers[*known].cost) *known = i;
    }
    return others;
}
}  // namespace

double at_most(double error, double uncertainty) { return error + uncertainty; }

double at_least(double error, double uncertainty) {
    return std::isinf(error)         ? error
           : std::isnan(uncertainty) ? 0
                                     : std::fmax(0, error - uncertainty);
}

Choice cheapest_within(double accuracy, std::span<const Offer> offers) {
    const auto met = [=](const Offer& o) { return o.most <= accuracy; };
    const auto best = least(offers, met, &Offer::cost);
    const auto tied = [&](const Offer& o) {
        return met(o) && o.lower <= offers[*best].upper && o.cost < a_tie * offers[*best].cost;
    };
    const auto own = [&](const Offer& o) { return tied(o) && o.scheme == offers[*best].scheme; };
    const auto perhaps = [&](const Offer& o) {
        return !met(o) && o.least <= accuracy && (!best || o.cost < offers[*best].cost);
    };
    std::vector<std::size_t> ties;
    if (best) {
        ties = other_schemes(offers, best, tied);
        const auto finest = least(offers, own, &Offer::most);
        if (finest && finest != best) ties.insert(ties.begin(), *finest);
    }
    return {best, std::move(ties), other_schemes(offers, best, perhaps)};
}

}  // namespace jvari

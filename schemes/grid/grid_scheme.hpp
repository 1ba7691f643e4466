// What strings on a grid sum and tell, each by its own steps: three_point_string.hpp,
// midpoint_string.hpp.
#pragma once

#include <algorithm>

#include "schemes/grid/finite_difference.hpp"

namespace jvari {

// (Block::stopped): a step of a dense contact takes milliseconds
constexpr long steps_on_grid_between_questions = 16;

// Of what lies on a grid, odd about both ends: <d, d>, <d, -D2 d>, <d, D4 d>.
struct Squares {
    double own = 0, slope = 0, curve = 0;
};
template <class At>  // d_l = at(l), l = 0..N, 0 at both ends
Squares squares(const Grid& g, At at) noexcept {
    const double h2 = g.dx * g.dx;
    Squares sum;
    double last = at(1);  // of the cell before: odd
    for (int l = 0; l < g.intervals; ++l) {
        const double d = at(l), e = at(l + 1) - d;
        sum.own += d * d;
        sum.slope += e * e;
        sum.curve += (e - last) * (e - last);
        last = e;
    }
    sum.slope /= h2;
    sum.curve /= h2 * h2;
    return sum;
}

// What a unit of force at each place moves every place: places x places, symmetric to the last bit.
// responses: what the scheme's solve makes of each place, gain: times that.
std::vector<double> compliances(const std::vector<Stencil>& places,
                                const std::vector<Stencil>& responses, double gain, const Grid&);

// Facts that every string on a grid reports.
std::vector<Fact> grid_facts(const GridString&);

// A run has diverged where the kinetic energy passes this many times what the string was given
// (initial energy and work of the pluck): a stable scheme near its limit may hold a multiple of it
// in its highest mode, an unstable one passes any multiple.
constexpr double divergence_factor = 1e4;
constexpr long divergence_check = 64;  // [steps]

}  // namespace jvari

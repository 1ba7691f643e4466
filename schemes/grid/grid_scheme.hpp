// Sums and facts shared by strings on a grid. Each string has its own steps:
// three_point_string.hpp, midpoint_string.hpp.
#pragma once

#include <algorithm>

#include "schemes/grid/finite_difference.hpp"

namespace jvari {

// (Block::stopped): a step of a dense contact takes milliseconds
constexpr long steps_on_grid_between_questions = 16;

// Squares of a grid function, odd about both ends: <d, d>, <d, -D2 d>, <d, D4 d>.
struct Squares {
    double own = 0, slope = 0, curve = 0;
};
template <class At>  // d_l = at(l), l = 0..N, 0 at both ends
Squares squares(const Grid& g, At at) noexcept {
    const double h2 = g.dx * g.dx;
    Squares sum;
    double last = at(1);  // the cell before, by oddness
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

// Displacement at every place under a unit force at each place: places x places, symmetric to the
// last bit. responses: the scheme's solution for each place, gain: a factor on it.
std::vector<double> compliances(const std::vector<Stencil>& places,
                                const std::vector<Stencil>& responses, double gain, const Grid&);

// Facts that every string on a grid reports.
std::vector<Fact> grid_facts(const GridString&);

// Divergence: a run has diverged if its kinetic energy exceeds this many times the supplied energy
// (initial energy and the pluck's work). A stable scheme near its limit may hold several times that
// energy in its highest mode, but an unstable one exceeds any multiple.
constexpr double divergence_factor = 1e4;
constexpr long divergence_check = 64;  // [steps]

}  // namespace jvari

// Ideal string above a rigid profile on its lattice of characteristics, dx = c dt: Schatzman &
// Bercovier, "Numerical approximation of a wave equation with unilateral constraints", Math. Comp.
// 53 (1989), on the lattice in sitar_fdm.cpp. The lattice contains all string modes; its error
// falls in inverse proportion to the number of cells, because each bounce comes two steps late. On
// a flat wall the motion tends to Bamberger and Schatzman's closed form, u = w + 2 sup (profile -
// w)^+ over the backward cone, w the free motion. This form holds until a contact's reflection by
// an end or by an edge of the wall arrives. After this instant the lattice goes on, and no closed
// form is known.
//
// Rows fall on steps. Among the multiples of the tap rate that give about the requested number of
// cells, the scheme takes the most accurately tuned one.
#include <algorithm>
#include <cmath>

#include "reference/references.hpp"
#include "schemes/making.hpp"
#include "schemes/sitar/sitar.hpp"

namespace jvari {

namespace {
constexpr Option cells_option{
    "cells", "8192",
    "least number of cells from end to end, 64 to 262144; at most twice as many are taken"};
constexpr Option options[] = {cells_option};

std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    const double cells = number_option(settings, cells_option);
    if (!(cells >= 64 && cells <= 262144))
        throw Refusal("option cells: expected a number from 64 to 262144");
    const String& s = scene.strings.front();
    if (s.barriers.empty())
        throw Refusal(std::string(descriptor.name) +
                      ": the string touches nothing; exact_linear has its closed form");
    // cells, were a step a row
    const double per_row = s.length * settings.tap_rate / std::sqrt(s.tension / s.linear_density);
    const double least = std::max(1.0, std::ceil(cells / per_row));
    double chosen = least, nearest = 1;
    for (double steps = least; steps < least + std::min(least, 4096.0); ++steps) {
        const double misfit = std::abs(steps * per_row - std::round(steps * per_row));
        if (misfit < nearest - 1e-9) nearest = misfit, chosen = steps;
    }
    return characteristic_lattice_of(descriptor, scene,
                                     {chosen * settings.tap_rate, settings.tap_rate, 0, {}});
}
}  // namespace

const Descriptor characteristic_lattice = {
    .name = "characteristic_lattice",
    .source = "Schatzman & Bercovier 1989, by Bamberger & Schatzman's closed form on a flat wall",
    .represents = Feature::rigid_profile | Feature::initial_shape,
    .balance = Balance::to_tolerance,
    .clock = Clock::continuous,
    .make = make,
    .options = options,
    .note = "An ideal string released over one rigid profile that begins at x = 0.",
    .confirmation = [](const Scene&) {
        return Confirmation{{{}, {{cells_option.name, "16384"}}}, {}};
    }};

}  // namespace jvari

// An ideal string over a rigid wall on the lattice of its characteristics: the reference against
// the closed form.
#include "scenes/scene_file.hpp"
#include "schemes/sitar/sitar.hpp"
#include "tests/sitar_scenes.hpp"

namespace jvari {
namespace {

constexpr double across = 1.0 / 1050;  // the time of a wave from end to end [s]

std::vector<double> on_lattice(const Scene& scene, int cells, double tap_rate) {
    const jvari::Run r =
        run(characteristic_lattice, scene, {0, tap_rate, 0, {{"cells", std::to_string(cells)}}});
    EXPECT_EQ(r.status.outcome, Outcome::ok);
    const auto y = r.trace.column(0);
    return {y.begin(), y.begin() + r.trace.rows};
}
// Bamberger & Schatzman: u = w + 2 sup (-w)^+ over the backward cone, w by d'Alembert; here with
// the wall under the whole string, until the ends' reflections of the contact arrive. The rows of a
// tap at 0.6 L.
std::vector<double> closed_form(const String& s, double tap_rate, long rows, int cells) {
    const auto free = [&](int m, long n) {
        const double x = s.length * m / cells, way = s.length * static_cast<double>(n) / cells;
        return 0.5 * (initial_shape(s, x - way) + initial_shape(s, x + way));
    };
    const double steps = cells / (across * tap_rate);  // from row to row
    std::vector<double> before(cells + 1), now(cells + 1), next(cells + 1), u;
    const int heard = 3 * cells / 5;
    for (long n = 0; static_cast<long>(u.size()) < rows; ++n) {
        if (n == std::lround(steps * static_cast<double>(u.size())))
            u.push_back(free(heard, n) + 2 * now[heard]);
        for (int m = 1; m < cells; ++m)
            next[m] = std::max({now[m - 1], now[m + 1], -free(m, n + 1)});
        now.swap(next);
    }
    return u;
}

TEST(CharacteristicLattice, TendsToTheClosedFormUntilTheEndsAreHeard) {
    // The pluck at 0.3 L falls on the wall at one end at 0.3 of a crossing and from there at 2.5
    // times the waves' speed.
    Scene scene = read_scene("flat_bridge_ideal", {"string.0.barrier.0.stiffness_density=rigid"});
    std::get<ProfileBarrier>(scene.strings[0].barriers[0]).to = 0.25;
    scene.strings[0].start = TriangleShape{0.075, 2e-3, 0};
    scene.taps = {tap(Quantity::displacement, 0.15)};
    scene.duration = 0.88 * across;
    const double tap_rate = 441000;
    const auto coarse = on_lattice(scene, 1260, tap_rate), fine = on_lattice(scene, 5040, tap_rate);
    const auto exact =
        closed_form(scene.strings[0], tap_rate, static_cast<long>(fine.size()), 4200);
    EXPECT_LT(relative_difference(fine, exact), 2e-3);
    EXPECT_NEAR(relative_difference(coarse, exact) / relative_difference(fine, exact), 4, 0.5)
        << "its error falls as one over the cells";
    Scene longer = scene;
    longer.duration = 1.3 * across;
    const auto later = on_lattice(longer, 4200, tap_rate);
    EXPECT_GT(relative_difference(later, closed_form(scene.strings[0], tap_rate,
                                                     static_cast<long>(later.size()), 4200)),
              0.02)
        << "the closed form knows nothing of the ends";
}

}  // namespace
}  // namespace jvari

// Theta scheme for the stiff string: Bilbao 2009, "Numerical Sound Synthesis", chapter 7; a
// parametric implicit three-point scheme, a kind named in section 5 of van Walstijn et al. 2016.
//
//     (theta + (1 - theta) A) (u+ - 2u + u-)/dt^2 = c^2 D2 u - kappa^2 D4 u - R (u+ - u-)/2dt
//         + g F/(mu dx),
//     A = I + dx^2/2 D2
//
// so M = I + (1 - theta) dx^2/2 D2, and u+ costs one solve with three diagonals, or five if the
// loss has u_xxxxt (grid_solve.hpp). Expanding omega^2 = c^2 beta^2 + kappa^2 beta^4 in dx and dt,
// the error c^2 beta^4 [dx^2/12 - c^2 dt^2/12 - (1 - theta) dx^2/2] vanishes for
//     theta = 5/6 + c^2 dt^2/(6 dx^2),
// the default (option `theta` overrides): the remaining error is second order times kappa^2
// beta^2/c^2, and fourth order. Stable if 2 theta - 1 >= c^2 dt^2/dx^2 + 4 kappa^2 dt^2/dx^4; at
// the default theta, c^2 dt^2/dx^2 + 6 kappa^2 dt^2/dx^4 <= 1. Losses are centred, and do not enter
// the limit. Options: `grid` (intervals), `over_limit`, `theta`.
#include "schemes/driver/pairings.hpp"
#include "schemes/grid/grid_solve.hpp"
#include "schemes/grid/three_point_string.hpp"
#include "schemes/making.hpp"

namespace jvari {

namespace {
struct ThetaUpdate {
    FivePoint pass;
    GridSolve solve;  // for M + dt R/2
    int intervals;
    IncrementPass add = increment_pass();

    // Solves for the increment: if the loss in space is strong or the string slow, the solve loses
    // digits of its solution, and u+ is nearly u. In u+ - u- those digits do not matter.
    void operator()(double* next, const double* now, const double* before) noexcept {
        pass(solve.input(), now, before);
        solve(next);
        add(intervals, next, before);
    }
    Stencil response(const Stencil& s) const { return solve.response(s); }
};

constexpr Option theta_option{"theta", "",
                              "theta of the scheme, above 0.5; absent: 5/6 + c^2 dt^2/(6 dx^2)"};
constexpr Option options[] = {compliance_option, profile_points_option, grid_option,
                              over_limit_option, theta_option};

double spacing_limit(const String& s, double dt, double theta) {  // theta 0: the tuned one
    return theta != 0 ? theta_spacing_limit(s, dt, theta) : theta_spacing_limit(s, dt);
}

std::unique_ptr<Scheme> theta_scheme(const Descriptor& descriptor, const Scene& scene,
                                     const Settings& settings, const RuleChoice& rule) {
    using OfOne = ThreePointString<ThetaUpdate>;
    const double dt = 1 / settings.sample_rate, chosen = number_option(settings, theta_option, 0);
    if (chosen != 0 && !(chosen > 0.5))
        throw Refusal("option theta: found " + std::to_string(chosen) + ", expected more than 0.5");
    return on_three_point_support<OfOne>(descriptor, scene, settings, rule, [&](const Scene& one) {
        const String& s = one.strings.front();
        const double limit = spacing_limit(s, dt, chosen);
        const Grid grid = grid_for(descriptor, s, settings, limit);
        const GridString g = on_grid(descriptor, one, settings, grid, fit_losses(s));
        const double theta = chosen != 0 ? chosen : tuned_theta(s, dt, grid.dx),
                     m = 0.5 * (1 - theta) * grid.dx * grid.dx;
        ThetaUpdate update{
            FivePoint(g, dt, m, 0, 1, FivePoint::Of::increment),
            GridSolve(grid, 1 + g.loss.sigma0 * dt, m - g.loss.sigma1 * dt, g.loss.sigma2 * dt),
            grid.intervals};
        return std::make_unique<OfOne>(
            g, dt, m, 0.0, std::move(update),
            std::vector<Fact>{{facts::spacing_over_limit, grid.dx / limit}, {facts::theta, theta}});
    });
}
template <class Rule>
std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    return theta_scheme(descriptor, scene, settings, rule_of<Rule>(settings));
}

double grid_margin(const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    return spacing_margin(
        s, settings,
        spacing_limit(s, 1 / settings.sample_rate, number_option(settings, theta_option, 0)));
}
}  // namespace

extern const Descriptor finite_difference_theta = {
    .name = "finite_difference_theta",
    .source = "Bilbao 2009, chapter 7",
    .represents = grid_features | Feature::moving_body,
    .balance = Balance::exact,
    .make = make<GradientRule>,
    .options = options,
    .approximates = grid_approximates,
    .limit = {"grid_limit", grid_margin}};

const StringRow finite_difference_theta_row = {&finite_difference_theta,
                                               {JVARI_RULES(JVARI_MAKER)}};

}  // namespace jvari

// Explicit finite differences with implicit contact: Bilbao, Torin & Chatziioannou 2015, "Numerical
// modeling of collisions in musical instruments"; the contact equation is van Walstijn et al. 2016,
// eq 48, over the span 2 dt.
//
//     (1 + sigma0 dt) u+ = (2 I + c^2 dt^2 D2 - kappa^2 dt^2 D4 - S) u
//         - ((1 - sigma0 dt) I - S) u- + dt^2/(mu dx) g F
//
// with S = -2 sigma1 dt D2 + 2 sigma2 dt D4: the loss in space takes the backward difference in
// time, the sigma0 loss the central one. Written with the central one throughout, the difference is
// taken from the mass, M = I - S/2, so the balance is exact and R >= 0. The scheme is stable if M
// >= dt^2 K/4, that is dx^2 >= (p + sqrt(p^2 + 16 q))/2, p = c^2 dt^2 + 4 sigma1 dt, q = kappa^2
// dt^2 + 4 sigma2 dt. Options: `grid` (intervals), `over_limit`. Approximations and omissions:
// finite_difference.hpp. Rows, energy and start: three_point_string.hpp.
#include "schemes/driver/pairings.hpp"
#include "schemes/grid/three_point_string.hpp"
#include "schemes/making.hpp"

namespace jvari {

namespace {
struct ExplicitUpdate {
    FivePoint pass;
    double inverse;  // 1/(1 + sigma0 dt)

    void operator()(double* next, const double* now, const double* before) noexcept {
        pass(next, now, before);
    }
    Stencil response(Stencil s) const {
        for (double& w : s.weight) w *= inverse;
        return s;
    }
};

constexpr Option options[] = {compliance_option, profile_points_option, grid_option,
                              over_limit_option};

std::unique_ptr<Scheme> explicit_scheme(const Descriptor& descriptor, const Scene& scene,
                                        const Settings& settings, const RuleChoice& rule) {
    using OfOne = ThreePointString<ExplicitUpdate>;
    return on_three_point_support<OfOne>(descriptor, scene, settings, rule, [&](const Scene& one) {
        const double dt = 1 / settings.sample_rate;
        const String& s = one.strings.front();
        const LossFit loss = fit_losses(s);
        const double limit = explicit_spacing_limit(s, loss, dt), divisor = 1 + loss.sigma0 * dt;
        const double m = loss.sigma1 * dt, m4 = -loss.sigma2 * dt;
        const GridString g =
            on_grid(descriptor, one, settings, grid_for(descriptor, s, settings, limit), loss);
        return std::make_unique<OfOne>(
            g, dt, m, m4, ExplicitUpdate{FivePoint(g, dt, m, m4, divisor), 1 / divisor},
            std::vector<Fact>{{facts::spacing_over_limit, g.grid.dx / limit}});
    });
}
template <class Rule>
std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    return explicit_scheme(descriptor, scene, settings, rule_of<Rule>(settings));
}

double grid_margin(const Scene& scene, const Settings& settings) {
    const String& s = scene.strings.front();
    return spacing_margin(s, settings,
                          explicit_spacing_limit(s, fit_losses(s), 1 / settings.sample_rate));
}
}  // namespace

extern const Descriptor finite_difference_explicit = {
    .name = "finite_difference_explicit",
    .source = "Bilbao, Torin & Chatziioannou 2015",
    .represents = grid_features | Feature::moving_body,
    .balance = Balance::exact,
    .make = make<GradientRule>,
    .options = options,
    .approximates = grid_approximates,
    .limit = {"grid_limit", grid_margin}};

const StringRow finite_difference_explicit_row = {&finite_difference_explicit,
                                                  {JVARI_RULES(JVARI_MAKER)}};

}  // namespace jvari

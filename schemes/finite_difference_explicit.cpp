// Explicit finite differences with implicit contact: Bilbao, Torin & Chatziioannou 2015, "Numerical modeling of collisions in musical
// instruments"; the contact equation is that of van Walstijn et al. 2016, eq 48, over the span 2 dt.
//
//     (1 + sigma0 dt) u+ = (2 I + c^2 dt^2 D2 - kappa^2 dt^2 D4 + 2 sigma1 dt D2) u - ((1 - sigma0 dt) I + 2 sigma1 dt D2) u- + dt^2/(mu
//     dx) g F
//
// Stable where dx^2 >= (p + sqrt(p^2 + 16 kappa^2 dt^2))/2, p = c^2 dt^2 + 4 sigma1 dt. Options: `grid` (intervals), `over_limit`.
// What it approximates and leaves out: finite_difference.hpp. Rows, energy and start: three_point_string.hpp.
#include "schemes/three_point_string.hpp"

namespace jvari {

extern const Descriptor finite_difference_explicit;

namespace {
struct ExplicitUpdate {
    FivePoint pass;
    double inverse;  // 1/(1 + sigma0 dt)

    void operator()(double* next, const double* now, const double* before) const noexcept { pass(next, now, before); }
    Stencil response(Stencil s) const {
        for (double& w : s.weight) w *= inverse;
        return s;
    }
};

std::unique_ptr<Scheme> make(const Scene& scene, const Settings& settings) {
    refuse_missing(finite_difference_explicit, scene);
    refuse_unknown_options(settings, {"grid", "over_limit"});
    const int rows = steps_per_row(settings);
    const double dt = 1 / settings.sample_rate;
    std::vector<ThreePointString<ExplicitUpdate>> strings;
    for (std::size_t i = 0; i < scene.strings.size(); ++i) {
        const String& s = scene.strings[i];
        const LossFit loss = fit_losses(s);
        const double limit = explicit_spacing_limit(s, loss, dt), m = loss.sigma1 * dt, divisor = 1 + loss.sigma0 * dt;
        const GridString g = on_grid(scene, static_cast<int>(i), grid_for(finite_difference_explicit, s, settings, limit), loss);
        strings.emplace_back(g, dt, rows, m, ExplicitUpdate{FivePoint(g, dt, m, divisor), 1 / divisor},
                             std::vector<Fact>{{"spacing_over_limit", g.grid.dx / limit, ""}});
    }
    return std::make_unique<GridScheme<ThreePointString<ExplicitUpdate>>>(std::move(strings));
}
}  // namespace

const Descriptor finite_difference_explicit = {
    "finite_difference_explicit", "Bilbao, Torin & Chatziioannou 2015", grid_features, Balance::exact, Clock::stepped, make};

}  // namespace jvari

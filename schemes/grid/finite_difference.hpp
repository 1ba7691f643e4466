// Shared code for the finite difference schemes: one string on the grid x_l = l dx, l = 0..N, dx =
// L/N, with simply supported ends.
//
// Sources: Bilbao, Torin & Chatziioannou 2015 (grid, stability limit, energy), Bilbao 2009 chapter
// 7 (theta scheme), Chatziioannou & van Walstijn 2015 (two-step midpoint), van Walstijn et al. 2016
// eqs 5-6 (footprints). D2 is the second difference with u_0 = u_N = 0 and D4 = D2 D2, so that
// sin(i pi l/N) is an eigenvector of both: D2 -> -lambda_i, lambda_i = 4/dx^2 sin^2(i pi/2N).
// Footprints are projected on the grid's hat functions; the weights that spread a force also read
// the displacement, which closes the energy balance. A point (width 0) is the hat function itself.
// Profiles are lumped: a node carries the stiffness density times dx. The loss is 2 sigma0 u_t - 2
// sigma1 u_xxt + 2 sigma2 u_xxxxt, fitted to the scene's law, since a grid cannot follow a general
// one. All three are non-negative: no wavenumber of the grid gains energy. With compliance=matched
// the compliance that the grid takes from the string stands in series with the points, and profiles
// are touched at separate points (option `points`): at its nodes a grid yields more than the true
// string. Left out: contact loss with compliance=matched, measured modes, polarisation; a moving
// body by the midpoint scheme.
#pragma once

#include <optional>
#include <vector>

#include "schemes/contact/compliance.hpp"
#include "schemes/driver/string_step.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// ---- Weights on nodes.

struct Stencil {  // sum_j weight[j] u[first + j]
    int first = 1;
    std::vector<double> weight;

    double read(const double* u) const {
        double sum = 0;
        for (std::size_t j = 0; j < weight.size(); ++j)
            sum += weight[j] * u[first + static_cast<int>(j)];
        return sum;
    }
    void add(double scale, double* u) const {
        for (std::size_t j = 0; j < weight.size(); ++j)
            u[first + static_cast<int>(j)] += scale * weight[j];
    }
};

struct Grid {
    int intervals = 0;  // N
    double dx = 0;      // [m]
};
// the cosine footprint against every hat function
Stencil footprint_stencil(const Grid&, double position, double width);
// cubic through four nodes, odd about the ends
Stencil displacement_stencil(const Grid&, double position);
// -T y' + EI y''' at L, both fourth order, odd about L
Stencil nut_force_stencil(const Grid&, const String&);

// ---- Losses.

struct LossFit {        // sigma(beta) ~ sigma0 + sigma1 beta^2 + sigma2 beta^4
    double sigma0 = 0;  // [1/s]
    double sigma1 = 0;  // [m^2/s]
    double sigma2 = 0;  // [m^4/s]
    double misfit = 0;  // worst relative error over the modes below 20 kHz

    // [1/s], as a function of beta^2 [1/m^2]
    double at(double square) const { return sigma0 + (sigma1 + sigma2 * square) * square; }
};
// Least squares for the relative error over the modes below 20 kHz, each octave with the same
// weight; no coefficient negative.
LossFit fit_losses(const String&);

// ---- Stability limits, dt [s], dx [m].

double explicit_spacing_limit(const String&, const LossFit&, double dt);  // the smallest dx
double theta_spacing_limit(const String&, double dt);                     // with the tuned theta
double theta_spacing_limit(const String&, double dt, double theta);       // theta > 1/2
double tuned_theta(const String&, double dt, double dx);

// ---- The grid a scheme takes: option `grid`, or the finest that the limit allows, or `over_limit`
// times finer than the limit on purpose; with both, `grid`, which may then be up to `over_limit`
// times finer than the limit.
// Settings::modes asks for modes, which a grid does not have; the grid comes from the rate, and
// fact `grid_intervals` reports it.
inline constexpr Option grid_option{"grid", "",
                                    "intervals of the grid, a whole number from 5 on; absent: the "
                                    "finest that is stable, or where any is the "
                                    "finest of the explicit scheme without loss"};
inline constexpr Option over_limit_option{
    "over_limit", "",
    "factor above 1: lets the grid be finer than is stable by as much; absent: it may not be"};
Grid grid_for(const Descriptor&, const String&, const Settings&, double spacing_limit);
// dx over the limit, less 1; NaN without option `grid`
double spacing_margin(const String&, const Settings&, double spacing_limit);
// Refusal unless a whole number, 5 or more
Grid grid_of(const Descriptor&, const String&, double intervals);

// ---- A string on its grid.

struct GridTap {
    Quantity quantity;
    Stencil stencil;  // empty for a contact force, and only then
};
struct GridString {
    Grid grid;
    double mass = 0;            // mu dx, for a node [kg]
    double c2 = 0, kappa2 = 0;  // T/mu [m^2/s^2], EI/mu [m^4/s^2]
    LossFit loss;
    std::vector<double> start, start_velocity;  // u_0..u_N at t = 0 [m], [m/s]
    bool moves = false;                         // at t = 0
    StringPoints points;                        // theta: the scheme's to fill in
    // for each point, the nodes at which obstacles read and push
    std::vector<Stencil> stencils;
    Stencil pluck_stencil;
    // compliance of the first contact under a steady force, relative to the scene's string; 0
    // unless the contact is lumped
    double compliance = 0;
    // footprint of the narrowest lumped barrier or thread [cells]; 0 if there is none
    double narrowest = 0;
    std::vector<GridTap> taps;
    bool on_body = false;  // true on a moving body
    Stencil mu;            // and the inertia of a node against its acceleration [kg]
};
// Von Neumann relations; m and m4 from three_point_string.hpp.
FreeMode three_point_mode(const GridString&, double dt, double m, double m4, int mode);
FreeMode midpoint_mode(const GridString&, double dt, int mode);

GridString on_grid(const Descriptor&, const Scene&, const Settings&, const Grid&, const LossFit&);

// Features that every scheme on a grid represents.
constexpr Features grid_features =
    Feature::bending_stiffness | Feature::damping | Feature::frequency_dependent_damping |
    Feature::lumped_barrier | Feature::profile_barrier | Feature::several_barriers |
    Feature::power_law_contact | Feature::contact_loss | Feature::thread | Feature::initial_shape |
    Feature::initial_velocity | Feature::pluck | any_mass | Feature::barrier_above | any_rigid;
inline constexpr Approximation grid_approximates[] = {
    {Feature::frequency_dependent_damping, facts::loss_fit_misfit}};

// ---- The symmetric band matrix a0 I + a2 D2 + a4 D4 over the interior nodes, factored L D L'.

class BandedFactor {
public:
    BandedFactor() = default;
    BandedFactor(const Grid&, double a0, double a2, double a4);  // Refusal unless positive definite
    // u_1..u_{N-1} in place, between finite u_0 and u_N
    void solve(double* u) const noexcept;
    // Response to a stencil, cut below rounding
    Stencil solve(const Stencil&) const;

private:
    int n_ = 0;
    bool wide_ = false;                        // a4 != 0: five diagonals, else three
    std::vector<double> one_, two_, inverse_;  // below the diagonal by one and two; 1/D
};

}  // namespace jvari

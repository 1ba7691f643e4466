// See finite_difference.hpp for sources. Long: weights, loss fit, limits, von Neumann relations,
// grid and band matrix stand in the header's order, each a few functions that no other file needs
// apart.
#include "schemes/grid/finite_difference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scenes/excitation.hpp"
#include "scenes/start.hpp"
#include "schemes/decompositions.hpp"
#include "schemes/making.hpp"

namespace jvari {

using std::numbers::pi;

// ---- Weights on nodes.

namespace {
Stencil trimmed(int first, std::vector<double> w) {  // without zeros at either end
    std::size_t low = 0, high = w.size();
    while (low < high && w[low] == 0) ++low;
    while (high > low && w[high - 1] == 0) --high;
    return {first + static_cast<int>(low), std::vector<double>(w.begin() + low, w.begin() + high)};
}

// P(x) with P'' the footprint (pi/2w) cos(pi x/w) on |x| < w/2: 0 before it, x after it   (van
// Walstijn et al. 2016, eq 6)
long double twice_integrated(long double x, long double w) {
    if (x <= -w / 2) return 0;
    if (x >= w / 2) return x;
    constexpr long double p = std::numbers::pi_v<long double>;
    return (x + w / 2) / 2 - w / (2 * p) * std::cos(p * x / w);
}
}  // namespace

Stencil footprint_stencil(const Grid& g, double position, double width) {
    const long double h = g.dx;
    std::vector<double> w;
    // the integral of footprint x hat: second difference of P over h
    for (int l = 1; l < g.intervals; ++l) {
        const auto P = [&](int node) { return twice_integrated(node * h - position, width); };
        const bool outside =
            (l + 1) * h <= position - width / 2 || (l - 1) * h >= position + width / 2;
        w.push_back(outside ? 0.0 : static_cast<double>((P(l + 1) - 2 * P(l) + P(l - 1)) / h));
    }
    return trimmed(1, w);
}

Stencil displacement_stencil(const Grid& g, double position) {
    const double at = position / g.dx;
    const int cell = static_cast<int>(std::clamp(std::floor(at), 0.0, g.intervals - 1.0));
    std::vector<double> w(g.intervals - 1, 0.0);
    for (int j = -1; j <= 2; ++j) {
        double weight = 1;
        for (int i = -1; i <= 2; ++i)
            if (i != j) weight *= (at - cell - i) / (j - i);
        int node = cell + j;
        if (node < 0) node = -node, weight = -weight;  // u(-x) = -u(x)
        // u(2L - x) = -u(x)
        if (node > g.intervals) node = 2 * g.intervals - node, weight = -weight;
        if (node > 0 && node < g.intervals) w[node - 1] += weight;
    }
    return trimmed(1, w);
}

Stencil nut_force_stencil(const Grid& g, const String& s) {
    const double slope = s.tension / (12 * g.dx),
                 shear = s.bending_stiffness / (8 * g.dx * g.dx * g.dx);
    // y' = (-16 u_{N-1} + 2 u_{N-2})/12 dx, y''' = (26 u_{N-1} - 16 u_{N-2} + 2 u_{N-3})/8 dx^3:
    // central differences of an odd function
    return {g.intervals - 3, {2 * shear, -2 * slope - 16 * shear, 16 * slope + 26 * shear}};
}

// ---- Losses.

namespace {
struct Fit {
    LossFit loss;
    double square = HUGE_VAL;  // weighted sum of squared relative errors
};

// Least squares with those powers 0, 1, 2 of x for which `powers` has a bit.
Fit fit_powers(int powers, const std::vector<double>& x, const std::vector<double>& sigma,
               const std::vector<double>& weight) {
    std::vector<int> power;
    for (int p = 0; p < 3; ++p)
        if (powers >> p & 1) power.push_back(p);
    const std::size_t n = power.size();
    // the normal equations: long double bears the square of their condition
    std::vector<long double> normal(n * n), right(n);
    for (std::size_t i = 0; i < x.size(); ++i)
        for (std::size_t a = 0; a < n; ++a) {
            const long double root = x[i], weighted = weight[i] * std::pow(root, power[a]);
            right[a] += weighted * sigma[i];
            for (std::size_t b = 0; b < n; ++b)
                normal[b * n + a] += weighted * std::pow(root, power[b]);
        }
    const std::vector<long double> inverse = inverse_of(normal, static_cast<int>(n));
    double coefficient[3] = {};  // for each power
    for (std::size_t a = 0; a < n; ++a)
        coefficient[power[a]] = static_cast<double>(
            std::inner_product(right.begin(), right.end(), inverse.begin() + a * n, 0.0L));
    const auto [sigma0, sigma1, sigma2] = coefficient;
    Fit fit{{sigma0, sigma1, sigma2}, 0};
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double off = sigma0 + (sigma1 + sigma2 * x[i]) * x[i] - sigma[i];
        fit.square += weight[i] * off * off;
    }
    return fit;
}
}  // namespace

LossFit fit_losses(const String& s) {
    const Modes modes = modes_of(s, std::clamp(modes_below(s, 20e3), 3, most_modes));
    const std::size_t n = modes.beta.size();
    std::vector<double> x, w;
    double all = 0;  // sum over the weights: the squared error of an empty fit
    for (std::size_t i = 0; i < n; ++i) {
        if (modes.sigma[i] <= 0) return {};
        const double relative = modes.beta[i] / modes.beta.back(),
                     weight = 1 / static_cast<double>(i + 1);
        x.push_back(relative * relative);
        w.push_back(weight / (modes.sigma[i] * modes.sigma[i]));
        all += weight;
    }
    // Least squares without negative coefficients: the best set of powers that needs none; smallest
    // sets first
    Fit best;
    for (const int powers : {1, 2, 4, 3, 5, 6, 7}) {
        const Fit fit = fit_powers(powers, x, modes.sigma, w);
        const bool negative = std::min({fit.loss.sigma0, fit.loss.sigma1, fit.loss.sigma2}) < 0;
        if (!negative && fit.square < best.square - 1e-20 * all) best = fit;
    }
    LossFit fit = best.loss;
    for (std::size_t i = 0; i < n; ++i)
        fit.misfit = std::max(fit.misfit, std::abs(fit.at(x[i]) / modes.sigma[i] - 1));
    const double square = modes.beta.back() * modes.beta.back();
    fit.sigma1 /= square;
    fit.sigma2 /= square * square;
    return fit;
}

// ---- Stability limits.

double explicit_spacing_limit(const String& s, const LossFit& loss, double dt) {
    const double c2 = s.tension / s.linear_density, kappa2 = s.bending_stiffness / s.linear_density;
    const double p = c2 * dt * dt + 4 * loss.sigma1 * dt;
    const double q = kappa2 * dt * dt + 4 * loss.sigma2 * dt;
    return std::sqrt(0.5 * (p + std::sqrt(p * p + 16 * q)));
}

// 2 theta - 1 >= c^2 dt^2/dx^2 + 4 kappa^2 dt^2/dx^4
double theta_spacing_limit(const String& s, double dt, double theta) {
    const double p = s.tension / s.linear_density * dt * dt,
                 q = s.bending_stiffness / s.linear_density * dt * dt;
    const double room = 2 * theta - 1;
    return std::sqrt(0.5 * (p + std::sqrt(p * p + 16 * room * q)) / room);
}

double tuned_theta(const String& s, double dt, double dx) {
    return 5.0 / 6 + s.tension / s.linear_density * dt * dt / (6 * dx * dx);
}

// the same at the tuned theta: 1 >= c^2 dt^2/dx^2 + 6 kappa^2 dt^2/dx^4
double theta_spacing_limit(const String& s, double dt) {
    const double p = s.tension / s.linear_density * dt * dt,
                 q = s.bending_stiffness / s.linear_density * dt * dt;
    return std::sqrt(0.5 * (p + std::sqrt(p * p + 24 * q)));
}

// ---- The grid.

// the summation cost for an initial shape grows with their square
constexpr double most_intervals = 1 << 17;

Grid grid_of(const Descriptor& d, const String& s, double intervals) {
    if (std::isnan(intervals))
        throw Refusal(std::string(d.name) +
                      ": its least stable spacing is no number at these options and this rate");
    if (!(intervals >= 5) || intervals != std::floor(intervals) || intervals > most_intervals)
        throw Refusal(std::string(d.name) + ": the grid has " + std::to_string(intervals) +
                      " intervals, expected a whole number from 5 to " +
                      std::to_string(static_cast<long>(most_intervals)));
    return {static_cast<int>(intervals), s.length / intervals};
}

double spacing_margin(const String& s, const Settings& settings, double limit) {
    const double intervals = number_option(settings, grid_option, 0);
    return intervals > 0 ? s.length / intervals / limit - 1
                         : std::numeric_limits<double>::quiet_NaN();
}

Grid grid_for(const Descriptor& d, const String& s, const Settings& settings, double limit) {
    const double finest = s.length / limit, most = std::floor(finest * (1 + 1e-12));
    const double over = number_option(settings, over_limit_option, 0),
                 chosen = number_option(settings, grid_option, 0);
    if (over != 0 && !(over > 1))
        throw Refusal("option over_limit: found " + std::to_string(over) +
                      ", expected a factor above 1");
    if (chosen > std::max(most, over * finest))
        throw Refusal(std::string(d.name) + ": " + std::to_string(chosen) +
                      " intervals are over the stability limit, " + std::to_string(most) + " at " +
                      std::to_string(settings.sample_rate) +
                      " Hz; option over_limit goes there on purpose");
    return grid_of(d, s, chosen != 0 ? chosen : over != 0 ? std::ceil(finest * over) : most);
}

// ---- A string of the scene on its grid.

namespace {
constexpr std::size_t most_contacts = 1 << 13;  // per string: half a gigabyte of compliances

// Solves K u = g/(mu dx) and compares with the series over the string's modes, with enough modes to
// leave out less than 1e-4.
double relative_compliance(const GridString& g, const String& s, const LumpedBarrier& b) {
    const Modes modes = modes_of(s, 20000);
    std::vector<double> u(g.grid.intervals + 1, 0.0);
    g.stencils.front().add(1 / g.mass, u.data());
    BandedFactor(g.grid, 0, -g.c2, g.kappa2).solve(u.data());
    const double own = g.stencils.front().read(u.data());
    return own / static_compliance(modes, footprint_weights(modes, b.position, b.width));
}

// Values at the nodes, from the modes that the grid can carry.
std::vector<double> at_nodes(const std::vector<double>& a, const Grid& g) {
    std::vector<double> u(g.intervals + 1, 0.0), sine(2 * g.intervals);
    for (int k = 0; k < 2 * g.intervals; ++k) sine[k] = std::sin(pi * k / g.intervals);
    for (int l = 1; l < g.intervals; ++l)
        for (long i = 1; i < g.intervals; ++i)
            if (a[i - 1] != 0) u[l] += a[i - 1] * sine[i * l % (2 * g.intervals)];
    return u;
}

Stencil stencil_of(const Grid& g, const Footprint& f) {
    Stencil s = footprint_stencil(g, f.position, f.width);
    for (double& w : s.weight) w *= f.sign;
    return s;
}

// Puts the compliance that the grid takes from the string in series (contact/compliance.hpp); the
// time steps take none under a steady force.
void put_in_series(GridString& g, const Descriptor& d, const Scene& scene, const String& s) {
    const Sites sites = sites_of(scene, footprints_of(s));
    const BandedFactor stiffness(g.grid, 0, -g.c2, g.kappa2);
    std::vector<std::vector<double>> shape;  // under 1 N from each force
    for (const Footprint& f : sites.forces) {
        shape.emplace_back(g.grid.intervals + 1, 0.0);
        stencil_of(g.grid, f).add(1 / g.mass, shape.back().data());
        stiffness.solve(shape.back().data());
    }
    std::vector<Stencil> reader;
    for (const Reading& r : sites.readings)
        reader.push_back(static_cast<int>(reader.size()) < sites.points() ? stencil_of(g.grid, r.at)
                         : r.nut_force ? nut_force_stencil(g.grid, s)
                                       : displacement_stencil(g.grid, r.at.position));
    g.points.series =
        missing_matrix(d.name, s, sites, scene.taps.size(), g.grid.intervals - 1, g.points.dt,
                       [&](int r, int f) { return reader[r].read(shape[f].data()); });
}

void put_on_body(GridString& g) {  // schemes/body/body_step.hpp
    g.on_body = true;
    for (int l = 1; l < g.grid.intervals; ++l)
        g.mu.weight.push_back(g.mass * (1 - static_cast<double>(l) / g.grid.intervals));
}
}  // namespace

GridString on_grid(const Descriptor& descriptor, const Scene& scene, const Settings& settings,
                   const Grid& grid, const LossFit& loss) {
    const double dt = 1 / settings.sample_rate;
    const bool matched = matched_without_loss(descriptor, scene, settings);
    const String s =
        matched ? with_profile_points(scene.strings.front(), settings) : scene.strings.front();
    GridString g;
    g.grid = grid;
    g.mass = s.linear_density * grid.dx;
    g.c2 = s.tension / s.linear_density;
    g.kappa2 = s.bending_stiffness / s.linear_density;
    g.loss = loss;
    const auto mode_of = [](const auto& shape) {
        return shape ? std::get_if<ModeShape>(&*shape) : nullptr;
    };
    for (const ModeShape* m : {mode_of(s.start), mode_of(s.velocity)})
        if (m && m->number >= grid.intervals)
            throw Refusal("the start is mode " + std::to_string(m->number) +
                          " and the grid carries " + std::to_string(grid.intervals - 1));
    const ModalStart start = start_of(modes_of(s, grid.intervals - 1), s);
    g.start = at_nodes(start.displacement, grid);
    g.start_velocity = at_nodes(start.velocity, grid);
    g.moves = needed_by(scene).has(Feature::initial_velocity);
    g.points = points_of(scene, dt);
    const auto lump = [&](const Footprint& f) {
        g.stencils.push_back(stencil_of(grid, f));
        g.narrowest =
            g.narrowest == 0 ? f.width / grid.dx : std::min(g.narrowest, f.width / grid.dx);
    };
    for (const Place& place : add_contacts(g.points, s, grid.intervals)) {
        if (place.node != 0) g.stencils.push_back({place.node, {1.0}});
        else lump(place.at);
    }
    if (g.stencils.size() > most_contacts)
        throw Refusal("the grid has " + std::to_string(g.stencils.size()) +
                      " points on the barriers, whose compliances on each other are kept; " +
                      std::to_string(most_contacts) +
                      " at most: a lower rate or option grid makes fewer");
    if (s.barriers.size() == 1)
        if (const auto* b = std::get_if<LumpedBarrier>(&s.barriers.front()))
            g.compliance = relative_compliance(g, s, *b);
    if (s.thread) {
        lump({s.thread->position, s.thread->width});
        g.points.positions.push_back(s.thread->position);
    }
    for (const Stencil& at : g.stencils)
        if (g.moves) g.points.start_velocity.push_back(at.read(g.start_velocity.data()));
    if (s.pluck) g.pluck_stencil = footprint_stencil(grid, s.pluck->position, s.pluck->width);
    for (const Tap& tap : scene.taps) {
        const bool of_a_point =
            tap.quantity == Quantity::displacement || tap.quantity == Quantity::velocity;
        GridTap t{tap.quantity, {}};
        if (of_a_point) t.stencil = displacement_stencil(grid, tap.position);
        if (tap.quantity == Quantity::nut_force) t.stencil = nut_force_stencil(grid, s);
        g.taps.push_back(t);
    }
    if (matched) put_in_series(g, descriptor, scene, s);
    if (needed_by(scene).has(Feature::moving_body)) put_on_body(g);
    return g;
}

// ---- Von Neumann relations.

namespace {
struct Symbols {
    // for -D2, for K = -c^2 D2 + kappa^2 D4, for R = 2 sigma0 - 2 sigma1 D2 + 2 sigma2 D4
    double lambda, stiffness, loss;
};
Symbols symbols(const GridString& g, int mode) {
    const double sine = std::sin(0.5 * pi * mode / g.grid.intervals) / (0.5 * g.grid.dx),
                 lambda = sine * sine;
    return {lambda, (g.c2 + g.kappa2 * lambda) * lambda, 2 * g.loss.at(lambda)};
}
}  // namespace

// (M + dt R/2) z^2 - (2M - dt^2 K) z + (M - dt R/2) = 0, for |z| and arg z
FreeMode three_point_mode(const GridString& g, double dt, double m, double m4, int mode) {
    const Symbols y = symbols(g, mode);
    const double M = 1 - (m - m4 * y.lambda) * y.lambda, over = M + 0.5 * dt * y.loss,
                 under = M - 0.5 * dt * y.loss;
    const double cosine = M - 0.5 * dt * dt * y.stiffness;  // both times |z|
    const double square =
        dt * dt *
        (y.stiffness * M - 0.25 * (dt * dt * y.stiffness * y.stiffness + y.loss * y.loss));
    return {std::atan2(std::sqrt(std::max(0.0, square)), cosine) / dt,
            -0.5 * std::log(under / over) / dt};
}

// z = (1 + p)/(1 - p), p = p_r + i p_i the scaled pole of y'' + R y' + K y = 0; without loss omega
// = 2/dt atan(sqrt(K) dt/2)
FreeMode midpoint_mode(const GridString& g, double dt, int mode) {
    const Symbols y = symbols(g, mode);
    const double real = -0.25 * dt * y.loss,
                 imaginary = std::sqrt(std::max(0.0, 0.25 * dt * dt * y.stiffness - real * real));
    const double omega = std::atan2(imaginary, 1 + real) + std::atan2(imaginary, 1 - real);
    const double size = std::log(((1 + real) * (1 + real) + imaginary * imaginary) /
                                 ((1 - real) * (1 - real) + imaginary * imaginary));
    return {omega / dt, -0.5 * size / dt};
}

// ---- The band matrix.

BandedFactor::BandedFactor(const Grid& g, double a0, double a2, double a4)
    : n_(g.intervals - 1), wide_(a4 != 0) {
    const double p = a2 / (g.dx * g.dx), q = a4 / (g.dx * g.dx * g.dx * g.dx);
    std::vector<double> D(n_);
    for (auto* v : {&one_, &two_, &inverse_}) v->assign(n_ + 1, 0.0);
    for (int i = 0; i < n_; ++i) {
        const double corner = i == 0 || i == n_ - 1 ? 5 : 6;  // D2 D2 with u_0 = u_N = 0
        double diagonal = a0 - 2 * p + corner * q, below = p - 4 * q;
        if (i > 1) {
            two_[i] = q / D[i - 2];
            diagonal -= two_[i] * two_[i] * D[i - 2];
            below -= two_[i] * one_[i - 1] * D[i - 2];
        }
        if (i > 0) {
            one_[i] = below / D[i - 1];
            diagonal -= one_[i] * one_[i] * D[i - 1];
        }
        if (!(diagonal > 0))
            throw Refusal("the implicit operator is not positive definite at this rate and grid");
        D[i] = diagonal;
        inverse_[i] = 1 / diagonal;
    }
}

void BandedFactor::solve(double* u) const noexcept {
    double* x = u + 1;
    const double *l1 = one_.data(), *l2 = two_.data(), *d = inverse_.data();
    if (wide_) {
        // l2[1] = l2[n] = 0: the ends are not seen
        for (int i = 1; i < n_; ++i) x[i] = (x[i] - l2[i] * x[i - 2]) - l1[i] * x[i - 1];
        for (int i = 0; i < n_; ++i) x[i] *= d[i];
        for (int i = n_ - 2; i >= 0; --i)
            x[i] = (x[i] - l2[i + 2] * x[i + 2]) - l1[i + 1] * x[i + 1];
    } else {
        for (int i = 1; i < n_; ++i) x[i] -= l1[i] * x[i - 1];
        for (int i = 0; i < n_; ++i) x[i] *= d[i];
        for (int i = n_ - 2; i >= 0; --i) x[i] -= l1[i + 1] * x[i + 1];
    }
}

Stencil BandedFactor::solve(const Stencil& s) const {
    std::vector<double> u(n_ + 2, 0.0);
    s.add(1, u.data());
    solve(u.data());
    double largest = 0;
    for (double v : u) largest = std::max(largest, std::abs(v));
    for (double& v : u)
        if (std::abs(v) < 1e-19 * largest) v = 0;
    return trimmed(0, u);
}

}  // namespace jvari

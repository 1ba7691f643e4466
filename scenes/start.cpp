#include "scenes/start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/barrier.hpp"
#include "scenes/excitation.hpp"

namespace jvari {

using std::numbers::pi;

namespace {
// A point at z: e(z) + C F(z) = height. Where z > 0 it presses, and z is its penetration, of a
// rigid one C F(z).
struct AtRest {
    double e, e_slope, F, F_slope;
};
AtRest at_rest(const RestingPoint& p, double own, double z) {
    if (p.both_ways) return {z, 1, p.stiffness * z, p.stiffness};
    if (z <= 0) return {z, 1, 0, 0};
    if (p.stiffness == rigid) return {0, 0, z / own, 1 / own};
    const double slope = p.stiffness * std::pow(z, p.exponent - 1);
    return {z, 1, slope * z, p.exponent * slope};
}

// A x = b by elimination with pivots; x in b. False where A is singular.
bool solve(std::vector<double> A, std::vector<double>& b) {
    const std::size_t n = b.size();
    for (std::size_t c = 0; c < n; ++c) {
        std::size_t top = c;
        for (std::size_t r = c + 1; r < n; ++r)
            if (std::abs(A[r * n + c]) > std::abs(A[top * n + c])) top = r;
        if (A[top * n + c] == 0) return false;
        std::swap(b[c], b[top]);
        std::swap_ranges(&A[c * n], &A[c * n] + n, &A[top * n]);
        for (std::size_t r = c + 1; r < n; ++r) {
            const double factor = A[r * n + c] / A[c * n + c];
            for (std::size_t j = c; factor != 0 && j < n; ++j)
                A[r * n + j] -= factor * A[c * n + j];
            b[r] -= factor * b[c];
        }
    }
    for (std::size_t r = n; r-- > 0; b[r] /= A[r * n + r])
        for (std::size_t j = r + 1; j < n; ++j) b[r] -= A[r * n + j] * b[j];
    return true;
}

// The sine series of straight lines through (x, y) and both ends of the string: each corner, where
// the slope changes by -d, adds 2 d sin(beta x)/(L beta^2).
std::vector<double> series_of_lines(const Modes& modes, double length, const std::vector<double>& x,
                                    const std::vector<double>& y) {
    std::vector<double> q(modes.beta.size(), 0.0);
    const auto slope = [&](std::size_t k) {  // before row k
        const double x0 = k > 0 ? x[k - 1] : 0, y0 = k > 0 ? y[k - 1] : 0,
                     x1 = k < x.size() ? x[k] : length, y1 = k < x.size() ? y[k] : 0;
        return x1 > x0 ? (y1 - y0) / (x1 - x0) : 0;
    };
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double d = slope(k) - slope(k + 1);
        for (std::size_t i = 0; d != 0 && i < q.size(); ++i)
            q[i] +=
                2 * d * std::sin(modes.beta[i] * x[k]) / (length * modes.beta[i] * modes.beta[i]);
    }
    return q;
}

std::vector<double> series_of(const Modes& modes, const String& s, const TableStart& t,
                              const std::vector<double>& y) {
    if (!t.of_modes) return series_of_lines(modes, s.length, t.at, y);
    std::vector<double> q(modes.beta.size(), 0.0);
    for (std::size_t k = 0; k < t.at.size(); ++k)
        if (t.at[k] <= modes.count()) q[static_cast<std::size_t>(t.at[k]) - 1] = y[k];
    return q;
}

std::vector<double> series_of(const Modes& modes, const String& s, const Shape& shape) {
    std::vector<double> q(modes.beta.size(), 0.0);
    if (const auto* m = std::get_if<ModeShape>(&shape)) {
        if (m->number <= modes.count()) q[m->number - 1] = m->amplitude;
        return q;
    }
    for (int i = 1; i <= modes.count(); ++i)
        q[i - 1] = coefficient(std::get<TriangleShape>(shape), s.length, i);
    return q;
}

void rest(const Modes& modes, const String& s, const Yield& yield, ModalStart& start) {
    constexpr int parts = 32;
    std::vector<RestingPoint> points;
    std::vector<std::vector<double>> g;
    const auto add = [&](const LumpedBarrier& b) {
        points.push_back({b.stiffness.k, b.exponent, b.height});
        g.push_back(footprint_weights(modes, b.position, b.width));
    };
    for (const Barrier& barrier : s.barriers) {
        if (const auto* b = std::get_if<LumpedBarrier>(&barrier)) add(*b);
        else {
            const auto& profile = std::get<ProfileBarrier>(barrier);
            for (const LumpedBarrier& part :
                 lumped(profile, middles(profile, parts), (profile.to - profile.from) / parts))
                add(part);
        }
    }
    if (const auto& t = s.thread) {
        points.push_back({t->stiffness, 1, t->height, true});
        g.push_back(footprint_weights(modes, t->position, t->width));
    }
    const double F_e = s.pluck ? force(*s.pluck, 0) : 0;
    std::vector<double> load(modes.beta.size(), 0.0), own = load, C;
    if (F_e != 0) load = footprint_weights(modes, s.pluck->position, s.pluck->width);
    for (std::size_t i = 0; i < load.size(); ++i) {
        load[i] *= F_e;
        own[i] = yield.modes.empty() ? 1 / (modes.mass * modes.omega0[i] * modes.omega0[i])
                                     : yield.modes[i];
    }
    const auto reading = [&](const std::vector<double>& weights, const std::vector<double>& push) {
        double sum = 0;
        for (std::size_t i = 0; i < own.size(); ++i) sum += own[i] * weights[i] * push[i];
        return sum;
    };
    for (std::size_t p = 0; p < g.size(); ++p) {
        points[p].height -= reading(g[p], load) + (yield.pluck.empty() ? 0 : yield.pluck[p] * F_e);
        for (std::size_t q = 0; q < g.size(); ++q)
            C.push_back(reading(g[p], g[q]) +
                        (yield.series.empty() ? 0 : yield.series[p * g.size() + q]));
    }
    start.force = resting_forces(points, C);
    if (start.force.size() != points.size())
        throw BadScene("string.0.start", "\"rest\"",
                       "an equilibrium that Newton's steps find; give barriers a stiffness and the "
                       "string more modes");
    for (std::size_t p = 0; p < g.size(); ++p)
        for (std::size_t i = 0; i < load.size(); ++i) load[i] += g[p][i] * start.force[p];
    for (std::size_t i = 0; i < load.size(); ++i) start.displacement[i] = own[i] * load[i];
}
}  // namespace

std::vector<double> resting_forces(std::span<const RestingPoint> points,
                                   std::span<const double> C) {
    constexpr int most_steps = 200, most_halvings = 40;
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const std::size_t n = points.size();
    std::vector<double> z(n), F(n), G(n), tried(n);
    // G(z), and whether all of it is rounding; its largest
    const auto residual = [&](const std::vector<double>& at, bool& ends) {
        double most = 0;
        for (std::size_t p = 0; p < n; ++p) F[p] = at_rest(points[p], C[p * n + p], at[p]).F;
        ends = true;
        for (std::size_t p = 0; p < n; ++p) {
            double size = std::abs(points[p].height);
            G[p] = at_rest(points[p], C[p * n + p], at[p]).e - points[p].height;
            for (std::size_t q = 0; q < n; ++q) {
                G[p] += C[p * n + q] * F[q];
                size += std::abs(C[p * n + q] * F[q]);
            }
            ends = ends && std::abs(G[p]) <= rounding * size;
            most = std::max(most, std::abs(G[p]));
        }
        return most;
    };
    double largest = 0;
    for (std::size_t p = 0; p < n; ++p)
        z[p] = points[p].height, largest = std::max(largest, std::abs(z[p]));
    bool ends = false;
    double before = residual(z, ends);
    for (int step = 0; step < most_steps && !ends; ++step) {
        std::vector<double> A(n * n), dz = G;
        for (std::size_t p = 0; p < n; ++p)
            for (std::size_t q = 0; q < n; ++q)
                A[p * n + q] = C[p * n + q] * at_rest(points[q], C[q * n + q], z[q]).F_slope +
                               (p == q ? at_rest(points[p], C[p * n + p], z[p]).e_slope : 0);
        if (!std::isfinite(before) || !solve(std::move(A), dz)) return {};
        double share = 1, after = 0;
        for (int k = 0;; ++k, share *= 0.5) {
            for (std::size_t p = 0; p < n; ++p) tried[p] = z[p] - share * dz[p];
            after = residual(tried, ends);
            if (ends || after < before || k == most_halvings) break;
        }
        // no smaller: what is left is rounding
        if (!ends && !(after < before) && !(ends = after <= 1e-14 * largest)) return {};
        z = tried;
        before = after;
    }
    return ends ? F : std::vector<double>();
}

ModalStart start_of(const Modes& modes, const String& s, const Yield& yield) {
    const std::vector<double> zeros(modes.beta.size(), 0.0);
    ModalStart start{zeros, zeros, {}};
    if (s.velocity) start.velocity = series_of(modes, s, *s.velocity);
    if (!s.start) return start;
    if (const auto* t = std::get_if<TableStart>(&*s.start)) {
        start.displacement = series_of(modes, s, *t, t->displacement);
        const std::vector<double> v = series_of(modes, s, *t, t->velocity);
        for (std::size_t i = 0; i < v.size(); ++i) start.velocity[i] += v[i];
    } else if (const auto* m = std::get_if<ModeShape>(&*s.start)) {
        start.displacement = series_of(modes, s, Shape(*m));
    } else if (const auto* triangle = std::get_if<TriangleShape>(&*s.start)) {
        start.displacement = series_of(modes, s, Shape(*triangle));
    } else rest(modes, s, yield, start);
    return start;
}

double displacement_at(const TableStart& t, double length, double x) {
    if (t.of_modes) {
        double sum = 0;
        for (std::size_t k = 0; k < t.at.size(); ++k)
            sum += t.displacement[k] * std::sin(t.at[k] * pi * x / length);
        return sum;
    }
    const auto k =
        static_cast<std::size_t>(std::upper_bound(t.at.begin(), t.at.end(), x) - t.at.begin());
    const double x0 = k > 0 ? t.at[k - 1] : 0, y0 = k > 0 ? t.displacement[k - 1] : 0,
                 x1 = k < t.at.size() ? t.at[k] : length,
                 y1 = k < t.at.size() ? t.displacement[k] : 0;
    return x1 > x0 ? y0 + (y1 - y0) * (x - x0) / (x1 - x0) : y0;
}

double largest_displacement(const String& s) {
    if (!s.start) return 0;
    if (const auto* m = std::get_if<ModeShape>(&*s.start)) return std::abs(m->amplitude);
    if (const auto* t = std::get_if<TriangleShape>(&*s.start)) return std::abs(t->amplitude);
    const auto* table = std::get_if<TableStart>(&*s.start);
    double largest = 0;
    for (int k = 0; table && k <= 256; ++k)
        largest =
            std::max(largest, std::abs(displacement_at(*table, s.length, s.length * k / 256)));
    for (std::size_t k = 0; table && !table->of_modes && k < table->at.size(); ++k)
        largest = std::max(largest, std::abs(table->displacement[k]));
    return largest;
}

String scaled(String s, double factor) {
    const auto scale = [factor](auto& shape) { shape.amplitude *= factor; };
    if (s.velocity) std::visit(scale, *s.velocity);
    if (s.pluck) s.pluck->amplitude *= factor;
    if (!s.start) return s;
    if (auto* m = std::get_if<ModeShape>(&*s.start)) scale(*m);
    if (auto* t = std::get_if<TriangleShape>(&*s.start)) scale(*t);
    if (auto* t = std::get_if<TableStart>(&*s.start))
        for (auto* column : {&t->displacement, &t->velocity})
            for (double& x : *column) x *= factor;
    return s;
}

}  // namespace jvari

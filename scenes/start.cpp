#include "scenes/start.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/barrier.hpp"
#include "scenes/columns.hpp"
#include "scenes/excitation.hpp"
#include "scenes/scene_file.hpp"

namespace jvari {

using std::numbers::pi;

namespace {
// A point at z: e(z) + C F(z) = height. If z > 0 the point presses, and z is its penetration; for a
// rigid point z is C F(z).
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

// A x = b by elimination; x in b. A is E + C D, D >= 0 diagonal and C symmetric and positive, so
// that pivots on the diagonal hold.
void solve(std::vector<double> A, std::vector<double>& b) {
    const std::size_t n = b.size();
    for (std::size_t c = 0; c < n; ++c)
        for (std::size_t r = c + 1; r < n; ++r) {
            const double factor = A[r * n + c] / A[c * n + c];
            for (std::size_t j = c; j < n; ++j) A[r * n + j] -= factor * A[c * n + j];
            b[r] -= factor * b[c];
        }
    for (std::size_t r = n; r-- > 0; b[r] /= A[r * n + r])
        for (std::size_t j = r + 1; j < n; ++j) b[r] -= A[r * n + j] * b[j];
}

struct Lines {  // including both ends of the string
    std::vector<double> x, y;
    Lines(const TableStart& t, const std::vector<double>& column, double length) : x{0}, y{0} {
        x.insert(x.end(), t.at.begin(), t.at.end());
        y.insert(y.end(), column.begin(), column.end());
        x.push_back(length), y.push_back(0);
    }
    double slope(std::size_t k) const {  // before row k
        return x[k] > x[k - 1] ? (y[k] - y[k - 1]) / (x[k] - x[k - 1]) : 0;
    }
};

struct SeriesOf {
    const Modes& modes;
    const String& s;
    std::vector<double> operator()(const ModeShape& m) const {
        std::vector<double> q(modes.beta.size(), 0.0);
        if (m.number <= modes.count()) q[m.number - 1] = m.amplitude;
        return q;
    }
    std::vector<double> operator()(const TriangleShape& t) const {
        std::vector<double> q;
        for (int i = 1; i <= modes.count(); ++i) q.push_back(coefficient(t, s.length, i));
        return q;
    }
    std::vector<double> operator()(const TableStart& t) const { return of(t, t.displacement); }
    std::vector<double> operator()(const RestStart&) const { return (*this)(ModeShape{}); }
    std::vector<double> of(const TableStart& t, const std::vector<double>& y) const {
        std::vector<double> q(modes.beta.size(), 0.0);
        for (std::size_t k = 0; t.of_modes && k < t.at.size(); ++k)
            if (t.at[k] <= modes.count()) q[static_cast<std::size_t>(t.at[k]) - 1] = y[k];
        if (t.of_modes) return q;
        // each corner, with a slope change of -d, adds 2 d sin(beta x)/(L beta^2)
        const Lines lines(t, y, s.length);
        for (std::size_t k = 1; k + 1 < lines.x.size(); ++k)
            for (std::size_t i = 0; i < q.size(); ++i)
                q[i] += 2 * (lines.slope(k) - lines.slope(k + 1)) *
                        std::sin(modes.beta[i] * lines.x[k]) /
                        (s.length * modes.beta[i] * modes.beta[i]);
        return q;
    }
};

void rest(const Modes& modes, const String& s, const Yield& yield, ModalStart& start) {
    constexpr int parts = 32;
    std::vector<RestingPoint> points;
    std::vector<std::vector<double>> g;
    const auto add = [&](const LumpedBarrier& b) {
        points.push_back({b.stiffness.k, b.exponent, b.sign() * b.height});
        g.push_back(contact_weights(modes, b));
    };
    for (const Barrier& b :
         without_profiles(s, [](const ProfileBarrier& p) { return lumped(p, parts); }))
        add(std::get<LumpedBarrier>(b));
    for (const Mass& m : s.masses) add({m.position, m.width, 0, {}});  // free: they give way
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

// Newton's steps, shortened until the residual falls, down to rounding.
std::vector<double> resting_forces(std::span<const RestingPoint> points,
                                   std::span<const double> C) {
    constexpr int most_steps = 200;
    constexpr double shortest = 1e-9, rounding = 1e-12;
    const std::size_t n = points.size();
    std::vector<double> z, F(n), G(n);
    const auto at = [&](std::size_t p, const std::vector<double>& x) {
        return at_rest(points[p], C[p * n + p], x[p]);
    };
    const auto residual = [&](const std::vector<double>& x) {  // the largest G(x)
        double most = 0;
        for (std::size_t p = 0; p < n; ++p) F[p] = at(p, x).F;
        for (std::size_t p = 0; p < n; ++p) {
            G[p] = at(p, x).e - points[p].height;
            for (std::size_t q = 0; q < n; ++q) G[p] += C[p * n + q] * F[q];
            most = std::max(most, std::abs(G[p]));
        }
        return most;
    };
    double largest = 0;
    for (const RestingPoint& p : points)
        z.push_back(p.height), largest = std::max(largest, std::abs(p.height));
    double left = residual(z);
    for (int step = 0; step < most_steps && left > 0; ++step) {
        std::vector<double> A(n * n), dz = G, tried = z;
        for (std::size_t k = 0; k < n * n; ++k)
            A[k] = C[k] * at(k % n, z).F_slope + (k % (n + 1) == 0 ? at(k % n, z).e_slope : 0);
        solve(std::move(A), dz);
        double share = 1, now = left;
        for (; share > shortest && !(now < left); share *= 0.5) {
            for (std::size_t p = 0; p < n; ++p) tried[p] = z[p] - share * dz[p];
            now = residual(tried);
        }
        if (!(now < left)) break;
        z = tried;
        left = now;
    }
    residual(z);
    return left <= rounding * largest ? F : std::vector<double>();
}

TableStart start_from(const std::string& path, const std::string& text) {
    TableStart t;
    std::vector<double> x, mode;
    const ColumnTo columns[] = {
        {{"x_m", "x_m", any, x_spellings}, &x, true},
        {{"mode", "mode", mode_number}, &mode, true},
        {{"displacement_m", "displacement", any, displacement_spellings}, &t.displacement},
        {{"velocity_m_per_s", "velocity", any}, &t.velocity, true},
    };
    read_columns(path, text, columns);
    if (x.empty() == mode.empty())
        throw SceneFileError(
            path + ": found " +
            (x.empty() ? "no rows of \"x_m\" or \"mode\"" : "\"x_m\" and \"mode\"") +
            ", expected rows of one of the columns \"x_m\" and \"mode\"");
    t.of_modes = x.empty();
    t.at = t.of_modes ? mode : x;
    if (t.velocity.empty()) t.velocity.assign(t.at.size(), 0.0);
    constexpr std::string_view state = "# state of ";
    if (text.starts_with(state))
        t.state_of = text.substr(state.size(), text.find('\n') - state.size());
    return t;
}

ModalStart start_of(const Modes& modes, const String& s, const Yield& yield) {
    const SeriesOf series{modes, s};
    ModalStart start{std::visit(series, s.start.value_or(ModeShape{})),
                     std::visit(series, s.velocity.value_or(ModeShape{})),
                     {}};
    const auto* table = s.start ? std::get_if<TableStart>(&*s.start) : nullptr;
    const std::vector<double> v =
        table ? series.of(*table, table->velocity) : std::vector<double>();
    for (std::size_t i = 0; i < v.size(); ++i) start.velocity[i] += v[i];
    if (s.start && std::holds_alternative<RestStart>(*s.start)) rest(modes, s, yield, start);
    return start;
}

double displacement_at(const TableStart& t, double length, double x) {
    double sum = 0;
    for (std::size_t k = 0; t.of_modes && k < t.at.size(); ++k)
        sum += t.displacement[k] * std::sin(t.at[k] * pi * x / length);
    if (t.of_modes) return sum;
    const Lines lines(t, t.displacement, length);
    const auto next = std::upper_bound(lines.x.begin() + 1, lines.x.end() - 1, x);
    const auto k = static_cast<std::size_t>(next - lines.x.begin());
    return lines.y[k - 1] + lines.slope(k) * (x - lines.x[k - 1]);
}

std::optional<double> force_of_a_corner(const Scene& scene, const Tap& tap) {
    if (tap.quantity != Quantity::nut_force) return {};
    double force = 0;
    bool corner = false;
    for (std::size_t k = 0; k < scene.strings.size(); ++k) {
        const String& s = scene.strings[k];
        if (!s.start || (tap.string && static_cast<int>(k) != *tap.string)) continue;
        bool sharp = false;
        if (const auto* m = std::get_if<ModeShape>(&*s.start)) {
            const double beta = m->number * pi / s.length;
            force += (m->number % 2 == 1 ? 1 : -1) * m->amplitude * beta *
                     (s.tension + s.bending_stiffness * beta * beta);
        } else if (const auto* t = std::get_if<TriangleShape>(&*s.start)) {
            force += s.tension * t->amplitude / (s.length - t->position);
            sharp = t->smoothing == 0 && t->amplitude != 0;
        } else if (const auto* rows = std::get_if<TableStart>(&*s.start); rows && !rows->of_modes) {
            const Lines lines(*rows, rows->displacement, s.length);
            std::size_t last = lines.x.size() - 1;  // behind it the end itself may be a row
            while (last > 1 && !(lines.x[last] > lines.x[last - 1])) --last;
            force -= s.tension * lines.slope(last);
            sharp = true;
        } else {
            return {};
        }
        if (s.axial_stiffness > 0) return {};
        corner = corner || (sharp && s.bending_stiffness > 0);
    }
    return corner ? std::optional(force) : std::nullopt;
}

double largest_displacement(const String& s) {
    double largest = 0;
    const auto* table = s.start ? std::get_if<TableStart>(&*s.start) : nullptr;
    for (int k = 0; table && k <= 1024; ++k)
        largest =
            std::max(largest, std::abs(displacement_at(*table, s.length, s.length * k / 1024)));
    const auto shape = [&](const auto& x) {
        if constexpr (requires { x.amplitude; }) largest = std::abs(x.amplitude);
    };
    if (s.start) std::visit(shape, *s.start);
    return largest;
}

String scaled(String s, double factor) {
    const auto scale = [factor](auto& x) {
        if constexpr (requires { x.amplitude; }) x.amplitude *= factor;
        if constexpr (requires { x.of_modes; })
            for (auto* column : {&x.displacement, &x.velocity})
                for (double& value : *column) value *= factor;
    };
    if (s.velocity) std::visit(scale, *s.velocity);
    if (s.pluck) scale(*s.pluck);
    if (s.start) std::visit(scale, *s.start);
    return s;
}

}  // namespace jvari

// exact_contact against a brute-force scan in long double, on random problems of one contact: few
// modes, any stiffness, damping and start, with and without a thread, and in half of them a barrier
// that the free string only just reaches or misses. usage: contact_scan COUNT [SEED]
//
// The scan knows two linear systems, apart and touching. It steps through each by its matrix
// exponential, a small fraction of its fastest period at a time, looks into every step whose ends
// show a turning point, and refines each crossing. The two must agree in the number of events,
// unless the scan saw the string come as near to its barrier as the bound that exact_contact states
// for itself. Two turning points within one step escape the scan: where the two differ it steps
// twenty times finer.
#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "reference/references.hpp"
#include "scenes/modes.hpp"
#include "scenes/start.hpp"
#include "schemes/run.hpp"

namespace {
using namespace jvari;
using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

struct Regime {  // x' = A (x - centre), x = (y, v)
    Matrix A, step;
    Vector centre;
    Real length;  // of the step [s]
    Vector after(const Vector& x, Real t) const {
        Vector sum = x, term = x - centre;
        for (int n = 1; n < 40; ++n) {
            term = (A * term * (t / n)).eval();
            sum += term;
            if (term.norm() < 1e-21L * sum.norm()) break;
        }
        return sum;
    }
};

Regime regime(const Modes& m, const std::vector<double>& g, Real k, Real height,
              const std::vector<double>& c, const Thread& thread, Real fraction = 0.4L) {
    const int M = m.count();
    Regime r{Matrix::Zero(2 * M, 2 * M), {}, Vector::Zero(2 * M), 0};
    Vector pull = Vector::Zero(M);
    for (int i = 0; i < M; ++i) {
        r.A(i, M + i) = 1;
        r.A(M + i, i) = -static_cast<Real>(m.omega0[i]) * m.omega0[i];
        r.A(M + i, M + i) = -2 * static_cast<Real>(m.sigma[i]);
        pull(i) = (k * g[i] * height + static_cast<Real>(thread.stiffness) * c[i] * thread.height) /
                  m.mass;
        for (int j = 0; j < M; ++j) {
            r.A(M + i, j) -=
                (k * g[i] * g[j] + static_cast<Real>(thread.stiffness) * c[i] * c[j]) / m.mass;
            r.A(M + i, M + j) -= static_cast<Real>(thread.damping) * c[i] * c[j] / m.mass;
        }
    }
    r.centre.head(M) = -Matrix(r.A.bottomLeftCorner(M, M)).partialPivLu().solve(pull);
    Real rate = 0, stiffest = 0;
    for (int i = 0; i < M; ++i)
        rate += r.A.bottomRightCorner(M, M).row(i).cwiseAbs().sum(), stiffest += -r.A(M + i, i);
    r.length = fraction / std::max(rate, std::sqrt(stiffest));
    r.step = Matrix::Identity(2 * M, 2 * M);
    Matrix term = r.step;
    for (int n = 1; n < 40; ++n) {
        term = (term * r.A * (r.length / n)).eval();
        r.step += term;
    }
    return r;
}

struct Seen {
    int events = 0;
    Real nearest = HUGE_VALL;  // least |gap| where it turned, on either side [m]
};

// Where f changes its sign between a and b, by the Illinois rule.
template <class F>
Real root(Real a, Real b, Real fa, Real fb, F&& f) {
    for (int i = 0; i < 100; ++i) {
        Real c = fb == fa ? (a + b) / 2 : b - fb * (b - a) / (fb - fa);
        if (!(c > std::min(a, b) && c < std::max(a, b))) c = (a + b) / 2;
        const Real fc = f(c);
        if (fc == 0 || std::abs(c - b) < 1e-18L * std::abs(b)) return c;
        if ((fc < 0) != (fb < 0)) a = b, fa = fb;
        else fa /= 2;
        b = c, fb = fc;
    }
    return b;
}

Seen scan(const Regime& apart, const Regime& touching, const std::vector<double>& g, Real height,
          Vector x, Real duration) {
    const int M = static_cast<int>(g.size());
    Seen seen;
    int in = 0;
    const auto reading = [&](const Vector& z, int from) {
        Real v = 0;
        for (int i = 0; i < M; ++i) v += g[i] * z(from + i);
        return v;
    };
    const auto gap = [&](const Vector& z) { return (in ? -1 : 1) * (reading(z, 0) - height); };
    const auto slope = [&](const Vector& z) { return (in ? -1 : 1) * reading(z, M); };
    in = reading(x, 0) < height;
    seen.events = in;
    Real largest = 0;  // gap since the last event
    for (Real t = 0; t < duration;) {
        const Regime& now = in ? touching : apart;
        const Real dt = std::min(now.length, duration - t);
        const Vector next =
            dt == now.length ? Vector(now.centre + now.step * (x - now.centre)) : now.after(x, dt);
        Real high = gap(next) < 0 ? dt : -1;
        if (high < 0 && slope(x) < 0 && slope(next) > 0) {  // it turned inside
            const Real turn =
                root(0, dt, slope(x), slope(next), [&](Real c) { return slope(now.after(x, c)); });
            const Real least = gap(now.after(x, turn));
            seen.nearest = std::min(seen.nearest, std::abs(least));
            if (least < 0) high = turn;
        }
        if (high < 0) {
            largest = std::max(largest, gap(next));
            x = next;
            t += dt;
            continue;
        }
        Real low = 0;
        if (!(gap(x) > 0))  // it starts on the surface
            for (low = high / 2; low > 1e-12L * high && !(gap(now.after(x, low)) > 0);) low /= 2;
        high = root(low, high, gap(now.after(x, low)), gap(now.after(x, high)),
                    [&](Real c) { return gap(now.after(x, c)); });
        if (slope(x) > 0) {
            const Real turn = root(low, high, slope(x), slope(now.after(x, high)),
                                   [&](Real c) { return slope(now.after(x, c)); });
            largest = std::max(largest, gap(now.after(x, turn)));
        }
        seen.nearest = std::min(seen.nearest, std::max(largest, gap(x)));
        largest = 0;
        x = now.after(x, high);
        t += high;
        in = !in;
        ++seen.events;
        const Real off = reading(x, 0) - height;  // onto the surface
        Real square = 0;
        for (double w : g) square += static_cast<Real>(w) * w;
        for (int i = 0; i < M; ++i) x(i) -= off * g[i] / square;
    }
    return seen;
}
}  // namespace

int main(int count_of_arguments, char** arguments) {
    const long count = count_of_arguments > 1 ? std::atol(arguments[1]) : 1000;
    std::mt19937_64 random(count_of_arguments > 2 ? std::atol(arguments[2]) : 1);
    const auto uniform = [&](double from, double to) {
        return from + (to - from) * std::uniform_real_distribution<double>()(random);
    };
    long events = 0, touched = 0, within_bound = 0, missed = 0, failed = 0, finer = 0;
    for (long trial = 0; trial < count; ++trial) {
        String s;
        s.length = 1;
        s.linear_density = std::pow(10, uniform(-3.5, -2));
        s.tension = uniform(20, 200);
        s.bending_stiffness = std::pow(10, uniform(-6, -3));
        s.damping =
            PolynomialDamping{std::pow(10, uniform(-2, 2)), std::pow(10, uniform(-4, -1)), 0};
        const int M = 1 + static_cast<int>(random() % 5);
        s.start = TriangleShape{uniform(0.1, 0.9), uniform(0.5e-3, 3e-3), 0.02};
        if (random() % 2)
            s.thread =
                Thread{uniform(0.02, 0.2), 1e-3, std::pow(10, uniform(1, 5)), uniform(0, 2), 0};
        LumpedBarrier b;
        b.position = uniform(0.01, 0.5);
        b.stiffness.k = std::pow(10, uniform(3, 10));
        const Modes m = modes_of(s, M);
        const auto g = footprint_weights(m, b.position, 0), y = start_of(m, s).displacement;
        const Thread thread = s.thread.value_or(Thread{0.1, 1e-3, 0, 0, 0});
        const auto c = footprint_weights(m, thread.position, thread.width);
        const double first = m.omega0[0] / (2 * M_PI),
                     duration = std::ceil(uniform(0.3, 1.5) / first * 4000) / 4000;
        Vector x = Vector::Zero(2 * M);
        double reach = 0;
        for (int i = 0; i < M; ++i) x(i) = y[i], reach += std::abs(g[i] * y[i]);
        const Regime apart = regime(m, g, 0, 0, c, thread);
        b.height = -uniform(0, 0.8) * reach;
        if (random() % 2) {  // graze: the height that the free string turns at
            const Seen free = scan(apart, apart, g, -2 * reach, x, duration);
            if (free.nearest < 2 * reach)
                b.height = static_cast<double>(free.nearest) - 2 * reach +
                           (random() % 2 ? 1 : -1) * reach * std::pow(10, uniform(-17, -3));
        }
        s.barriers = {b};
        const auto scanned = [&](Real fraction) {  // one row beyond the end, as the run does
            return scan(regime(m, g, 0, 0, c, thread, fraction),
                        regime(m, g, b.stiffness.k, b.height, c, thread, fraction), g, b.height, x,
                        duration + 1.0L / 4000);
        };
        Seen seen = scanned(0.4L);

        Scene scene;
        scene.name = "random";
        scene.duration = duration;
        scene.strings = {s};
        scene.taps = {{"y", Quantity::displacement, 0, 0.5}};
        const jvari::Run r = run(exact_contact, scene, {0, 4000, M, {{"tolerance", "1e-12"}}});
        double found = 0, bound = 0;
        for (const Fact& f : r.facts) {
            if (f.name == "events") found = f.value;
            if (f.name == "detection_tolerance") bound = f.value;
        }
        failed += r.status.outcome != Outcome::ok;
        events += seen.events;
        touched += seen.events > 0;
        if (found != seen.events && seen.nearest > bound) {
            seen = scanned(0.02L);
            ++finer;
        }
        if (found != seen.events) {
            const bool near = seen.nearest <= bound;
            (near ? within_bound : missed) += 1;
            if (!near) {
                std::printf(
                    "trial %ld: %g events for %d, nearest %.2Le m, bound %.1e m, k %.1e, %d "
                    "modes%s\n",
                    trial, found, seen.events, seen.nearest, bound, b.stiffness.k, M,
                    s.thread ? ", thread" : "");
            }
        }
    }
    std::printf(
        "%ld problems, %ld with contact, %ld events; counts differ within the bound in %ld, beyond "
        "it in %ld; %ld scanned finer; %ld runs "
        "failed\n",
        count, touched, events, within_bound, missed, finer, failed);
    return missed > 0 || failed > 0;
}

// modal_spatial_newton against the modal recursion with synthesis at the nodes of the obstacle, in
// plain Eigen with the same contact solver: 1001 modes, 1 MHz, the point bridge and the 19 mm
// parabola of Issanchou et al. 2016. The time is per step over 20 ms from the release; contact
// begins after 1.3 ms. Counter `error`: relative L2 distance of the displacement at x = 10 mm over
// the first 4 ms from the plain form in long double: later the parabola has multiplied any rounding
// beyond use.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "scenes/modes.hpp"
#include "scenes/start.hpp"
#include "schemes/contact/contact.hpp"
#include "schemes/run.hpp"

namespace jvari {

extern const Descriptor modal_spatial_newton;

namespace {

constexpr int N = 1002, M = N - 1;
constexpr double rate = 1e6, dt = 1 / rate, tap_rate = 20e3;

Scene scene_of(bool parabola) {
    String s;
    s.length = 1.002;
    s.linear_density = 1.17e-3;
    s.tension = 180.5;
    s.bending_stiffness = 3.2683823738748857e-4;
    s.damping = QualityFactorDamping{0.43e-3, 1.8e-5, 1.2, 0.0045, 0.000203};
    s.start = TriangleShape{0.501, 1.8e-3, 0.02};
    if (parabola)
        s.barriers.push_back(ProfileBarrier{ParabolaCurve{0.0065}, 0, 19e-3, {1e13}, 1.3, 0});
    else s.barriers.push_back(LumpedBarrier{6e-3, 0, 0, {1e10}, 1.3, 0});
    Scene scene;
    scene.name = "benchmark";
    scene.strings.push_back(s);
    scene.taps = {{"y10mm", Quantity::displacement, 0, 0.01}};
    return scene;
}

// The obstacle of the scenes above on the grid.
struct Grid {
    std::vector<int> node;
    std::vector<double> height;
    ContactLaw law{1e10, 1.3};  // K dx
    explicit Grid(bool parabola) {
        if (!parabola) {
            node = {6};
            height = {0.0};
            return;
        }
        for (int i = 1; i <= 19; ++i) {
            node.push_back(i);
            height.push_back(-0.0065 * (i * 1e-3) * (i * 1e-3));
        }
    }
    int count() const { return static_cast<int>(node.size()); }
};

template <class Real>
using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
template <class Real>
using Table = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

template <class Real>
struct Coefficients {
    Column<Real> C, Ct, y0, y1;
    Real gain, theta;
    explicit Coefficients(const String& s) : C(M), Ct(M), y0(M), y1(M) {
        const Modes m = modes_of(s, M);
        const auto start = start_of(m, s).displacement;
        for (int j = 0; j < M; ++j) {
            const Real sigma = m.sigma[j], square = Real(m.omega0[j]) * m.omega0[j] - sigma * sigma,
                       e = std::exp(-sigma * Real(dt));
            const Real omega = std::sqrt(std::abs(square)), a = omega * Real(dt);
            const Real c = square > 0 ? std::cos(a) : std::cosh(a),
                       q = square > 0 ? std::sin(a) : std::sinh(a);
            C[j] = 2 * e * c;
            Ct[j] = e * e;
            y0[j] = start[j];
            y1[j] = start[j] * e * (c + sigma / omega * q);
        }
        gain = Real(dt) * dt / m.mass;
        theta = gain * N / 2;
    }
};

// r + b = theta [V(eta) - V(eta - r)]/r in long double: the double solution, refined by Newton.
long double force_of(const ContactLaw& law, long double eta, long double b, long double theta) {
    if (eta <= 0 && eta + b <= 0) return 0;
    const auto V = [&](long double e) {
        return e > 0 ? law.k * std::pow(e, law.alpha + 1.0L) / (law.alpha + 1.0L) : 0.0L;
    };
    const auto dV = [&](long double e) {
        return e > 0 ? law.k * std::pow(e, (long double)law.alpha) : 0.0L;
    };
    long double r = solve_power_contact(law, double(eta), double(b), double(theta)).r;
    for (int i = 0; i < 3; ++i) {
        if (std::abs(r) < 1e-7L * std::abs(eta)) break;
        const long double Q = (V(eta) - V(eta - r)) / r, slope = (dV(eta - r) - Q) / r;
        r -= (r + b - theta * Q) / (1 - theta * slope);
    }
    return (r + b) / theta;
}
double force_of(const ContactLaw& law, double eta, double b, double theta) {
    return solve_power_contact(law, eta, b, theta).force;
}

template <class Real>
class PlainRestricted {
public:
    explicit PlainRestricted(bool parabola)
        : grid(parabola), c(scene_of(parabola).strings[0]), Phi(M, grid.count()), tap(M) {
        for (int j = 1; j <= M; ++j) {
            for (int z = 0; z < grid.count(); ++z)
                Phi(j - 1, z) =
                    std::sin(std::numbers::pi_v<Real> * ((long(j) * grid.node[z]) % (2 * N)) / N);
            tap[j - 1] = std::sin(std::numbers::pi_v<Real> * ((long(j) * 10) % (2 * N)) / N);
        }
        older = c.y0;
        now = c.y1;
        u_older = Phi.transpose() * older;
        u_now = Phi.transpose() * now;
        force.resize(grid.count());
    }
    void step() {  // n -> n+1
        next.noalias() = c.C.cwiseProduct(now) - c.Ct.cwiseProduct(older);
        u_next.noalias() = Phi.transpose() * next;
        bool touching = false;
        for (int z = 0; z < grid.count(); ++z) {
            force[z] =
                force_of(grid.law, grid.height[z] - u_older[z], u_older[z] - u_next[z], c.theta);
            touching = touching || force[z] != 0;
        }
        if (touching) {
            next.noalias() += Phi * (c.gain * force);
            u_next += c.theta * force;
        }
        older.swap(now);
        now.swap(next);
        u_older.swap(u_now);
        u_now.swap(u_next);
    }
    Real y10mm_before() const { return tap.dot(older); }

private:
    Grid grid;
    Coefficients<Real> c;
    Table<Real> Phi;  // one column of weights per node
    Column<Real> tap, older, now, next, u_older, u_now, u_next, force;
};

constexpr int steps_per_row = int(rate / tap_rate);

template <class Real>
std::vector<double> trace_of(PlainRestricted<Real>& s, int rows) {
    std::vector<double> y;
    for (int n = 0; n < rows; ++n) {
        y.push_back(double(s.y10mm_before()));
        for (int k = 0; k < steps_per_row; ++k) s.step();
    }
    return y;
}

void report(benchmark::State& state, long steps, const std::vector<double>& y, bool parabola) {
    static std::vector<double> truth[2];
    if (truth[parabola].empty()) {
        PlainRestricted<long double> exact(parabola);
        truth[parabola] = trace_of(exact, 81);  // 4 ms
    }
    double sum = 0, size = 0;
    for (std::size_t n = 0; n < y.size(); ++n) {
        sum += std::pow(y[n] - truth[parabola][n], 2);
        size += std::pow(truth[parabola][n], 2);
    }
    state.counters["per_step"] = benchmark::Counter(
        double(steps), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["error"] = std::sqrt(sum / size);
}

void kernel(benchmark::State& state, bool parabola) {
    Scene scene = scene_of(parabola);
    scene.duration = 4e-3;
    const Settings settings{rate, tap_rate, M, {}};
    const Run r = run(modal_spatial_newton, scene, settings);
    scene.duration = 20e-3 - 0.5 / tap_rate;
    const auto scheme = make_scheme(modal_spatial_newton, scene, settings);
    long steps = 0;
    for (auto _ : state) steps = run(*scheme, scene, settings, {.timed = true}).steps;
    report(state, steps, {r.trace.column(0).begin(), r.trace.column(0).end()}, parabola);
}

void plain(benchmark::State& state, bool parabola) {
    const FlushDenormals flush;
    const int rows = 400;
    const PlainRestricted<double> start(parabola);
    for (auto _ : state) {
        PlainRestricted<double> s = start;
        benchmark::DoNotOptimize(trace_of(s, rows));
    }
    PlainRestricted<double> s = start;
    report(state, long(rows) * steps_per_row, trace_of(s, 81), parabola);
}

BENCHMARK_CAPTURE(kernel, point, false)
    ->Name("pair/spatial_newton/kernel/point")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plain, point, false)
    ->Name("pair/spatial_newton/plain/point")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, parabola, true)
    ->Name("pair/spatial_newton/kernel/parabola")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plain, parabola, true)
    ->Name("pair/spatial_newton/plain/parabola")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace jvari

// finite_difference_explicit against a plain loop with the same contact equation, in one run: 20 contacts, 155 and 436 intervals. Each row
// carries as counters its agreement with the plain loop in long double over the first 3 ms, 1.5 ms of them in contact (later, 20 contacts
// have amplified rounding too far). The implicit schemes stand beside them for scale.
//
// The implicit solve as sums (GridSolve) against the factors L D L' that it replaces: alone, and in a step of either implicit scheme with
// the bridge and the thread of C3. Counter `error` of a solve: largest against L D L' in long double, relative to the largest value.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>

#include "schemes/contact/gradient_rule.hpp"
#include "schemes/grid/midpoint_string.hpp"
#include "schemes/grid/three_point_string.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace {
using namespace jvari;

Scene twenty_contacts(int intervals) {  // a flat profile under nodes 2..21
    Scene scene = c3_free();
    scene.taps = {{"y", Quantity::displacement, 0, 0.03}};
    String& s = scene.strings.front();
    const double dx = s.length / intervals;
    s.barriers = {ProfileBarrier{FlatCurve{}, 1.5 * dx, 21.5 * dx, {1e11}, 1, 0}};
    s.initial = TriangleInitial{0.3, 1.9e-3, 0.1};
    return scene;
}
double rate_of(int intervals) {
    return intervals < 200 ? 44100 : 181000;
}  // [Hz], near the stability limit

// The recursion as it is written down: one loop over the nodes, one over the contacts.
template <class Real>
struct Plain {
    int N;
    Real dt, a0, a1, a2, b0, b1, b2, theta, gain;
    std::vector<Real> before, now, next;
    double k;

    explicit Plain(int intervals) : N(intervals), dt(1 / static_cast<Real>(rate_of(intervals))) {
        const Scene scene = twenty_contacts(N);
        const String& s = scene.strings.front();
        const LossFit loss = fit_losses(s);
        const GridString g = on_grid(schemes()[0], scene, {rate_of(N), rate_of(N), 0, {}}, {N, s.length / N}, loss);
        const Real h2 = static_cast<Real>(g.grid.dx) * g.grid.dx, S = static_cast<Real>(g.c2) * dt * dt / h2,
                   q = static_cast<Real>(g.kappa2) * dt * dt / (h2 * h2), z = 2 * static_cast<Real>(loss.sigma1) * dt / h2,
                   z4 = 2 * static_cast<Real>(loss.sigma2) * dt / (h2 * h2), D = 1 + static_cast<Real>(loss.sigma0) * dt;
        a0 = (2 - 2 * S - 6 * q - 2 * z - 6 * z4) / D;
        a1 = (S + 4 * q + z + 4 * z4) / D;
        a2 = -(q + z4) / D;
        b0 = -(2 - D - 2 * z - 6 * z4) / D;
        b1 = -(z + 4 * z4) / D;
        b2 = z4 / D;
        gain = theta = dt * dt / static_cast<Real>(g.mass) / D;
        k = g.points.contacts.laws.front().k;
        now.assign(g.initial.begin(), g.initial.end());
        before = next = now;
        step();                                                                     // with u- = u: u + dt^2 (acceleration)
        for (int l = 1; l < N; ++l) now[l] = before[l] + (now[l] - before[l]) / 2;  // no contact at the start: the string is above
    }
    static Real contact(Real stiffness, Real eta, Real b, Real theta) {  // solve_linear_contact in Real
        const Real phi = theta * stiffness / 2;
        if (eta <= 0 && eta + b <= 0) return 0;
        if (eta > 0) {
            if (eta * (1 - phi) + b > 0) return stiffness * (eta + b / 2) / (1 + phi);
            const Real root = std::sqrt(b * b + 4 * phi * eta * eta);
            return stiffness * eta * eta / 2 / (b > 0 ? 2 * phi * eta * eta / (b + root) : (root - b) / 2);
        }
        const Real gap = -eta, free = eta + b, p = gap - free, root = std::sqrt(p * p + 4 * (1 + phi) * free * gap);
        const Real x = p > 0 ? 2 * free * gap / (p + root) : (root - p) / 2 / (1 + phi);
        return stiffness * x / (gap + x) * x / 2;
    }
    void step() {
        for (int l = 1; l < N; ++l) {
            const Real left2 = l > 1 ? now[l - 2] : -now[1], right2 = l < N - 1 ? now[l + 2] : -now[N - 1];
            const Real old_left2 = l > 1 ? before[l - 2] : -before[1], old_right2 = l < N - 1 ? before[l + 2] : -before[N - 1];
            next[l] = a0 * now[l] + a1 * (now[l - 1] + now[l + 1]) + a2 * (left2 + right2) + b0 * before[l] +
                      b1 * (before[l - 1] + before[l + 1]) + b2 * (old_left2 + old_right2);
        }
        for (int l = 2; l <= 21; ++l) next[l] += gain * contact(k, -before[l], before[l] - next[l], theta);
        std::swap(before, now);
        std::swap(now, next);
    }
};

double against_long_double(const std::vector<double>& u, int N) {
    static std::vector<long double> truth[2];
    auto& want = truth[N < 200 ? 0 : 1];
    if (want.empty()) {
        Plain<long double> p(N);
        const int steps = static_cast<int>(0.003 * rate_of(N));
        for (int n = 0; n < steps; ++n) {
            want.push_back(displacement_stencil({N, 1.0 / N}, 0.03).read(std::vector<double>(p.before.begin(), p.before.end()).data()));
            p.step();
        }
    }
    double error = 0, size = 0;
    for (std::size_t n = 0; n < want.size(); ++n) {
        error += std::pow(u[n] - static_cast<double>(want[n]), 2);
        size += std::pow(static_cast<double>(want[n]), 2);
    }
    return std::sqrt(error / size);
}

void plain(benchmark::State& state) {
    const int N = static_cast<int>(state.range(0));
    std::vector<double> y;
    Plain<double> check(N);
    for (int n = 0; n < 0.003 * rate_of(N); ++n) {
        y.push_back(displacement_stencil({N, 1.0 / N}, 0.03).read(check.before.data()));
        check.step();
    }
    Plain<double> p(N);
    const FlushDenormals flush;
    const int steps = 4096;
    for (auto _ : state)
        for (int n = 0; n < steps; ++n) p.step();
    benchmark::DoNotOptimize(p.now.data());
    state.counters["ns_per_step"] =
        benchmark::Counter(steps * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["error"] = against_long_double(y, N);
}

void scheme(benchmark::State& state, const char* name) {
    const int N = static_cast<int>(state.range(0));
    Scene scene = twenty_contacts(N);
    Settings settings;
    settings.sample_rate = settings.tap_rate = rate_of(N);
    settings.options = {{"grid", std::to_string(N)}};
    for (const Descriptor& d : schemes()) {
        if (std::strcmp(d.name, name) != 0) continue;
        scene.duration = 0.003;
        const Run r = run(d, scene, settings);
        const std::vector<double> y(r.trace.column(0).begin(), r.trace.column(0).end());
        const int steps = 4096;
        settings.tap_rate = settings.sample_rate / steps;  // one row
        const auto s = make_scheme(d, scene, settings);
        double cell;
        const Block one{1, 1, 1, &cell, nullptr};
        const FlushDenormals flush;
        for (auto _ : state) s->advance(one);
        state.counters["ns_per_step"] =
            benchmark::Counter(steps * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
        for (const Fact& f : r.facts)
            if (f.name == facts::deepest_penetration.name) state.counters["penetration"] = f.value;  // there was contact
        if (std::strcmp(name, "finite_difference_explicit") == 0) state.counters["error"] = against_long_double(y, N);
    }
}

// ---- The implicit solve.

class Factors {  // with the face of GridSolve
public:
    Factors() = default;
    Factors(const Grid& g, double a0, double a2, double a4) : factor_(g, a0, a2, a4), from_(g.intervals + 32) {}
    double* input() { return from_.data() + 7; }
    void operator()(double* u) {
        std::memcpy(u, input(), (from_.size() - 24) * sizeof(double));
        factor_.solve(u);
    }
    Stencil response(const Stencil& s) const { return factor_.solve(s); }

private:
    BandedFactor factor_;
    AlignedVector from_;
};
double implicit_rate(int intervals) {
    return intervals < 200 ? 48000 : 204800;  // [Hz], near the limit of the theta scheme
}
struct Coefficients {
    Grid grid;
    double a0, a2, a4;
};
Coefficients coefficients(int intervals, bool midpoint) {
    const String s = c3_free().strings.front();
    const LossFit loss = fit_losses(s);
    const Grid grid{intervals, s.length / intervals};
    const double dt = 1 / implicit_rate(intervals), c2 = s.tension / s.linear_density, kappa2 = s.bending_stiffness / s.linear_density;
    if (midpoint) return {grid, 1 + loss.sigma0 * dt, -0.25 * dt * dt * c2 - loss.sigma1 * dt, 0.25 * dt * dt * kappa2 + loss.sigma2 * dt};
    const double m = 0.5 * (1 - tuned_theta(s, dt, grid.dx)) * grid.dx * grid.dx;
    return {grid, 1 + loss.sigma0 * dt, m - loss.sigma1 * dt, loss.sigma2 * dt};
}

std::vector<long double> solved(const Coefficients& c, const std::vector<double>& x) {  // L D L' in long double
    const int n = c.grid.intervals - 1;
    const long double h2 = static_cast<long double>(c.grid.dx) * c.grid.dx, p = c.a2 / h2, q = c.a4 / (h2 * h2);
    std::vector<long double> D(n), one(n + 1), two(n + 2), u(x.begin(), x.end());
    for (int i = 0; i < n; ++i) {
        long double diagonal = c.a0 - 2 * p + (i == 0 || i == n - 1 ? 5 : 6) * q, below = p - 4 * q;
        if (i > 1) two[i] = q / D[i - 2], diagonal -= two[i] * two[i] * D[i - 2], below -= two[i] * one[i - 1] * D[i - 2];
        if (i > 0) one[i] = below / D[i - 1], diagonal -= one[i] * one[i] * D[i - 1];
        D[i] = diagonal;
    }
    for (int i = 1; i < n; ++i) u[i] -= one[i] * u[i - 1] + (i > 1 ? two[i] * u[i - 2] : 0);
    for (int i = 0; i < n; ++i) u[i] /= D[i];
    for (int i = n - 2; i >= 0; --i) u[i] -= one[i + 1] * u[i + 1] + (i + 2 < n ? two[i + 2] * u[i + 2] : 0);
    return u;
}

template <class Solve>
void solve(benchmark::State& state, bool midpoint) {
    const Coefficients c = coefficients(static_cast<int>(state.range(0)), midpoint);
    Solve s(c.grid, c.a0, c.a2, c.a4);
    std::vector<double> x, u(c.grid.intervals + 24);
    for (int l = 1; l < c.grid.intervals; ++l) s.input()[l] = std::sin(0.7 * l * l), x.push_back(s.input()[l]);
    s(u.data());
    const auto truth = solved(c, x);
    long double error = 0, largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
        error = std::max(error, std::abs(u[i + 1] - truth[i])), largest = std::max(largest, std::abs(truth[i]));
    const FlushDenormals flush;
    for (auto _ : state) {
        s(u.data());
        benchmark::ClobberMemory();
    }
    state.counters["error"] = static_cast<double>(error / largest);
}

template <class Solve>
struct Theta {
    FivePoint pass;
    Solve solve;
    int intervals;
    IncrementPass add = increment_pass();
    void operator()(double* next, const double* now, const double* before) {
        pass(solve.input(), now, before);
        solve(next);
        add(intervals, next, before);
    }
    Stencil response(const Stencil& s) const { return solve.response(s); }
};

template <class Solve>
void step(benchmark::State& state, bool midpoint) {
    const Coefficients c = coefficients(static_cast<int>(state.range(0)), midpoint);
    const Scene scene = c3_release();
    const double dt = 1 / implicit_rate(c.grid.intervals);
    const GridString g = on_grid(schemes()[0], scene, {1 / dt, 1 / dt, 0, {}}, c.grid, fit_losses(scene.strings.front()));
    constexpr int steps = 1024;
    double tap[4];
    const Block one{1, 4, 1, tap, nullptr};
    const auto go = [&]<class String>(std::unique_ptr<String> string) {
        Driver<String, GradientRule> scheme(std::move(string), steps);
        const FlushDenormals flush;
        for (auto _ : state) scheme.advance(one);
    };
    if (midpoint) go(std::make_unique<MidpointString<Solve>>(g, dt));
    else {
        const double m = 0.5 * (1 - tuned_theta(scene.strings.front(), dt, c.grid.dx)) * c.grid.dx * c.grid.dx;
        go(std::make_unique<ThreePointString<Theta<Solve>>>(
            g, dt, m, 0.0,
            Theta<Solve>{FivePoint(g, dt, m, 0, 1, FivePoint::Of::increment), Solve(c.grid, c.a0, c.a2, c.a4), c.grid.intervals}));
    }
    state.counters["ns_per_step"] =
        benchmark::Counter(steps * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

constexpr auto solve_sums = solve<GridSolve>, solve_factors = solve<Factors>;
constexpr auto step_sums = step<GridSolve>, step_factors = step<Factors>;
BENCHMARK_CAPTURE(solve_sums, theta, false)->Arg(155)->Arg(436);
BENCHMARK_CAPTURE(solve_factors, theta, false)->Arg(155)->Arg(436);
BENCHMARK_CAPTURE(solve_sums, midpoint, true)->Arg(155)->Arg(436);
BENCHMARK_CAPTURE(solve_factors, midpoint, true)->Arg(155)->Arg(436);
BENCHMARK_CAPTURE(step_sums, theta, false)->Arg(155)->Arg(436)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step_factors, theta, false)->Arg(155)->Arg(436)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step_sums, midpoint, true)->Arg(155)->Arg(436)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step_factors, midpoint, true)->Arg(155)->Arg(436)->Unit(benchmark::kMicrosecond);

BENCHMARK(plain)->Arg(155)->Arg(436)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scheme, explicit, "finite_difference_explicit")->Arg(155)->Arg(436)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scheme, theta, "finite_difference_theta")->Arg(150)->Arg(400)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scheme, hamiltonian, "finite_difference_hamiltonian")->Arg(155)->Arg(436)->Unit(benchmark::kMillisecond);
}  // namespace

BENCHMARK_MAIN();

// finite_difference_explicit against a plain loop with the same contact equation, in one run: 20
// contacts, 155 and 436 intervals. Counter `error`: from the plain loop in long double over the
// first 3 ms, 1.5 ms of them in contact (later, 20 contacts have amplified rounding too far).
#include <benchmark/benchmark.h>

#include <cmath>

#include "schemes/contact/contact.hpp"
#include "schemes/grid/finite_difference.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"

namespace jvari {
extern const Descriptor finite_difference_explicit;
}

namespace {
using namespace jvari;

Scene twenty_contacts(int intervals) {  // a flat profile under nodes 2..21
    Scene scene = c3_free();
    scene.taps = {{"y", Quantity::displacement, 0, 0.03}};
    String& s = scene.strings.front();
    const double dx = s.length / intervals;
    s.barriers = {ProfileBarrier{FlatCurve{}, 1.5 * dx, 21.5 * dx, {1e11}, 1, 0}};
    s.start = TriangleShape{0.3, 1.9e-3, 0.1};
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
        const GridString g = on_grid(finite_difference_explicit, scene,
                                     {rate_of(N), rate_of(N), 0, {}}, {N, s.length / N}, loss);
        const Real h2 = static_cast<Real>(g.grid.dx) * g.grid.dx,
                   S = static_cast<Real>(g.c2) * dt * dt / h2,
                   q = static_cast<Real>(g.kappa2) * dt * dt / (h2 * h2),
                   z = 2 * static_cast<Real>(loss.sigma1) * dt / h2,
                   z4 = 2 * static_cast<Real>(loss.sigma2) * dt / (h2 * h2),
                   D = 1 + static_cast<Real>(loss.sigma0) * dt;
        a0 = (2 - 2 * S - 6 * q - 2 * z - 6 * z4) / D;
        a1 = (S + 4 * q + z + 4 * z4) / D;
        a2 = -(q + z4) / D;
        b0 = -(2 - D - 2 * z - 6 * z4) / D;
        b1 = -(z + 4 * z4) / D;
        b2 = z4 / D;
        gain = theta = dt * dt / static_cast<Real>(g.mass) / D;
        k = g.points.contacts.laws.front().k;
        now.assign(g.start.begin(), g.start.end());
        before = next = now;
        // with u- = u: u + dt^2 (acceleration)
        step();
        // no contact at the start: the string is above
        for (int l = 1; l < N; ++l) now[l] = before[l] + (now[l] - before[l]) / 2;
    }
    // solve_linear_contact in Real
    static Real contact(Real stiffness, Real eta, Real b, Real theta) {
        const Real phi = theta * stiffness / 2;
        if (eta <= 0 && eta + b <= 0) return 0;
        if (eta > 0) {
            if (eta * (1 - phi) + b > 0) return stiffness * (eta + b / 2) / (1 + phi);
            const Real root = std::sqrt(b * b + 4 * phi * eta * eta);
            return stiffness * eta * eta / 2 /
                   (b > 0 ? 2 * phi * eta * eta / (b + root) : (root - b) / 2);
        }
        const Real gap = -eta, free = eta + b, p = gap - free,
                   root = std::sqrt(p * p + 4 * (1 + phi) * free * gap);
        const Real x = p > 0 ? 2 * free * gap / (p + root) : (root - p) / 2 / (1 + phi);
        return stiffness * x / (gap + x) * x / 2;
    }
    void step() {
        for (int l = 1; l < N; ++l) {
            const Real left2 = l > 1 ? now[l - 2] : -now[1],
                       right2 = l < N - 1 ? now[l + 2] : -now[N - 1];
            const Real old_left2 = l > 1 ? before[l - 2] : -before[1],
                       old_right2 = l < N - 1 ? before[l + 2] : -before[N - 1];
            next[l] = a0 * now[l] + a1 * (now[l - 1] + now[l + 1]) + a2 * (left2 + right2) +
                      b0 * before[l] + b1 * (before[l - 1] + before[l + 1]) +
                      b2 * (old_left2 + old_right2);
        }
        for (int l = 2; l <= 21; ++l)
            next[l] += gain * contact(k, -before[l], before[l] - next[l], theta);
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
            want.push_back(displacement_stencil({N, 1.0 / N}, 0.03)
                               .read(std::vector<double>(p.before.begin(), p.before.end()).data()));
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
    state.counters["per_step"] = benchmark::Counter(
        steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["error"] = against_long_double(y, N);
}

void kernel(benchmark::State& state) {
    const int N = static_cast<int>(state.range(0));
    Scene scene = twenty_contacts(N);
    Settings settings;
    settings.sample_rate = settings.tap_rate = rate_of(N);
    settings.options = {{"grid", std::to_string(N)}};
    scene.duration = 0.003;
    const Run r = run(finite_difference_explicit, scene, settings);
    const int steps = 4096;
    settings.tap_rate = settings.sample_rate / steps;  // one row
    const auto s = make_scheme(finite_difference_explicit, scene, settings);
    double cell;
    const Block one{1, 1, 1, &cell, nullptr};
    const FlushDenormals flush;
    for (auto _ : state) s->advance(one);
    state.counters["per_step"] = benchmark::Counter(
        steps, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["error"] =
        against_long_double({r.trace.column(0).begin(), r.trace.column(0).end()}, N);
}

BENCHMARK(kernel)
    ->Name("pair/five_point/kernel")
    ->Arg(155)
    ->Arg(436)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(plain)->Name("pair/five_point/plain")->Arg(155)->Arg(436)->Unit(benchmark::kMillisecond);
}  // namespace

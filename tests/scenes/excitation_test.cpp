// Mean and first moment of a pluck's force over a step.
#include "scenes/excitation.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "scenes/columns.hpp"

namespace jvari {
namespace {

// integral of f by GSL's adaptive Gauss-Kronrod
template <class F>
double integral(F f, double from, double to) {
    const std::unique_ptr<gsl_integration_workspace, void (*)(gsl_integration_workspace*)> work(
        gsl_integration_workspace_alloc(1000), gsl_integration_workspace_free);
    gsl_function g{[](double x, void* of) { return (*static_cast<F*>(of))(x); }, &f};
    double result = 0, error = 0;
    gsl_integration_qag(&g, from, to, 0, 1e-13, 1000, GSL_INTEG_GAUSS61, work.get(), &result,
                        &error);
    return result;
}

// P_0 and P_1 over a step, cut at the pluck's own ends
double moment(const Pluck& e, double t, double dt, int degree) {
    const double from = std::max(t, e.start), to = std::min(t + dt, e.start + e.duration);
    if (!(to > from)) return 0;
    const auto weighted = [&](double x) {
        return force(e, x) * (degree == 0 ? 1 : 3 * (2 * (x - t) / dt - 1)) / dt;
    };
    double sum = 0;  // the skewed end apart, so that the adaptive rule sees it
    const double edge = std::clamp(e.start + e.duration * (1 - 40 / (1 + e.skew)), from, to);
    if (edge > from) sum += integral(weighted, from, edge);
    if (to > edge) sum += integral(weighted, edge, to);
    return sum;
}

TEST(MeanForce, AndFirstMomentAreIntegralsOfTheForceOverTheStep) {
    gsl_set_error_handler_off();
    for (const double skew : {0.0, 1.0, 30.0, 300.0, 1e4})
        for (const double step : {0.01, 0.07, 0.4, 1.3, 5.0}) {
            const Pluck e{-0.4, 2e-3, skew, 1.3e-3, 0.5, 0};
            const double dt = step * e.duration;
            for (int n = 0; n * dt < 4e-3; ++n) {
                EXPECT_NEAR(mean_force(e, n * dt, dt), moment(e, n * dt, dt, 0), 0.4e-12)
                    << skew << ' ' << step << ' ' << n;
                EXPECT_NEAR(first_moment(e, n * dt, dt), moment(e, n * dt, dt, 1), 1.2e-12)
                    << skew << ' ' << step << ' ' << n;
            }
        }
}

TEST(MeanForce, OfAFileIsThatOfItsLines) {
    Pluck e;
    force_from("f.csv", "time_s,force_N\n1e-3,0\n1.01e-3,100\n1.02e-3,0\n", e);
    // a triangle of 100 N and 20 us, whole within a step of 100 us that begins 30 us before it
    EXPECT_NEAR(mean_force(e, 0.97e-3, 1e-4), 10, 1e-11);
    EXPECT_NEAR(first_moment(e, 0.97e-3, 1e-4), 3 * 10 * (2 * 0.4 - 1), 1e-10);
    // its first half ends with the step: F = 100 (10 s - 9) N from s = 0.9 on
    EXPECT_NEAR(mean_force(e, 0.91e-3, 1e-4), 5, 1e-11);
    EXPECT_NEAR(first_moment(e, 0.91e-3, 1e-4), 3 * 5 * (1 - 0.2 / 3), 1e-10);
    EXPECT_EQ(mean_force(e, 1.03e-3, 1e-4), 0);
    EXPECT_EQ(mean_force(e, 0.8e-3, 1e-4), 0);
    e = {};
    force_from("f.csv", "time_s,force_N\n0.2e-3,3\n0.7e-3,-1\n0.8e-3,2\n2e-3,2\n", e);
    for (const double dt : {0.05e-3, 0.3e-3, 0.7e-3}) {
        double impulse = 0, about = 0;  // and that of F t
        for (int n = 0; n * dt < 2.1e-3; ++n) {
            const double mean = mean_force(e, n * dt, dt);
            impulse += dt * mean;
            about += dt * (mean * (n + 0.5) * dt + first_moment(e, n * dt, dt) * dt / 6);
        }
        EXPECT_NEAR(impulse, 0.5e-3 + 0.05e-3 + 2.4e-3, 1e-16) << dt;
        const double lines = 0.5e-3 * (0.45e-3 + -4 * 0.5e-3 / 12) +
                             0.1e-3 * (0.5 * 0.75e-3 + 3 * 0.1e-3 / 12) + 2.4e-3 * 1.4e-3;
        EXPECT_NEAR(about, lines, 1e-18) << dt;
    }
}

TEST(MeanForce, OfStepsAddsUpToTheImpulseHoweverLongTheyAre) {
    for (const double skew : {0.0, 3.0, 30.0}) {
        const Pluck e{100, 20e-6, skew, 1.003e-3, 0.5, 0};
        const double impulse = mean_force(e, e.start, e.duration) * e.duration;
        for (const double rate : {8e3, 44.1e3, 352.8e3, 3e6}) {
            double sum = 0;
            for (int n = 0; n < 2e-3 * rate; ++n) sum += mean_force(e, n / rate, 1 / rate) / rate;
            EXPECT_NEAR(sum, impulse, 1e-11 * impulse) << skew << ' ' << rate;
        }
    }
}

TEST(FreeFrom, ALoadThatLastsIsWhereItBecomesSteady) {
    Scene scene;
    scene.duration = 1;
    scene.strings.resize(1);
    Pluck load{};
    load.file = "load.csv", load.position = 0.4, load.peak = load.amplitude = 2;
    const auto from = [&](std::vector<double> time, std::vector<double> share) {
        load.time = std::move(time), load.share = std::move(share);
        load.start = load.time.front(), load.duration = load.time.back() - load.start;
        scene.strings[0].pluck = load;
        return free_from(scene);
    };
    EXPECT_EQ(from({0, 1000}, {1, 1}), 0);
    EXPECT_EQ(from({0, 0.1, 0.3, 0.7, 1}, {0, 1, 0.5, 0.5, 0.5}), 0.3);
    EXPECT_EQ(from({0.2, 2, 3}, {1, 1, 0}), 0.2);  // later changes are not in the run
    EXPECT_EQ(from({0, 0.01, 0.02, 5}, {0, 1, 0, 0}), 0.02);
    EXPECT_EQ(from({0, 0.01, 0.5}, {1, 1, 1}), 0.5);  // it ends within the run
    EXPECT_EQ(from({0, 0.01, 5}, {0, 0, 1}), 5);      // it changes to the end: nothing to measure
}

TEST(FreeFrom, ABlowIsMeasuredFromItsStart) {
    Scene scene;
    scene.duration = 1;
    scene.strings.resize(2);
    scene.strings[0].pluck = Pluck{-15, 4e-3, 0, 0.1, 0.6, 0.02};
    EXPECT_DOUBLE_EQ(free_from(scene), 0.104);
    scene.strings[0].pluck->kind = PluckKind::blow;
    EXPECT_EQ(free_from(scene), 0.1);
    Pluck& file = *scene.strings[0].pluck;
    file.file = "blow.csv", file.time = {0, 0.01, 0.02, 5}, file.share = {0, 1, 0, 0};
    file.start = 0, file.duration = 5;
    EXPECT_EQ(free_from(scene), 0);
    scene.strings[1].pluck = Pluck{-15, 0.5, 0, 0, 0.6, 0.02};
    EXPECT_EQ(free_from(scene), 0.5);  // a finger still pulls the other string
}

}  // namespace
}  // namespace jvari

// A window of the exact reference, part by part: its two ways through contact against one another,
// and the choice of its length.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "reference/exact/collocated_contact.hpp"
#include "reference/exact/crossing.hpp"
#include "reference/exact/macro_window.hpp"
#include "reference/exact/touching_set.hpp"
#include "scenes/start.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

// The C3 string comes down on its bridge at 0.1 m/s at the start of a window, and stays there for
// `until`: how far the split of the contact is from collocation in 1024 steps, by the impulse,
// relative.
double split_against_steps(int windows, int terms, double until, double stiffness = 4.39e8) {
    const Scene scene = c3_release();
    const String& s = scene.strings.front();
    const Modes modes = modes_of(s, 133);
    MacroWindow w(modes, s, 1 / 44100.0, 1e-12, {}, windows, terms);
    std::vector<double> y = w.osc.pad(start_of(modes, s).displacement), u(w.osc.padded, 0.0);
    w.open(y.data(), u.data(), false, 0);
    std::vector<double> r(w.free_motion(0), w.free_motion(0) + w.stride), path(w.stride),
        m(w.stride);
    r[0] = 0;
    r[1] = -0.1 * w.seconds();
    const int point[] = {0};
    const double k[] = {stiffness};
    TouchingSet set(w, point, k);
    EXPECT_EQ(set.pairs() > 0, stiffness > 1e8);
    until = std::min(until, set.span());
    std::complex<double> amplitude[1];
    set.solve(r.data(), path.data(), amplitude);
    set.moments(0, path.data(), amplitude, until, terms, m.data());

    const BarrierLaw law[] = {{{stiffness, 1}, 0}};
    CollocatedContact steps(w, law);
    std::vector<double> moved(w.stride), part(w.stride), e(3 * most_terms);
    double impulse = 0;
    constexpr int count = 1024;
    for (int i = 0; i < count; ++i) {
        EXPECT_LT(steps.step(r.data(), point, until / count, CollocatedContact::From::elsewhere),
                  1e-9);
        steps.moments(0, until / count, terms, part.data());
        impulse += part[0];
        powers(until / count, w.size, e.data());
        for (int n = 0; n < terms; ++n) {
            moved[n] = 0;
            for (int j = 0; n + j < terms; ++j)
                moved[n] += r[n + j] * e[j] + w.kernel(0, 0)[n + j] * part[j];
        }
        std::copy_n(moved.begin(), terms, r.begin());
    }
    return std::abs(m[0] - impulse) / std::abs(impulse);
}

TEST(MacroWindow, TheSplitOfStiffContactIsWhatSmallStepsMakeOfIt) {
    EXPECT_LT(split_against_steps(2, 21, 0.1), 1e-12);
    EXPECT_LT(split_against_steps(2, 21, 1), 1e-11);
}

TEST(MacroWindow, ASoftContactIsWhatSmallStepsMakeOfItAsFarAsItsSpan) {
    for (const double k : {1e4, 3e5, 3e6}) EXPECT_LT(split_against_steps(2, 21, 1, k), 1e-11) << k;
}

// Many points in contact are solved by a fixed-point iteration, or by Newton's where that does not
// contract. Either way the forces at the nodes obey the law on the path that they cause. Over
// a whole window at 2e6 N/m the fixed-point iteration diverges, over a tenth it does not.
double misfit_of_forces(double stiffness, double exponent, double loss, double step) {
    constexpr int points = 9;
    String s = c3_release().strings.front();
    s.barriers.clear();
    for (int a = 0; a < points; ++a)
        s.barriers.push_back(LumpedBarrier{0.01 + 2e-3 * a, 0, 0, {stiffness}, exponent, loss});
    const MacroWindow w(modes_of(s, 60), s, 1 / 44100., 1e-13);
    const BarrierLaw law{{stiffness, exponent}, loss};
    CollocatedContact contact(w, std::vector<BarrierLaw>(points, law));
    std::vector<double> r(w.contacts * w.stride, 0.0), path(r.size());
    std::vector<int> touching(points);
    for (int a = 0; a < points; ++a) {
        touching[a] = a;
        r[a * w.stride] = -1e-5 * (1 + 0.3 * std::sin(3 * a));
        r[a * w.stride + 1] = -2e-6 * std::cos(a);
    }
    contact.step(r.data(), touching, step, CollocatedContact::From::elsewhere);
    contact.path(r.data(), path.data());
    double misfit = 0, most = 0;
    for (int a = 0; a < points; ++a)
        for (const double node : {0.2372337950418355, 0.5917173212478248}) {
            double at[3];
            w.sweep().evaluate(&path[a * w.stride], w.size, node * step, at);
            const double by_law = law.force(-at[0], at[1] / w.seconds());
            misfit = std::max(misfit, std::abs(contact.force(a, node * step) - by_law));
            most = std::max(most, std::abs(by_law));
        }
    return misfit / most;
}

TEST(MacroWindow, ForcesOfManyPointsObeyTheLawOnThePathThatTheyCause) {
    for (const double stiffness : {1e4, 2e6})
        for (const double step : {0.1, 1.0}) {
            EXPECT_LT(misfit_of_forces(stiffness, 1, 0, step), 1e-10) << stiffness << " " << step;
            EXPECT_LT(misfit_of_forces(stiffness, 1, 0.01, step), 1e-10)
                << stiffness << " " << step;
            EXPECT_LT(misfit_of_forces(stiffness * 300, 1.5, 0, step), 1e-10)
                << stiffness << " " << step;
        }
}

// The linear systems of a collocation: I + a matrix of a norm below one half, so that no pivots are
// needed.
TEST(MacroWindow, FactorsSolveTheSystemThatTheyAreOf) {
    const SweepFunctions& sweep = sweep_functions();
    for (const int size : {8, 16, 24, 40, 64}) {
        std::vector<double> matrix(size * size), x(size), right(size, 0.0), scratch(size);
        for (int j = 0; j < size; ++j) {
            x[j] = std::cos(1.7 * j) + 0.1;
            for (int i = 0; i < size; ++i)
                matrix[j * size + i] =
                    std::sin(0.37 * i + 1.91 * j * j) / (2 * size) + (i == j ? 1 : 0);
            for (int i = 0; i < size; ++i) right[i] += matrix[j * size + i] * x[j];
        }
        sweep.factor(matrix.data(), scratch.data(), size);
        sweep.substitute(matrix.data(), right.data(), scratch.data(), size);
        for (int i = 0; i < size; ++i) EXPECT_NEAR(right[i], x[i], 1e-14) << size << " " << i;
    }
}

// A second point in the air moves as the moments of the first one's force move it, up to the end of
// the span.
TEST(MacroWindow, ASoftContactPushesAPointInTheAirAsItsMomentsDo) {
    const Scene scene = c3_release();
    String s = scene.strings.front();
    s.barriers.push_back(LumpedBarrier{11e-3, 0, 0, {3e6}, 1, 0});
    const Modes modes = modes_of(s, 133);
    MacroWindow w(modes, s, 1 / 44100.0, 1e-12, {}, 2, 21);
    const int point[] = {0};
    const double k[] = {3e6};
    TouchingSet set(w, point, k);
    ASSERT_EQ(set.pairs(), 0);
    std::vector<double> r(2 * w.stride, 0.0), path(2 * w.stride), m(w.stride), now(3);
    r[1] = -0.1 * w.seconds();
    r[w.stride] = 1e-5, r[w.stride + 1] = -1e-6;
    std::complex<double> none[1];
    set.solve(r.data(), path.data(), none);
    for (const double part : {0.3, 1.0}) {
        const double u = part * set.span();
        set.moments(0, path.data(), none, u, w.terms, m.data());
        double pushed = 0;
        for (int n = 0; n < w.terms; ++n) pushed += w.kernel(1, 0)[n] * m[n];
        w.sweep().evaluate(path.data() + w.stride, w.size, u, now.data());
        EXPECT_GT(pushed, 1e-8);
        EXPECT_NEAR(now[0] - (1e-5 - 1e-6 * u), pushed, 1e-11 * pushed) << part;
    }
}

// The series of the slow part is asymptotic: a window as long as a row does not reach with 24 terms
// what half a row does with 21.
TEST(MacroWindow, MoreTermsDoNotMakeUpForALongerWindow) {
    EXPECT_GT(split_against_steps(1, 24, 1), 10 * split_against_steps(2, 21, 1));
}

TEST(MacroWindow, IsNeverLongerThanTheSplitAllowsAndKeepsWhatTheToleranceNeeds) {
    int before = 0;
    for (const double tolerance : {1e-3, 1e-6, 1e-10, 1e-12}) {
        const auto c = choose_window(tolerance, 4.78);
        EXPECT_EQ(c.per_row, 2);
        EXPECT_GT(c.terms, before);
        before = c.terms;
    }
    for (const double reach : {0.01, 2.4, 2.6, 33.0, 1e5}) {
        const auto c = choose_window(1e-12, reach);
        EXPECT_LE(reach / c.per_row, longest_reach);
        EXPECT_LE(c.terms, most_split_terms);
    }
}

// Where no contact is split a window may be twice as long, unless its tolerance asks for more terms
// than there are.
TEST(MacroWindow, IsLongerWhereNothingIsSplitAndTheTermsReach) {
    for (const double tolerance : {1e-3, 1e-6, 1e-10, 1e-12}) {
        const auto c = choose_window(tolerance, 4.78, false);
        EXPECT_EQ(c.per_row, 1);
        EXPECT_LE(c.terms, most_terms);
    }
    EXPECT_EQ(choose_window(1e-15, 4.78, false).per_row, 2);
}

// Two modes with a thread near their end, bent and let go: where the contact's point is `rows` of
// 0.25 ms later [m].
double after_rows(int rows, int terms, double& truncation) {
    String s = c3_release().strings.front();
    s.linear_density = 7.58e-3;
    s.damping = PolynomialDamping{0.2, 1e-2, 0};
    s.start = TriangleShape{0.4, 1.5e-3, 0.02};
    s.barriers = {LumpedBarrier{0.37, 0, 0, {1e8}, 1, 0}};
    s.thread = Thread{0.0244, 1e-3, 7.2e4, 0.22, 0};
    const Modes modes = modes_of(s, 2);
    MacroWindow w(modes, s, 1 / 4000.0, 1e-12, {}, 1, terms);
    std::vector<double> y = w.osc.pad(start_of(modes, s).displacement), u(w.osc.padded, 0.0),
                        none(2 * w.stride, 0.0);
    for (int row = 0; row < rows; ++row) {
        w.open(y.data(), u.data(), false, 0);
        w.state_at(1, none.data(), y.data(), u.data(), y.data(), u.data());
        if (row == 0) truncation = w.truncation();
    }
    return dot(w.osc, w.springs.weights.data(), y.data());
}

// The thread moves the modes as exactly as crossings are found, though its damper asks for one
// derivative more than the contact does. A force that ended one derivative earlier would add up,
// over 64 windows, to 3 to 8 times the bound within which a contact may be missed.
TEST(MacroWindow, TheThreadMovesTheModesAsExactlyAsCrossingsAreFound) {
    for (const int terms : {6, 8, 10}) {
        double bound = 0, none = 0;
        const double off = std::abs(after_rows(64, terms, bound) - after_rows(64, 22, none));
        EXPECT_LE(off, 0.5 * bound) << terms << " terms";
    }
}

// Weights are in units of the last point's. One at the string's end, where no mode moves, changes
// no other.
TEST(MacroWindow, APointThatNoModeMovesLeavesTheOthersAsTheyWere) {
    String s = c3_release().strings.front();
    const Modes modes = modes_of(s, 133);
    std::vector<std::vector<double>> ends;
    for (const bool fixed : {false, true}) {
        if (fixed) s.barriers.push_back(LumpedBarrier{0, -1, 0, {1e7}, 1, 0});
        s.thread.reset();
        MacroWindow w(modes, s, 1 / 44100.0, 1e-10);
        std::vector<double> y = w.osc.pad(start_of(modes, s).displacement), u(w.osc.padded, 0.0),
                            M(2 * w.stride, 0.0);
        for (int n = 0; n < w.terms; ++n) M[n] = 1e-2 * inverse_factorial[n + 1];
        w.open(y.data(), u.data(), false, 0);
        ends.emplace_back(w.free_motion(0), w.free_motion(0) + w.size);
        w.state_at(1, M.data(), y.data(), u.data(), y.data(), u.data());
        for (const auto* x : {&y, &u}) ends.back().insert(ends.back().end(), x->begin(), x->end());
        w.state_near(0.5, M.data(), y.data(), u.data(), y.data(), u.data());
        for (const auto* x : {&y, &u}) ends.back().insert(ends.back().end(), x->begin(), x->end());
    }
    ASSERT_EQ(ends[0].size(), ends[1].size());
    for (std::size_t i = 0; i < ends[0].size(); ++i)
        EXPECT_NEAR(ends[0][i], ends[1][i], 1e-12 * std::abs(ends[0][i]) + 1e-17) << i;
}

// Two pairs of frequencies near one another over a slow parabola: the first crossing of a sampled
// gap, and never later.
TEST(FirstCrossing, FindsWhatDenseSamplingFindsAndNeverLater) {
    int crossings = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const double a = std::fmod(trial * 0.7548776662, 1.0),
                     b = std::fmod(trial * 0.5698402910, 1.0);
        double p[64] = {1.2 + a, -2 * b, -4 * a};
        const std::complex<double> amplitude[2] = {{0.6 * b, 0.3}, {0.4 * a, -0.2}},
                                   rate[2] = {{-0.5, 40 + 30 * a}, {-2, 95}};
        const Gap gap{1, p, 24, 3, amplitude, rate, 2};
        if (gap.at(0).g < 0) continue;
        const double found = first_crossing(gap, 1, 1e-16);
        double sampled = 2;
        for (int i = 0; i <= 4000 && sampled == 2; ++i)
            if (gap.at(i * 2.5e-4).g < 0) sampled = i * 2.5e-4;
        EXPECT_LE(found, sampled + 1e-12) << trial;
        if (found > 1) continue;
        ++crossings;
        EXPECT_NEAR(gap.at(found).g, 0, 1e-12) << trial;
        EXPECT_LT(gap.at(found + 1e-7).g, 0) << trial;
    }
    EXPECT_GT(crossings, 50);
}

// Gaps of a window without contact: up to three slow waves beside a height. Those that stay open
// are most, and mostly seen at a glance.
TEST(FirstCrossing, SaysOpenOnlyWhereDenseSamplingFindsNoCrossing) {
    int crossings = 0, open = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        double p[64] = {0.8 + 0.7 * std::fmod(trial * 0.7548776662, 1.0)};
        for (int wave = 0; wave < 3; ++wave) {
            const double rate = 4.8 * std::fmod(trial * 0.5698402910 + 0.3 * wave, 1.0),
                         phase = 0.61 * trial + wave;
            double power = 0.5;
            for (int n = 0; n < 32; ++n, power *= rate)
                p[n] += power * std::cos(phase + 0.5 * n * std::numbers::pi);
        }
        if (p[0] < 0) continue;
        for (const double sign : {1.0, -1.0}) {
            double turned[64];
            for (int n = 0; n < 64; ++n) turned[n] = sign * p[n];
            const Gap gap{sign, turned, 32, 4.8, nullptr, nullptr, 0};
            const double found = first_crossing(gap, 1, 1e-16);
            double sampled = 2;
            for (int i = 0; i <= 1000 && sampled == 2; ++i)
                if (gap.at(i * 1e-3).g < 0) sampled = i * 1e-3;
            EXPECT_LE(found, sampled + 1e-12) << trial;
            ++(found > 1 ? open : crossings);
        }
    }
    EXPECT_GT(crossings, 300);
    EXPECT_GT(open, 300);
}

}  // namespace
}  // namespace jvari

// Outcomes of runs that are made up, each by the one thing that is wrong with it.
#include "bench/suite/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace jvari::test {
namespace {

Descriptor promising(Balance b) { return {"made_up", "", {}, b, Clock::stepped, nullptr}; }

Scene string_over_barrier() {
    Scene s;
    s.strings.emplace_back();
    s.strings[0].length = 2;
    s.strings[0].tension = 4;
    s.strings[0].linear_density = 1;
    s.strings[0].start = ModeShape{1, 0.1};
    s.strings[0].barriers.push_back(LumpedBarrier{});
    return s;
}

struct MadeUp {  // 100 rows at 1 kHz of a string that swings
    Scene scene = bench::suite::listened(string_over_barrier());
    Run run;
    Trace truth;

    MadeUp() {
        Trace& t = run.trace;
        t.tap_rate = 1000;
        t.rows = t.stride = 100;
        for (const Tap& tap : scene.taps) t.names.push_back(tap.name);
        for (int k = 0; k < 2; ++k)
            for (int n = 0; n < 100; ++n) t.tap.push_back(0.4 * std::cos(0.1 * n));
        for (int n = 0; n < 100; ++n) t.tap.push_back(std::cos(0.1 * n));  // nut force [N]
        t.energy.assign(100, 1.0);
        t.energy.resize(300, 0.0);
        run.facts = {{"smallest_contact_force", 0, "N"}, {"largest_contact_force", 6, "N"}};
        truth = t;
    }
    double& energy(int column, int row) { return run.trace.energy[100 * column + row]; }
    bench::study::Judgement judgement(Balance b = Balance::exact, bool with_truth = true) {
        const Descriptor d = promising(b);
        bench::study::Cell cell{&d, {}};
        cell.summary = bench::study::summary_of(d, scene, {}, run);
        // nut, whole run
        return bench::study::judge(
            cell, with_truth ? bench::study::errors_of(run.trace, truth).at(2).at(2) : nan);
    }
    bench::study::Verdict verdict(Balance b = Balance::exact) { return judgement(b).verdict; }
};

bench::study::Judgement judged(Status status, double over_bound, double gain, double pull,
                               double error, Balance b) {
    const Descriptor d = promising(b);
    bench::study::Cell cell{&d, {}};
    cell.summary.status = status;
    cell.summary.largest_over_bound = over_bound;
    cell.summary.energy_gain = gain;
    cell.summary.smallest_contact_force = -pull, cell.summary.largest_contact_force = 1;
    return bench::study::judge(cell, error);
}

TEST(Outcome, ARunWithNothingAgainstItIsSound) {
    EXPECT_EQ(MadeUp().verdict(), bench::study::Verdict::sound);
    EXPECT_EQ(MadeUp().judgement(Balance::exact, false).detail, "");
}

TEST(Outcome, TheRunsOwnStatusIsTakenWithItsStep) {
    MadeUp m;
    m.run.status = {Outcome::diverged, 17};
    EXPECT_EQ(m.verdict(), bench::study::Verdict::diverged);
    EXPECT_EQ(m.judgement().step, 17);
    m.run.status.outcome = Outcome::not_converged;
    EXPECT_EQ(m.verdict(), bench::study::Verdict::not_converged);
}

TEST(Outcome, EnergyThatTheLedgerDoesNotExplainIsAGain) {
    MadeUp m;
    for (int n = 50; n < 100; ++n) m.energy(0, n) = 2;  // supplied: no gain
    m.energy(1, 50) = 1;
    EXPECT_EQ(m.verdict(), bench::study::Verdict::sound);
    m.energy(0, 80) = 2 + 4e-6;
    // 2e-6 of the 2 J that were there
    EXPECT_EQ(m.verdict(), bench::study::Verdict::energy_gaining);
    // no gain to speak of, and an open ledger
    EXPECT_EQ(m.verdict(Balance::none), bench::study::Verdict::flagged);
    m.energy(0, 80) = 2.04;
    EXPECT_EQ(m.verdict(Balance::none), bench::study::Verdict::energy_gaining);
}

TEST(Outcome, EnergyThatIsLostIsNoGain) {
    MadeUp m;
    for (int n = 1; n < 100; ++n) m.energy(0, n) = 0.5;
    // the ledger does not say where it went
    EXPECT_EQ(m.verdict(), bench::study::Verdict::flagged);
    m.energy(2, 1) = 0.5;
    EXPECT_EQ(m.verdict(), bench::study::Verdict::sound);
}

TEST(Outcome, EnergyThatIsDissipatedOnPaperAndKeptIsAGain) {
    MadeUp m;
    m.energy(2, 10) = 0.5;
    EXPECT_EQ(m.verdict(), bench::study::Verdict::energy_gaining);
}

TEST(Outcome, ALossThatFeedsEnergyInIsAGain) {
    MadeUp m;
    m.energy(2, 10) = -0.5;
    for (int n = 10; n < 100; ++n) m.energy(0, n) = 1.5;  // the ledger closes
    EXPECT_EQ(m.verdict(), bench::study::Verdict::energy_gaining);
}

TEST(Outcome, ColumnsLeftEmptySayNothing) {
    MadeUp m;
    std::fill(m.run.trace.energy.begin(), m.run.trace.energy.end(), 0.0);
    EXPECT_EQ(m.verdict(Balance::none), bench::study::Verdict::sound);
}

TEST(Outcome, ARunThatNothingSpeaksOfIsUnjudgedAndNeverSound) {
    MadeUp m;
    std::fill(m.run.trace.energy.begin(), m.run.trace.energy.end(), 0.0);
    m.run.facts.clear();
    m.scene.strings[0].start.reset();  // nor does its own energy say how far it may swing
    EXPECT_EQ(m.judgement(Balance::none, false).verdict, bench::study::Verdict::unjudged);
    EXPECT_NE(m.judgement(Balance::none, false).detail, "");
    // its reference speaks
    EXPECT_EQ(m.judgement(Balance::none, true).verdict, bench::study::Verdict::sound);
    EXPECT_EQ(judged({}, 0, nan, nan, nan, Balance::none).verdict, bench::study::Verdict::sound);
    EXPECT_EQ(judged({}, nan, 0, nan, nan, Balance::none).verdict, bench::study::Verdict::sound);
    EXPECT_EQ(judged({}, nan, nan, 0, nan, Balance::none).verdict, bench::study::Verdict::sound);
    EXPECT_EQ(judged({}, nan, nan, nan, 0, Balance::none).verdict, bench::study::Verdict::sound);
}

TEST(Outcome, APullIsMeasuredAgainstTheHardestPush) {
    MadeUp m;
    m.run.facts[0].value = -0.9 * 6e-6;
    EXPECT_EQ(m.verdict(), bench::study::Verdict::sound);
    m.run.facts[0].value = -1.1 * 6e-6;
    EXPECT_EQ(m.verdict(), bench::study::Verdict::adhesive);
    // it hardly touches
    m.run.facts = {{"smallest_contact_force", -0.9e-9, "N"}, {"largest_contact_force", 0, "N"}};
    EXPECT_EQ(m.verdict(), bench::study::Verdict::sound);
    m.run.facts = {{"smallest_contact_force", -1.1e-9, "N"}};  // and does not say how it pushes
    EXPECT_EQ(m.verdict(), bench::study::Verdict::adhesive);
}

TEST(Outcome, ATenthOfErrorIsInaccurate) {
    MadeUp m;
    for (int n = 200; n < 300; ++n) m.run.trace.tap[n] *= 1.09;
    EXPECT_EQ(m.verdict(), bench::study::Verdict::sound);
    for (int n = 200; n < 300; ++n) m.run.trace.tap[n] = m.truth.tap[n] * 1.11;
    EXPECT_EQ(m.verdict(), bench::study::Verdict::inaccurate);
    // nothing to be compared with
    EXPECT_EQ(m.judgement(Balance::exact, false).verdict, bench::study::Verdict::sound);
}

TEST(Outcome, WhatAComparisonFlagsIsNeverSound) {
    const auto sound_with = [](auto change) {
        MadeUp m;
        change(m);
        return m.verdict() == bench::study::Verdict::sound;
    };
    EXPECT_TRUE(sound_with([](MadeUp&) {}));
    EXPECT_FALSE(sound_with([](MadeUp& m) {
        m.run.facts.push_back({"psi_out_of_contact", 2e-9, "1"});
    }));
    EXPECT_FALSE(sound_with([](MadeUp& m) {
        m.run.facts.push_back({"modes_above_nyquist", 1, ""});
    }));
    // adhesion
    EXPECT_FALSE(sound_with([](MadeUp& m) { m.run.facts[0].value = -1; }));
    // energy
    EXPECT_FALSE(sound_with([](MadeUp& m) { m.energy(2, 50) = 2e-6, m.energy(1, 50) = 0; }));
}

TEST(Outcome, TheGravestNameWins) {
    const Status stopped{Outcome::not_converged, 3};
    EXPECT_EQ(judged({Outcome::diverged, 3}, 9, 1, 1, 1, Balance::exact).verdict,
              bench::study::Verdict::diverged);
    EXPECT_EQ(judged(stopped, nan, 1, 1, 1, Balance::exact).verdict,
              bench::study::Verdict::not_converged);
    EXPECT_EQ(judged({}, nan, 1, 1, 1, Balance::exact).verdict,
              bench::study::Verdict::energy_gaining);
    EXPECT_EQ(judged({}, nan, nan, 1, 1, Balance::exact).verdict, bench::study::Verdict::adhesive);
    EXPECT_EQ(judged({}, nan, nan, nan, 1, Balance::exact).verdict,
              bench::study::Verdict::inaccurate);
    EXPECT_EQ(judged({}, nan, nan, nan, nan, Balance::exact).verdict,
              bench::study::Verdict::unjudged);
}

}  // namespace
}  // namespace jvari::test

// Two ensembles of one distribution are told apart in 5 % of trials at most; of two, nearly always.
#include "analysis/ensemble.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "reference/certificate.hpp"
#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace jvari {
namespace {

// A run: traits of a sound that differ from run to run as those of a chaotic one do, and not independently.
std::vector<Trait> run_of(std::mt19937& random, double shift, double spread, int traits = 40) {
    std::normal_distribution<double> normal;
    std::vector<Trait> all;
    const double common = normal(random);
    for (int k = 0; k < traits; ++k)
        all.push_back(
            {"third_octave_db", 100.0 * (k + 1), -20.0 + spread * (0.6 * common + 0.8 * normal(random)) + (k == 7 ? shift : 0), 0.1});
    return all;
}
std::vector<std::vector<Trait>> ensemble_of(std::mt19937& random, double shift = 0, double spread = 1) {
    std::vector<std::vector<Trait>> runs;
    for (int k = 0; k < 32; ++k) runs.push_back(run_of(random, shift, spread));
    return runs;
}
int apart(const std::vector<Told>& all) {
    int n = 0;
    for (const Told& t : all) n += t.apart;
    return n;
}

TEST(Ensemble, OfOneDistributionIsToldFromItselfInFivePerCentOfTrialsAtMost) {
    std::mt19937 random(1);
    int alarms = 0;
    for (int trial = 0; trial < 200; ++trial) alarms += apart(told_apart(ensemble_of(random), ensemble_of(random))) > 0;
    EXPECT_LE(alarms, 15);  // 10 are expected at most; 15 is the upper 5 % of a binomial distribution
    RecordProperty("alarms", alarms);
}

TEST(Ensemble, OfAnotherLevelInOneBandIsToldApartThere) {
    std::mt19937 random(2);
    int found = 0, elsewhere = 0;
    for (int trial = 0; trial < 50; ++trial)
        for (const Told& t : told_apart(ensemble_of(random, 2.0), ensemble_of(random)))
            (t.reference.where == 800 ? found : elsewhere) += t.apart;
    EXPECT_GE(found, 45);
    EXPECT_LE(elsewhere, 10);
}

TEST(Ensemble, DifferencesThatAreNotWorthTellingAreNotTold) {
    std::mt19937 random(3);
    EXPECT_EQ(apart(told_apart(ensemble_of(random, 0.05, 1e-6), ensemble_of(random, 0, 1e-6))), 0);
    EXPECT_EQ(apart(told_apart(ensemble_of(random, 0.2, 1e-6), ensemble_of(random, 0, 1e-6))), 1);
}

TEST(Ensemble, ThatIsPartlySilentIsToldApart) {
    std::mt19937 random(4);
    auto silent = ensemble_of(random);
    for (auto& run : silent) run[3].value = std::nan("");
    EXPECT_GE(apart(told_apart(silent, ensemble_of(random))), 1);
}

// A guitar string that buzzes on a fret: after 8 ms its waveform has forgotten the start.
std::vector<std::vector<Trait>> guitars(const std::string& name, double rate, int runs, std::mt19937& random) {
    Scene scene = read_scene("guitar_over_fret");
    scene.duration = 0.1;
    std::uniform_real_distribution<double> start(1 - 1e-6, 1 + 1e-6);
    std::vector<std::vector<Trait>> all;
    for (const auto table : {schemes(), references()})
        for (const Descriptor& d : table)
            for (int k = 0; d.name == name && k < runs; ++k)
                all.push_back(traits_of(run(d, moved(scene, start(random)), {rate, 44100, 60, {}}).trace.column(0), 44100));
    return all;
}

TEST(Ensemble, OfAGuitarOverAFretIsNotToldFromItselfAndIsFromSchemesThatFail) {
    std::mt19937 random(6);
    auto reference = guitars("exact_contact", 0, 128, random);
    ASSERT_EQ(reference.size(), 128u);
    int alarms = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::ranges::shuffle(reference, random);
        alarms += apart(told_apart({reference.begin(), reference.begin() + 32}, {reference.begin() + 32, reference.begin() + 64})) > 0;
    }
    EXPECT_LE(alarms, 15);
    reference.resize(32);
    for (const char* name : {"modal_explicit_penalty", "modal_quadratised_two_point_raw"}) {
        const auto runs = guitars(name, 4 * 44100, 32, random);
        ASSERT_EQ(runs.size(), 32u) << name;
        EXPECT_GT(apart(told_apart(runs, reference)), 10) << name;
    }
    RecordProperty("alarms", alarms);
}

TEST(TwoSamples, OfOneDistributionAreUniformInTheirProbability) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    int below = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<double> a(64), b(64);
        for (double& x : a) x = normal(random);
        for (double& x : b) x = normal(random);
        below += two_sample_p(a, b) < 0.1;
    }
    EXPECT_NEAR(below / 2000.0, 0.1, 0.03);
    EXPECT_EQ(two_sample_p({1, 2, 3}, {1, 2, 3}), 1);
    EXPECT_LT(two_sample_p(std::vector<double>(32, 1.0), std::vector<double>(32, 2.0)), 1e-10);
}

TEST(Discoveries, FollowBenjaminiAndHochberg) {  // their example: 15 tests at 0.05, four are found
    const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                                0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0};
    const auto found = discoveries(p, 0.05);
    for (std::size_t k = 0; k < p.size(); ++k) EXPECT_EQ(found[k], k < 4) << k;
}

TEST(Traits, AreOfLevelDecayAndTone) {
    const double rate = 44100, pi = std::numbers::pi;
    std::vector<double> sound(44100);
    for (std::size_t n = 0; n < sound.size(); ++n) sound[n] = std::exp(-3.0 * n / rate) * std::sin(2 * pi * 1000 * n / rate);
    double fall = 0;
    for (const Trait& f : traits_of(sound, rate)) {
        if (f.kind == "decay_db_per_s" && std::abs(f.where - 1000) < 1) fall = f.value;
        if (f.kind == "centroid_hz") {
            EXPECT_NEAR(f.value, 1000, 5) << f.where;
        }
    }
    EXPECT_NEAR(fall, 20 * 3 / std::log(10.0), 0.3);
}

}  // namespace
}  // namespace jvari

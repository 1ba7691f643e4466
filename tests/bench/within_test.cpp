// The estimate of jvari run --within: its six rules, each on a string of tests/bench/fool that was
// made or drawn to break it, and its answers against the exact solution.
#include "bench/compare/advice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "bench/compare/record/findings.hpp"
#include "bench/store/usage.hpp"
#include "reference/agreement.hpp"
#include "scenes/excitation.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/run.hpp"
#include "tests/c3.hpp"
#include "tests/says.hpp"

namespace jvari {
extern const Descriptor exact_contact, modal_two_point;
namespace {
using namespace bench;
using compare::Advice;

const store::Listener silent;
const compare::Catalogue& catalogue() {
    static const compare::Catalogue all;
    return all;
}

Scene fooling(const std::string& name) {
    return read_scene(JVARI_SOURCE "/tests/bench/fool/" + name + ".toml");
}

Advice advised(const Scene& scene, const std::string& within, const std::string& tap,
               const std::string& scheme = "", std::vector<compare::SchemeOption> options = {}) {
    return compare::advise(
               scene,
               {.within = within, .tap = tap, .scheme = scheme, .options = std::move(options)},
               catalogue(), silent)
        .back();
}

std::string compliance_of(const Advice& a) {
    for (const auto& [name, value] : a.settings.options)
        if (name == "compliance") return value;
    return "";
}

// As long as the advice looks: 8 periods, after the pluck.
Trace judged(const Advice& a, Scene scene, const Descriptor& d, const Settings& settings) {
    scene.duration = free_from(scene) + a.window;
    return run(d, scene, settings).trace;
}
double apart(const Scene& scene, const Trace& a, const Trace& b, const std::string& tap) {
    const auto k = static_cast<int>(std::ranges::find(b.names, tap) - b.names.begin());
    const double from = free_from(scene);
    return relative_difference(rows_from(a.column(k), from, 44100),
                               rows_from(b.column(k), from, 44100));
}

TEST(Advice, EstimatesByTheDifferenceOfTwoRunsThatAnyoneCanMake) {
    const Scene c3 = c3_release();
    const Advice a = advised(c3, "1%", "nut");
    ASSERT_TRUE(a.within);
    EXPECT_GE(a.finer.modes, 1.5 * a.settings.modes);
    EXPECT_EQ(a.finer.sample_rate, 2 * a.settings.sample_rate);
    EXPECT_LE(a.margin * a.counted, 0.01);
    const Trace coarse = judged(a, c3, *a.scheme, a.settings),
                fine = judged(a, c3, *a.scheme, a.finer),
                truth = judged(a, c3, exact_contact, {0, 44100, 532, {{"compliance", "matched"}}});
    EXPECT_NEAR(a.difference, apart(c3, coarse, fine, "nut"), 1e-12);
    const double error = apart(c3, coarse, truth, "nut");
    EXPECT_GT(a.difference, 0.5 * error);
    EXPECT_LT(a.difference, 2 * error);
    EXPECT_NEAR(a.window * 130.9, 8, 0.05);  // periods of C3
    // at this rate the string's stiffness leaves 1.45 times the modes to twice the rate
    const Advice dear = advised(c3, "0.1%", "nut");
    EXPECT_EQ(dear.settings.sample_rate, 4 * 44100);
    EXPECT_GE(dear.finer.modes, 1.5 * dear.settings.modes);
}

// Making a scheme with matched compliance takes as long as many of its rows.
TEST(Advice, MakesNoSchemeTwice) {
    static std::multiset<std::string> settings_of_makes;
    Descriptor counted = modal_two_point;
    counted.make = [](const Descriptor& d, const Scene& scene, const Settings& s) {
        settings_of_makes.insert(compare::settings_text(d, s));
        return modal_two_point.make(d, scene, s);
    };
    compare::Catalogue all;
    for (const Descriptor*& d : all.schemes)
        if (d->name == std::string_view(counted.name)) d = &counted;
    compare::advise(c3_release(), {.within = "0.1%", .tap = "nut", .scheme = counted.name}, all,
                    silent);
    EXPECT_GT(settings_of_makes.size(), 4u);
    for (const std::string& one : settings_of_makes)
        EXPECT_EQ(settings_of_makes.count(one), 1u) << one;
}

TEST(Advice, IsTrueOnStringsThatWereMadeToFoolIt) {
    // modes of the exact solution; half of them change no tap by more than 2e-4
    const std::pair<const char*, int> strings[] = {
        {"graze5", 768}, {"nohit1", 1536}, {"wide0", 348}, {"wide2", 784}, {"drawn_s021", 864}};
    int answers = 0;
    for (const auto& [name, modes] : strings) {
        const Scene scene = fooling(name);
        const Trace truth = judged(advised(scene, "10%", "nut"), scene, exact_contact,
                                   {0, 44100, modes, {{"compliance", "matched"}}});
        for (const char* scheme : {"modal_two_moment", "modal_two_point"})
            for (const char* tap : {"nut", "y03"})
                for (const double most : {0.3, 0.1, 0.03, 0.01}) {
                    const Advice a = advised(scene, std::to_string(most), tap, scheme);
                    if (!a.within) continue;
                    ++answers;
                    EXPECT_LE(apart(scene, judged(a, scene, *a.scheme, a.settings), truth, tap),
                              most)
                        << name << " " << tap << ": " << compare::text_of(a);
                }
    }
    EXPECT_GT(answers, 40);
}

TEST(Advice, ADifferenceCountsAsAThirdOfThatAtTheRateBeforeAtLeast) {
    // 0.28 % at 88.2 kHz, 1.4 % at 44.1 kHz
    const Advice a = advised(c3_release(), "1.2%", "nut", "modal_two_point");
    ASSERT_TRUE(a.within);
    EXPECT_GT(a.counted, 1.2 * a.difference);
    EXPECT_TRUE(says(compare::text_of(a), "a third of what the rate below moved by"));
}

TEST(Advice, ASilentTapIsNoAnswerAndTheRateAfterItCountsAsAThirdOfAWhole) {
    // up to 176.4 kHz the string passes above its barrier; at 352.8 kHz two runs differ by 32 %
    const Advice a = advised(fooling("nohit3"), "82%", "bridge", "modal_two_point");
    ASSERT_TRUE(a.within);
    EXPECT_EQ(a.settings.sample_rate, 16 * 44100);
}

TEST(Advice, IsMatchedWhereMostModesCanBeMatchedAndOwnElsewhere) {
    EXPECT_EQ(compliance_of(advised(c3_release(), "1%", "nut")), "matched");
    // all but a few modes of a wide footprint are refused: their errors agree, and are large
    const Advice wide = advised(fooling("wide2"), "10%", "nut", "modal_two_point");
    EXPECT_EQ(compliance_of(wide), "own");
}

TEST(Advice, OfAProfileDoublesItsPointsToo) {
    Scene scene = fooling("drawn_s019");
    scene.strings.front().tension *= 100;  // 300 Hz: fewer modes
    const Advice a = advised(scene, "100%", "y03");
    ASSERT_TRUE(a.within);
    EXPECT_EQ(a.finer.options.back(), std::pair(std::string("points"), std::string("32")));
    EXPECT_TRUE(says(compare::text_of(a), "and 32 points"));
}

TEST(Advice, IsRefusedOfSchemesWhoseErrorTwoRunsCannotSee) {
    const Scene c3 = c3_release();
    for (const char* scheme : {"finite_difference_theta", "modal_explicit_penalty"})
        EXPECT_THROW(advised(c3, "10%", "nut", scheme), Refusal) << scheme;
    EXPECT_THROW(advised(c3, "10%", "nut", "modal_spatial_newton", {{"", "compliance", "own"}}),
                 Refusal);
    EXPECT_TRUE(advised(c3, "10%", "nut", "modal_spatial_newton").within);
    EXPECT_THROW(compare::advise(c3, {.within = "1dB", .measure = "decay"}, catalogue(), silent),
                 store::UsageError);
}

TEST(Advice, AsksForThirdOctavesOfTheWholeRunWhereTheWaveformCannotBeHad) {
    Scene guitar = read_scene("guitar_over_fret");
    guitar.duration = 0.5;
    const auto all = compare::advise(guitar, {}, catalogue(), silent);
    ASSERT_EQ(all.size(), 2);
    EXPECT_FALSE(all[0].within);
    EXPECT_TRUE(says(compare::text_of(all[0]), "nothing is known to be within 1 %"));
    EXPECT_TRUE(all[1].within);
    EXPECT_EQ(all[1].window, 0.5);
    EXPECT_TRUE(says(compare::text_of(all[1]), "third-octave difference"));
}

TEST(Advice, BeginsWithHowLongTheWaveformIsKnownWhereItCannotBeHad) {
    Scene guitar = read_scene("guitar_over_fret");
    guitar.duration = 1;
    const auto all = compare::advise(guitar, {.measure = "l2_whole"}, catalogue(), silent);
    ASSERT_EQ(all.size(), 2);
    const Advice& waveform = all.front();
    ASSERT_FALSE(waveform.within);
    const double known = waveform.known_for;
    const Trace coarse = judged(waveform, guitar, *waveform.scheme, waveform.settings),
                fine = judged(waveform, guitar, *waveform.scheme, waveform.finer);
    const auto tap =
        static_cast<int>(std::ranges::find(fine.names, waveform.tap) - fine.names.begin());
    const auto over = [&](double window) {
        return relative_difference(coarse.column(tap), fine.column(tap), 44100, window);
    };
    EXPECT_GT(known, 0.01);
    EXPECT_LE(waveform.margin * over(known), 0.1);
    for (double longer = 1.01 * known; longer < 1; longer += 0.01)
        EXPECT_GT(waveform.margin * over(longer), 0.1);
    for (const Advice& a : all)
        EXPECT_EQ(
            compare::text_of(a).find("the waveform of saddle is known to 10 % for the first "), 0)
            << compare::text_of(a);
}

TEST(Within, AComparisonSeeksCellsNearTheAdviceAndSaysWhetherItHeld) {
    compare::CompareRequest r;
    r.scene = "tanpura_c3_release";
    r.schemes = {"modal_two_point"};
    r.rates = {88200, 176400};
    r.duration = 0.06;
    r.reference_modes = 800;
    r.repeats = 1;
    const compare::Comparison c = compare::compare(r, catalogue(), silent);
    ASSERT_TRUE(c.advice && c.advice->within);
    const study::Cells cells = compare::cells_of(c);
    const compare::Verdict v = verdict_on(*c.advice, cells);
    ASSERT_TRUE(v.cell) << v.text;
    EXPECT_EQ(v.says, compare::Verdict::Says::confirmed) << v.text;
    EXPECT_NEAR(c.advice->counted / v.bound.error, 1, 0.4);
    Advice less = *c.advice;
    less.target.most = 0.9 * v.bound.least();
    EXPECT_EQ(verdict_on(less, cells).says, compare::Verdict::Says::refuted);
    less.target.most = v.bound.error;  // nearer than the reference is certain
    EXPECT_EQ(verdict_on(less, cells).says, compare::Verdict::Says::not_known);
    less.settings.modes = 7;
    EXPECT_FALSE(verdict_on(less, cells).cell);
}

}  // namespace
}  // namespace jvari

// jvari trim: what is judged, what is searched, and that nothing on a grid is cheaper by a fifth.
// Costs are counted, not timed: values of state moved in a second.
#include "bench/trim/trim.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include "analysis/error.hpp"
#include "bench/store/records.hpp"
#include "bench/store/usage.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/run.hpp"
#include "tests/says.hpp"

using namespace jvari;
using namespace jvari::bench;

namespace {
const compare::Catalogue& catalogue() {
    static const compare::Catalogue all;
    return all;
}
const store::Listener silent;

double counted(const trim::Model& m, const Scene& left) {
    return m.settings.sample_rate * make_scheme(*m.scheme, left, m.settings)->dofs();
}

trim::Request request(const std::string& scene, const std::string& within) {
    trim::Request r;
    r.scene = scene;
    r.within = within;
    r.duration = 5e-3;
    r.reference_modes = 532;
    r.jobs = 1;
    return r;
}

TEST(Target, IsReadWithTheUnitOfItsMeasureAlone) {
    EXPECT_DOUBLE_EQ(compare::target_of("l2_50ms", "1%").most, 0.01);
    EXPECT_DOUBLE_EQ(compare::target_of("l2_50ms", "0.01").most, 0.01);
    EXPECT_DOUBLE_EQ(compare::target_of("third_octave_db", "1 dB").most, 1);
    EXPECT_DOUBLE_EQ(compare::target_of("l2_50ms", "0.5").most, 0.5);
    EXPECT_DOUBLE_EQ(compare::target_of("l2_50ms", "100%").most, 1);
    EXPECT_DOUBLE_EQ(compare::target_of("third_octave_db", "1").most, 1);
    for (const char* wrong : {"1dB", "", "%", "-1%", "0%", "nan%", "1%%", "1", "0.51"})
        EXPECT_THROW(compare::target_of("l2_50ms", wrong), store::UsageError) << wrong;
    EXPECT_THROW(compare::target_of("decay", "1%"), store::UsageError);
    EXPECT_THROW(compare::target_of("l2", "1%"), store::UsageError);
}

TEST(Measures, AreZeroForTheTruthItselfAndGrowWithWhatIsChanged) {
    std::vector<double> truth, little, much;
    for (int n = 0; n < 8192; ++n) {
        const double t = n / 44100.0,
                     x = std::exp(-20 * t) * (std::sin(2800 * t) + 0.3 * std::sin(9000 * t));
        truth.push_back(x);
        little.push_back(x * std::exp(-1 * t));
        much.push_back(std::exp(-60 * t) * std::sin(2800 * t));
    }
    for (const compare::Target& t : compare::targets()) {
        const auto error = [&](const std::vector<double>& x) {
            return study::error_of(t.measure, x, truth, 44100);
        };
        EXPECT_LT(error(truth), 1e-12) << t.name;
        EXPECT_GT(error(little), 0) << t.name;
        EXPECT_GT(error(much), 2 * error(little)) << t.name;
    }
    // exp(-2 t) more of the energy is gone after t: the curves part by 8.7 dB a second, and a
    // little less at the end
    EXPECT_NEAR(study::error_of(compare::target_of("decay", "1dB").measure, little, truth, 44100),
                1.0, 0.4);
}

TEST(Starts, OthersAreScenesWithAnotherShape) {
    for (const std::string& name : library_scenes()) {
        const Scene own = read_scene(name);
        for (int s = 1; s < trim::starts; ++s) {
            const Scene other = trim::started(own, s);
            EXPECT_NO_THROW(validate(other)) << name;
            EXPECT_NE(other.strings, own.strings) << name;
            EXPECT_EQ(other.strings[0].barriers, own.strings[0].barriers) << name;
        }
    }
}

TEST(Starts, AreOfAnotherFamily) {
    const Scene own = read_scene("tanpura_c3_release");
    const auto initial = [&](int start) { return *trim::started(own, start).strings[0].start; };
    const auto sharp = std::get<TriangleShape>(initial(1));
    EXPECT_EQ(sharp.smoothing, 0);
    EXPECT_LT(std::min(sharp.position, 1 - sharp.position), 0.15);
    EXPECT_GE(std::get<ModeShape>(initial(2)).number, 5);
    const Scene plucked = read_scene("nylon_guitar");
    for (int s = 1; s < trim::starts; ++s) {
        const Pluck &was = *plucked.strings[0].pluck,
                    now = *trim::started(plucked, s).strings[0].pluck;
        EXPECT_GE(std::abs(now.position - was.position), 0.04 * plucked.strings[0].length) << s;
    }
}

// A hammer and an initial velocity are starts as well: five runs that are one verify nothing.
TEST(Starts, HammersAndVelocitiesChangeToo) {
    Scene struck = read_scene("free_string"), thrown = struck;
    String &hammered = struck.strings[0], &moved = thrown.strings[0];
    hammered.start.reset();
    hammered.masses = {{3e-3, 0.12, 0, 2, 0, 1e6, 1, 0}, {1e-3, 0.5, 0, 0, 1e-3, 1e6, 1, 0}};
    moved.start.reset();
    moved.velocity = TriangleShape{0.3, 1, 0.02};
    for (const Scene& own : {struck, thrown}) {
        std::set<std::string> names;
        for (int s = 0; s < trim::starts; ++s) {
            const Scene other = trim::started(own, s);
            EXPECT_NO_THROW(validate(other)) << s;
            EXPECT_EQ(other.strings == own.strings, s == 0) << s;
            names.insert(trim::name_of_start(own, s));
        }
        EXPECT_EQ(names.size(), static_cast<std::size_t>(trim::starts));
    }
    const Mass hard = trim::started(struck, 3).strings[0].masses[0];
    EXPECT_EQ(hard.velocity, 4);
    EXPECT_EQ(trim::started(struck, 3).strings[0].masses[1], hammered.masses[1]);  // at rest
    EXPECT_EQ(trim::name_of_start(struck, 3), "a mass of 4 m/s at 0.42 m");
    EXPECT_EQ(std::get<TriangleShape>(*trim::started(thrown, 1).strings[0].velocity).smoothing, 0);
    EXPECT_EQ(trim::name_of_start(thrown, 1), "a sharp triangle at 0.88 m, 1.5 m/s");
}

TEST(Judge, KeepsWhatIsListenedTo) {
    trim::Request r = request("tanpura_c3_release", "5%");
    r.tap = "thread";
    trim::Judge judge(r, catalogue(), silent, counted);
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k) {
        const Reduction& x = judge.reductions()[k];
        const bool loss = x.part == Part::damping || x.part == Part::damping_term;
        EXPECT_EQ(judge.may_go(k), !loss && x.key != "tap.thread" && x.part != Part::thread &&
                                       x.part != Part::barrier)
            << x.description();
    }
    r.tap = "nuts";
    EXPECT_THROW(trim::Judge(r, catalogue(), silent), store::UsageError);
}

// Fifty milliseconds hardly hear a loss. Where the decay is judged it is judged to the end of the
// scene, and losses may go.
TEST(Judge, LeavesOutLossesByTheDecayAlone) {
    trim::Request r = request("tanpura_c3_release", "1dB");
    r.duration.reset();
    r.reference_modes = 80;
    r.set = {"duration=0.2"};
    for (const char* measure : {"third_octave_db", "decay"}) {
        r.measure = measure;
        const bool decay = r.measure == "decay";
        trim::Judge judge(r, catalogue(), silent, counted);
        EXPECT_DOUBLE_EQ(judge.scene().duration, decay ? 0.2 : 0.05);
        int losses = 0;
        for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k)
            losses +=
                judge.may_go(k) && judge.reductions()[k].key.find("damping") != std::string::npos;
        EXPECT_EQ(losses > 0, decay) << measure;
    }
}

TEST(Judge, KeepsThreadAndBarriersWhereTheirForcesAreListenedTo) {
    trim::Request r = request("tanpura_c3_release", "5%");
    r.tap = "thread";
    for (const char* quantity : {"thread_force", "bridge_force", "driving_force", "nut_force"}) {
        r.set = {"tap.3.quantity=\"" + std::string(quantity) + "\""};
        const trim::Judge judge(r, catalogue(), silent, counted);
        int parts = 0;
        for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k)
            if (const Reduction& x = judge.reductions()[k];
                x.part == Part::thread || x.part == Part::barrier) {
                EXPECT_EQ(judge.may_go(k), quantity == std::string("nut_force"))
                    << quantity << " without " << x.description();
                ++parts;
            }
        EXPECT_EQ(parts, 2);
    }
}

// Every number of modes at every rate, own and matched: with the parts that the search left out,
// and with all parts.
struct Cheapest {
    double cost = HUGE_VAL;
    std::string what;
};
Cheapest of_grid(trim::Judge& judge, const std::vector<int>& left_out) {
    Cheapest best;
    for (const char* scheme : {"modal_two_point", "modal_quadratised"})
        for (const bool matched : {false, true})
            for (const double rate : {44100.0, 88200.0, 176400.0, 352800.0})
                for (int modes = 2; modes <= modes_below(judge.scene().strings[0], 20e3); ++modes) {
                    trim::Model m{left_out, &catalogue().find(scheme), {rate, 44100, modes, {}}};
                    if (matched) m.settings.options = {{"compliance", "matched"}};
                    const double cost = counted(m, judge.scene_of(m));
                    if (cost < best.cost && judge.within(judge.judged(m, 0), 0))
                        best = {cost, m.settings_text()};
                }
    return best;
}

class NothingIsCheaper : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(NothingIsCheaper, OnAGridByMoreThanAFifth) {
    trim::Judge judge(request(GetParam().first, GetParam().second), catalogue(), silent, counted);
    const trim::Path path = trim::search(
        judge, {&catalogue().find("modal_two_point"), &catalogue().find("modal_quadratised")}, {0},
        silent);
    ASSERT_TRUE(path.within_tolerance);
    const trim::Step& last = path.steps.back();
    EXPECT_LE(last.error, judge.target().most);
    const Cheapest left = of_grid(judge, last.model.left_out), whole = of_grid(judge, {});
    EXPECT_GE(left.cost, 0.8 * last.cost) << last.model.settings_text() << " and " << left.what;
    EXPECT_GE(whole.cost, 0.8 * last.cost) << last.model.settings_text() << " and " << whole.what;
    EXPECT_LT(last.cost, path.steps.front().cost);
}
INSTANTIATE_TEST_SUITE_P(TwoScenes, NothingIsCheaper,
                         testing::Values(std::pair{"tanpura_c3_release", "5%"},
                                         std::pair{"two_point_bridge", "20%"}));

TEST(Judge, CountsTheCertificateWithTheError) {
    trim::Request r = request("tanpura_c3_release", "5%");
    r.duration = 50e-3;  // the window that the measure names
    r.reference_modes = 266;
    const trim::Model m{{}, &catalogue().find("modal_two_point"), {176400, 44100, 0, {}}};
    double error = 0, certificate = 0;
    {
        trim::Judge judge(r, catalogue(), silent, counted);
        error = judge.judged(m, 0).error, certificate = judge.certificate(0);
    }
    ASSERT_GT(error, 0);
    ASSERT_GT(certificate, 1e-6);
    for (const double share : {-0.1, 0.9, 1.1}) {  // of the certificate, beyond the error
        r.within = store::text_of(error + share * certificate);
        trim::Judge judge(r, catalogue(), silent, counted);
        EXPECT_EQ(judge.within(judge.judged(m, 0), 0), share > 1) << share;
        trim::Judged flagged = judge.judged(m, 0);
        flagged.verdict = Verdict::adhesive;
        EXPECT_FALSE(judge.within(flagged, 0)) << share;
    }
}

TEST(Search, IsWithinAtEachStepWhichSavesAndKeepsNothingThatWouldSave) {
    trim::Judge judge(request("tanpura_c3_release", "5%"), catalogue(), silent, counted);
    const trim::Path path =
        trim::search(judge, {&catalogue().find("modal_two_point")}, {0}, silent);
    ASSERT_TRUE(path.within_tolerance);
    const trim::Step& last = path.steps.back();
    EXPECT_EQ(judge.scene_of(last.model).taps.size(), 1u);
    for (std::size_t k = 1; k < path.steps.size(); ++k) {
        EXPECT_TRUE(path.steps[k].within) << path.steps[k].change;
        EXPECT_TRUE(judge.within(judge.judged(path.steps[k].model, 0), 0)) << path.steps[k].change;
        EXPECT_TRUE(k == 1 || path.steps[k].cost <= trim::worth * path.steps[k - 1].cost)
            << path.steps[k].change;
    }
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k) {
        const Reduction& r = judge.reductions()[k];
        if (!judge.may_go(k) || r.part == Part::contact_stiffness ||
            std::ranges::count(last.model.left_out, k))
            continue;
        trim::Model m = last.model;
        m.left_out.insert(std::ranges::lower_bound(m.left_out, k), k);
        if (judge.scene_of(m) == judge.scene_of(last.model)) continue;  // it went with another
        EXPECT_FALSE(judge.cost(m) <= trim::worth * last.cost &&
                     judge.within(judge.judged(m, 0), 0))
            << r.description();
    }
}

// Errors repeat to the last digit and a clock does not: what it cannot tell apart they decide.
TEST(Search, FindsTheSameModelWhateverAClocksNoise) {
    const auto found = [](unsigned seed, double noise) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        trim::Judge judge(request("tanpura_c3_release", "10%"), catalogue(), silent,
                          [&](const trim::Model& m, const Scene& left) {
                              return counted(m, left) * std::exp(noise * normal(random));
                          });
        const trim::Model m =
            trim::search(judge, {&catalogue().find("modal_two_point")}, {0}, silent)
                .steps.back()
                .model;
        return std::pair(m.settings_text(), m.left_out);
    };
    const auto quiet = found(0, 0);
    for (unsigned seed = 1; seed < 5; ++seed) EXPECT_EQ(found(seed, 0.02), quiet) << seed;
}

// Of all schemes the same is found as of the one that is found, and what is passed over serves at
// no rate.
TEST(Search, OfAnySchemeFindsTheCheapestAndPassesOverWhatDoesNotServe) {
    trim::Judge judge(request("tanpura_c3_release", "2%"), catalogue(), silent, counted);
    std::vector<const Descriptor*> any;
    for (const char* name : {"finite_difference_explicit", "finite_difference_hamiltonian",
                             "modal_quadratised", "modal_two_point"})
        any.push_back(&catalogue().find(name));
    const trim::Path path = trim::search(judge, any, {0}, silent);
    ASSERT_TRUE(path.within_tolerance);
    double cheapest = HUGE_VAL;
    for (const Descriptor* d : any) {
        const trim::Path alone = trim::search(judge, {d}, {0}, silent);
        if (alone.within_tolerance) {
            cheapest = std::min(cheapest, alone.steps.back().cost);
            continue;
        }
        for (const double rate : {44100.0, 176400.0, 1411200.0})
            EXPECT_FALSE(judge.within(judge.judged({{}, d, {rate, 44100, 0, {}}}, 0), 0))
                << d->name << " " << rate;
    }
    EXPECT_LE(path.steps.back().cost, 1.05 * cheapest);
    ASSERT_FALSE(path.passed_over.empty());
    EXPECT_EQ(path.passed_over.front().find("finite_difference"), 0u) << path.passed_over.front();
}

// No doubling and no certificate: what is within cannot be decided, and that is said instead of
// "none" or "certain to 0 %".
TEST(Trim, AnUnknownOrATooLargeUncertaintyDecidesNothing) {
    trim::Request r = request("tanpura_c3_release", "0.0001%");
    r.scheme = "modal_two_point";
    trim::Judge judge(r, catalogue(), silent, counted);
    ASSERT_GT(judge.certificate(0), 1e-6);
    EXPECT_THROW(trim::trimmed(judge, r, catalogue(), silent), Refusal);
    r.measure = "third_octave_db", r.within = "3dB";
    r.reference = "modal_two_point";  // a stand-in, and no bound is known of third octaves
    trim::Judge by_a_stand_in(r, catalogue(), silent, counted);
    EXPECT_TRUE(std::isnan(by_a_stand_in.certificate(0)));
    EXPECT_FALSE(by_a_stand_in.within({Verdict::sound, 1e-9, 0}, 0));
    EXPECT_THROW(trim::trimmed(by_a_stand_in, r, catalogue(), silent), Refusal);
}

// More --reference-modes, and for waveforms a shorter --duration, which trim names where its
// reference is too uncertain: each leads to a verdict, and at each step on the way the uncertainty
// is no less than what four times the modes change.
TEST(Trim, ItsUncertaintyIsTrueWhicheverRemedyIsFollowed) {
    struct Remedy {
        const char *measure, *within, *text;
        bool shorter;
    };
    const char* both = "A shorter --duration or more --reference-modes may help";
    for (const Remedy& remedy :
         {Remedy{"l2_50ms", "2%", both, false}, Remedy{"l2_50ms", "2%", both, true},
          Remedy{"third_octave_db", "0.1dB", "is 71 dB. More --reference-modes may help", false}}) {
        trim::Request r = request("tanpura_c3_release", remedy.within);
        r.scheme = "modal_two_point";
        r.measure = remedy.measure;
        r.reference_modes = 160;
        bool decided = false;
        int steps = 0;
        for (; !decided && steps < 4; ++steps) {
            trim::Judge judge(r, catalogue(), silent, counted);
            const Scene& scene = judge.scene();
            const jvari::Run finer =
                run(catalogue().find("exact_contact"), scene,
                    {0, r.tap_rate, 4 * r.reference_modes, {{"compliance", "matched"}}});
            const auto tap = static_cast<int>(
                std::ranges::find(scene.taps, judge.tap().name, &Tap::name) - scene.taps.begin());
            const double changed = study::error_of(
                study::measure(r.measure == "l2_50ms" ? "error_l2_whole" : r.measure),
                judge.truth(0).reference.run.trace.column(tap), finer.trace.column(tap),
                r.tap_rate);
            EXPECT_GT(changed, 0);
            EXPECT_GE(judge.certificate(0), changed)
                << r.measure << ", " << r.reference_modes << " modes, " << *r.duration << " s";
            decided = judge.certain(0);
            if (decided) continue;
            try {
                trim::trimmed(judge, r, catalogue(), silent);
                ADD_FAILURE() << "no remedy is named";
            } catch (const Refusal& e) { EXPECT_TRUE(steps > 0 || says(e.what(), remedy.text)); }
            if (remedy.shorter) *r.duration /= 2;
            else r.reference_modes *= 2;
        }
        EXPECT_TRUE(decided && steps > 1) << r.measure << ": no remedy leads to a verdict";
    }
}

TEST(Search, SaysWhereNothingServes) {
    trim::Judge judge(request("tanpura_c3_release", "0.0001%"), catalogue(), silent, counted);
    EXPECT_FALSE(
        trim::search(judge, {&catalogue().find("modal_two_point")}, {0}, silent).within_tolerance);
}

TEST(Search, OptionsThatAreNamedAreTriedInPlaceOfThoseThatTrimTriesByItself) {
    const Descriptor& d = catalogue().find("modal_two_point");
    const Scene scene = read_scene("tanpura_c3_release");
    const auto names = [&](const std::vector<compare::SchemeOption>& options) {
        std::vector<std::string> all;
        for (const trim::Variant& v : trim::variants_of(d, scene, options)) all.push_back(v.name());
        return all;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names({}), (Names{"modal_two_point", "modal_two_point compliance=matched"}));
    EXPECT_EQ(names({{"", "compliance", "own"}, {"", "compliance", "matched"}}),
              (Names{"modal_two_point compliance=own", "modal_two_point compliance=matched"}));
    EXPECT_EQ(names({{"modal_two_point", "compliance", "matched"}}),
              Names{"modal_two_point compliance=matched"});
    EXPECT_EQ(names({{"modal_quadratised", "compliance", "own"}}).size(), 2u);  // of another
    trim::Request r = request("tanpura_c3_release", "5%");
    r.scheme = "modal_two_point";
    r.options = {{"", "compliance", "own"}};
    trim::Judge judge(r, catalogue(), silent, counted);
    const trim::Path path = trim::search(judge, {&d}, {0}, silent);
    ASSERT_TRUE(path.within_tolerance);
    for (std::size_t k = 1; k < path.steps.size(); ++k)
        EXPECT_EQ(path.steps[k].model.settings.options, (OptionValues{{"compliance", "own"}}))
            << path.steps[k].change;
    r.options = {{"", "compliances", "own"}};
    EXPECT_THROW(trim::trimmed(judge, r, catalogue(), silent), store::UsageError);
}

// A number of modes that serves a first mode does not serve a triangle: the search learns of it by
// the verification, and each start that is told has its own truth, error and name.
TEST(Trim, IsVerifiedByStartsThatTheSearchDidNotKnow) {
    trim::Request r = request("tanpura_c3_release", "3%");
    r.scheme = "modal_two_point";
    trim::Judge judge(r, catalogue(), silent, counted);
    const trim::Path by_one = trim::search(judge, {&catalogue().find(r.scheme)}, {0}, silent);
    ASSERT_TRUE(by_one.within_tolerance);
    ASSERT_FALSE(judge.within(judge.judged(by_one.steps.back().model, 1), 1))
        << "another tolerance is needed for this test";
    const trim::Trimmed t = trim::trimmed(judge, r, catalogue(), silent);
    ASSERT_TRUE(t.path.within_tolerance);
    ASSERT_GT(t.independent(), 0);
    ASSERT_EQ(t.verified.size(), static_cast<std::size_t>(trim::starts));
    EXPECT_TRUE(t.verified[0].judged_by && t.verified[2].judged_by);
    // over 5 ms and with 532 modes the force of a sharp corner is not known well enough
    EXPECT_FALSE(t.verified[1].decided);
    EXPECT_GT(t.verified[1].certificate, 0.5 * judge.target().most);
    std::set<std::string> names;
    std::set<double> errors;
    for (const trim::Verified& v : t.verified) {
        EXPECT_TRUE((v.within && v.decided) || v.start == 1) << v.name;
        const Scene scene = trim::started(judge.scene(), v.start);
        EXPECT_EQ(v.name, trim::name_of_start(judge.scene(), v.start));
        names.insert(v.name), errors.insert(v.error);
        // by hand: the trimmed model against the whole scene, both from this start
        const jvari::Run truth = run(catalogue().find("exact_contact"), scene,
                                     {0, 44100, r.reference_modes, {{"compliance", "matched"}}});
        const trim::Model& m = t.last().model;
        const jvari::Run repeated = run(*m.scheme, judge.scene_of(m, v.start), m.settings);
        EXPECT_NEAR(relative_l2(repeated.trace.column(0), truth.trace.column(0), 44100), v.error,
                    1e-6)
            << v.name;
    }
    EXPECT_EQ(names.size(), t.verified.size());
    EXPECT_EQ(errors.size(), t.verified.size());
    const std::string toml = trim::trimmed_toml(t, judge);
    for (const trim::Verified& v : t.verified)
        EXPECT_EQ(toml.find(v.name + ", which the search did not know") != std::string::npos,
                  v.decided && !v.judged_by)
            << toml;
}

TEST(Trim, WritesASceneThatIsReadWhateverItsNameHolds) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("jvari-trim-names-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    Scene scene = read_scene("free_string");
    scene.name = "x\" duration = 7 [[string]] #";
    std::ofstream(folder / "scene.toml") << write_scene(scene);
    trim::Request r = request((folder / "scene.toml").string(), "10%");
    r.scheme = "modal_two_point";
    trim::Judge judge(r, catalogue(), silent, counted);
    const trim::Trimmed t = trim::trimmed(judge, r, catalogue(), silent);
    ASSERT_TRUE(t.path.within_tolerance);
    const Scene back = parse_scene(trim::trimmed_toml(t, judge), "trimmed.toml");
    EXPECT_EQ(back.name, scene.name + "_trimmed");
    EXPECT_EQ(back.strings, t.scene.strings);
    std::filesystem::remove_all(folder);
}

TEST(Trim, IsTakenUpWhereItWasStoppedAndVerifiedByAnotherStart) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("jvari-trim-" + std::to_string(getpid()));
    trim::Request r = request("free_string", "10%");
    r.scheme = "modal_two_point";
    r.out = folder.string();
    std::string first;
    long first_files = 0;
    for (int k = 0; k < 2; ++k) {
        trim::Judge judge(r, catalogue(), silent, counted);
        const trim::Trimmed t = trim::trimmed(judge, r, catalogue(), silent);
        ASSERT_TRUE(t.path.within_tolerance);
        ASSERT_GE(t.verified.size(), 2u);
        EXPECT_TRUE(t.verified.back().within);
        const std::string toml = trim::trimmed_toml(t, judge);
        const Scene back = parse_scene(toml, "trimmed.toml");
        EXPECT_EQ(back.strings, t.scene.strings);
        for (const int part : t.last().model.left_out)
            EXPECT_TRUE(says(toml, judge.reductions()[part].description()));
        EXPECT_TRUE(says(toml, trim::command_of(t, "trimmed.toml")));
        const auto path = trim::path_table(t, judge);
        EXPECT_EQ(path.rows.size(), t.path.steps.size());
        // the page reads columns of these names
        const bench::store::Folder record{JVARI_SOURCE "/results/trim/two_point_bridge-10"};
        EXPECT_EQ(path.columns, record.table("path").columns);
        EXPECT_EQ(trim::needs_table(t).columns, record.table("needs").columns);
        if (k == 0) first = trim::command_of(t, "");
        else EXPECT_EQ(trim::command_of(t, ""), first);
        const long files = std::distance(std::filesystem::directory_iterator(folder / "cells"), {});
        EXPECT_GE(files, 2);
        if (k == 0) first_files = files;
        else EXPECT_EQ(files, first_files);  // nothing was made again that is kept
    }
    std::filesystem::remove_all(folder);
}
}  // namespace

// jvari trim: what is judged, what is searched, and that nothing on a grid is cheaper by a fifth. Costs are counted, not timed: values of
// state moved in a second.
#include "bench/trim/trim.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bench/store/usage.hpp"
#include "bench/trim/trim_record.hpp"
#include "scenes/modes.hpp"
#include "scenes/scene_file.hpp"

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
    r.reference_modes = 1064;
    r.jobs = 1;
    return r;
}

TEST(Target, IsReadWithTheUnitOfItsMeasureAlone) {
    EXPECT_DOUBLE_EQ(trim::target_of("l2_50ms", "1%").most, 0.01);
    EXPECT_DOUBLE_EQ(trim::target_of("l2_50ms", "0.01").most, 0.01);
    EXPECT_DOUBLE_EQ(trim::target_of("third_octave_db", "1 dB").most, 1);
    for (const char* wrong : {"1dB", "", "%", "-1%", "0%", "nan%", "1%%"})
        EXPECT_THROW(trim::target_of("l2_50ms", wrong), store::UsageError) << wrong;
    EXPECT_THROW(trim::target_of("decay", "1%"), store::UsageError);
    EXPECT_THROW(trim::target_of("l2", "1%"), store::UsageError);
}

TEST(Measures, AreZeroForTheTruthItselfAndGrowWithWhatIsChanged) {
    std::vector<double> truth, little, much;
    for (int n = 0; n < 8192; ++n) {
        const double t = n / 44100.0, x = std::exp(-20 * t) * (std::sin(2800 * t) + 0.3 * std::sin(9000 * t));
        truth.push_back(x);
        little.push_back(x * std::exp(-1 * t));
        much.push_back(std::exp(-60 * t) * std::sin(2800 * t));
    }
    for (const trim::Measure& m : trim::measures()) {
        EXPECT_LT(m.error(truth, truth, 44100), 1e-12) << m.name;
        EXPECT_GT(m.error(little, truth, 44100), 0) << m.name;
        EXPECT_GT(m.error(much, truth, 44100), 2 * m.error(little, truth, 44100)) << m.name;
    }
    // exp(-2 t) more of the energy is gone after t: the curves part by 8.7 dB a second, and a little less at the end
    EXPECT_NEAR(trim::target_of("decay", "1dB").measure->error(little, truth, 44100), 1.0, 0.4);
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

TEST(Judge, KeepsWhatIsListenedTo) {
    trim::Request r = request("tanpura_c3_release", "5%");
    r.tap = "thread";
    trim::Judge judge(r, catalogue(), silent, counted);
    for (int k = 0; k < static_cast<int>(judge.reductions().size()); ++k) {
        const Reduction& x = judge.reductions()[k];
        EXPECT_EQ(judge.may_go(k), x.key != "tap.thread" && x.part != Part::thread && x.part != Part::barrier) << x.said();
    }
    r.tap = "nuts";
    EXPECT_THROW(trim::Judge(r, catalogue(), silent), store::UsageError);
}

// Every number of modes at every rate, own and matched: with the parts that the search left out, and with all parts.
struct Cheapest {
    double cost = HUGE_VAL;
    std::string what;
};
Cheapest of_grid(trim::Judge& judge, const std::vector<int>& left_out) {
    Cheapest best;
    for (const char* scheme : {"modal_two_point", "modal_strang"})
        for (const bool matched : {false, true})
            for (const double rate : {44100.0, 88200.0, 176400.0, 352800.0})
                for (int modes = 2; modes <= modes_below(judge.scene().strings[0], 20e3); ++modes) {
                    trim::Model m{left_out, &catalogue().find(scheme), {rate, 44100, modes, {}}};
                    if (matched && scheme == std::string("modal_two_point")) m.settings.options = {{"compliance", "matched"}};
                    const double cost = counted(m, judge.scene_of(m));
                    if (cost < best.cost && judge.within(judge.verdict(m, 0), 0)) best = {cost, m.settings_text()};
                }
    return best;
}

class NothingIsCheaper : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(NothingIsCheaper, OnAGridByMoreThanAFifth) {
    trim::Judge judge(request(GetParam().first, GetParam().second), catalogue(), silent, counted);
    const trim::Path path = trim::search(judge, {&catalogue().find("modal_two_point"), &catalogue().find("modal_strang")}, 1, silent);
    ASSERT_TRUE(path.found);
    const trim::Step& last = path.steps.back();
    EXPECT_LE(last.error, judge.target().most);
    const Cheapest left = of_grid(judge, last.model.left_out), whole = of_grid(judge, {});
    EXPECT_GE(left.cost, 0.8 * last.cost) << last.model.settings_text() << " and " << left.what;
    EXPECT_GE(whole.cost, 0.8 * last.cost) << last.model.settings_text() << " and " << whole.what;
    EXPECT_LT(last.cost, path.steps.front().cost);
}
INSTANTIATE_TEST_SUITE_P(TwoScenes, NothingIsCheaper,
                         testing::Values(std::pair{"tanpura_c3_release", "5%"}, std::pair{"two_point_bridge", "20%"}));

TEST(Search, SaysWhereNothingServes) {
    trim::Judge judge(request("tanpura_c3_release", "0.0001%"), catalogue(), silent, counted);
    EXPECT_FALSE(trim::search(judge, {&catalogue().find("modal_two_point")}, 1, silent).found);
}

TEST(Trim, IsTakenUpWhereItWasStoppedAndVerifiedByAnotherStart) {
    const auto folder = std::filesystem::temp_directory_path() / ("jvari-trim-" + std::to_string(getpid()));
    trim::Request r = request("free_string", "10%");
    r.scheme = "modal_two_point";
    r.out = folder.string();
    std::string first;
    long first_files = 0;
    for (int k = 0; k < 2; ++k) {
        trim::Judge judge(r, catalogue(), silent, counted);
        const trim::Trimmed t = trim::trimmed(judge, r, catalogue(), silent);
        ASSERT_TRUE(t.path.found);
        ASSERT_GE(t.verified.size(), 2u);
        EXPECT_TRUE(t.verified.back().within);
        const std::string toml = trim::trimmed_toml(t, judge);
        const Scene back = parse_scene(toml, "trimmed.toml");
        EXPECT_EQ(back.strings, t.scene.strings);
        for (const int part : t.last().model.left_out) EXPECT_NE(toml.find(judge.reductions()[part].said()), std::string::npos);
        EXPECT_NE(toml.find(trim::command_of(t, "trimmed.toml")), std::string::npos);
        EXPECT_EQ(trim::path_table(t, judge).rows.size(), t.path.steps.size());
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

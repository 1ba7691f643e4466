// What every scheme and reference owes the program, on every scene of the library and a few made here: one suite over all of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "reference/references.hpp"
#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"
#include "tests/allocations.hpp"
#include "tests/c3.hpp"

namespace jvari {
namespace {

constexpr double tap_rate = 44100;

std::vector<Scene> all_scenes() {
    std::vector<Scene> scenes;
    for (const std::string& name : library_scenes()) scenes.push_back(read_scene(name));
    scenes.push_back(c3_free());
    scenes.back().name = "rest";
    scenes.push_back(lossless(c3_release()));
    scenes.back().name = "lossless_release";
    scenes.push_back(lossless(c3_free()));
    scenes.back().name = "lossless_free";
    scenes.back().strings.front().initial = ModeInitial{2, 1e-3};
    scenes.push_back(c3_pluck());
    scenes.back().name = "pluck_that_starts_and_ends_between_rows";
    scenes.back().strings.front().pluck->start = 1.01e-3;
    scenes.back().strings.front().pluck->duration = 2.003e-3;
    for (Scene& s : scenes) s.duration = 200 / tap_rate;
    return scenes;
}

struct Case {
    Descriptor scheme;
    Scene scene;
    Settings settings;
    friend void PrintTo(const Case& c, std::ostream* out) { *out << c.scheme.name << " on " << c.scene.name; }
};

std::vector<Case> cases(bool represented) {
    std::vector<Case> chosen;
    for (const auto& table : {schemes(), references()})
        for (const Descriptor& d : table)
            for (const Scene& scene : all_scenes())
                if ((needed_by(scene) - d.represents).empty() == represented) {
                    chosen.push_back({d, scene, {4 * tap_rate, tap_rate, 40, {}}});
                    if (d.clock == Clock::continuous && represented && needed_by(scene).has(Feature::profile_barrier))
                        chosen.back().settings.options = {{"nodes", "6"}};  // points on the profile: what is owed does not depend on them
                }
    return chosen;
}

// The scheme, or nothing where it refuses the scene for a reason of its own (a missing option, a grid).
std::unique_ptr<Scheme> make(const Case& c) {
    try {
        return make_scheme(c.scheme, c.scene, c.settings);
    } catch (const Refusal& refusal) {
        EXPECT_GT(std::string(refusal.what()).size(), 20u);
        return nullptr;
    }
}

class Refusals : public testing::TestWithParam<Case> {};
class Contract : public testing::TestWithParam<Case> {};

TEST_P(Refusals, NameWhatIsMissing) {
    const Case& c = GetParam();
    try {
        make_scheme(c.scheme, c.scene, c.settings);
        FAIL() << "not refused";
    } catch (const Refusal& refusal) {
        const std::string missing = names_of(needed_by(c.scene) - c.scheme.represents);
        EXPECT_NE(std::string(refusal.what()).find(missing), std::string::npos) << refusal.what();
    }
}

TEST_P(Contract, AllocatesNothingWhileStepping) {
    const Case& c = GetParam();
    const auto scheme = make(c);
    if (!scheme) GTEST_SKIP();
    const int taps = static_cast<int>(c.scene.taps.size());
    std::vector<double> tap(64 * taps), energy(64 * 3);
    scheme->reset();
    const Allocations allocations;
    scheme->advance({64, taps, 64, tap.data(), nullptr});
    scheme->advance({64, taps, 64, tap.data(), energy.data()});
    scheme->reset();
    EXPECT_EQ(allocations.count(), 0);
}

TEST_P(Contract, GivesTheSameBitsWhateverTheBlockSizeTheProbeAndTheRunBefore) {
    const Case& c = GetParam();
    const auto scheme = make(c);
    if (!scheme) GTEST_SKIP();
    const auto first = run(*scheme, c.scene, c.settings, {.block_rows = 64});
    if (c.scheme.balance != Balance::none) {  // a control may leave its energy budget, which is seen sooner with the probe
        ASSERT_EQ(first.status.outcome, Outcome::ok);
    }
    for (const int rows : {1, 7, 64, 1000})
        for (const bool energy : {false, true}) {
            const auto again = run(*scheme, c.scene, c.settings, {.energy = energy, .block_rows = rows});
            const long common = std::min(first.trace.rows, again.trace.rows);
            if (first.status.outcome == Outcome::ok && again.status.outcome == Outcome::ok) {
                ASSERT_EQ(again.trace.rows, first.trace.rows);
            }
            ASSERT_GT(common, 0);
            for (int k = 0; k < first.trace.taps(); ++k) {
                const auto one = first.trace.column(k).first(common), other = again.trace.column(k).first(common);
                EXPECT_TRUE(std::equal(one.begin(), one.end(), other.begin())) << rows << " rows a block, energy " << energy;
            }
        }
}

TEST_P(Contract, KeepsItsEnergyBalanceAndDissipatesWithoutSupply) {
    const Case& c = GetParam();
    const auto scheme = c.scheme.balance != Balance::none ? make(c) : nullptr;
    if (!scheme) GTEST_SKIP();
    const auto r = run(*scheme, c.scene, c.settings, {.energy = true});
    const auto stored = r.trace.energy_column(0), supplied = r.trace.energy_column(1), dissipated = r.trace.energy_column(2);
    const double scale = std::max(1e-30, *std::max_element(stored.begin(), stored.end()));
    const double bound = (c.scheme.balance == Balance::exact ? 1e-11 : 1e-8) * scale;
    EXPECT_EQ(supplied[0], 0);
    EXPECT_EQ(dissipated[0], 0);
    for (long n = 1; n < r.trace.rows; ++n) {
        ASSERT_LE(std::abs(stored[n] - stored[n - 1] - supplied[n] + dissipated[n]), bound) << "row " << n;
        ASSERT_GE(stored[n], -bound);
        if (needed_by(c.scene).has(Feature::profile_barrier) && c.scheme.balance == Balance::to_tolerance)
            continue;  // a rigid-profile rule may give energy; its scheme reports how much
        ASSERT_GE(dissipated[n], -bound) << "row " << n;
    }
}

TEST_P(Contract, StartsFromTheScenesInitialState) {
    const Case& c = GetParam();
    const auto scheme = make(c);
    if (!scheme) GTEST_SKIP();
    const auto r = run(*scheme, c.scene, c.settings, {});
    for (int k = 0; k < r.trace.taps(); ++k) {
        const Quantity q = c.scene.taps[k].quantity;
        const bool contact_force = q == Quantity::bridge_force || q == Quantity::thread_force || q == Quantity::driving_force;
        if (contact_force || !needed_by(c.scene).has(Feature::initial_shape)) {
            EXPECT_EQ(r.trace.column(k)[0], 0) << r.trace.names[k];
        }
        for (const double v : r.trace.column(k)) ASSERT_TRUE(std::isfinite(v));
    }
}

TEST_P(Contract, CarriesNoMoreStateThanTheSceneNeeds) {
    const Case& c = GetParam();
    const auto scheme = make(c);
    if (!scheme) GTEST_SKIP();
    EXPECT_GT(scheme->dofs(), 0);
    Case bare = c;  // without what it listens to, is struck by and rests on
    bare.scene.taps.resize(1);
    for (String& s : bare.scene.strings) {
        s.pluck.reset();
        s.thread.reset();
        s.barriers.clear();
        s.polarisation.reset();
    }
    std::erase_if(bare.scene.taps, [](const Tap& t) { return t.quantity != Quantity::displacement && t.quantity != Quantity::nut_force; });
    if (const auto other = make(bare)) {
        EXPECT_LE(other->dofs(), scheme->dofs());
    }
    Case quiet = c;
    quiet.scene.taps.resize(1);
    if (const auto other = make(quiet)) {
        EXPECT_EQ(other->dofs(), scheme->dofs());
    }
}

const auto name_of_case = [](const testing::TestParamInfo<Case>& c) {
    return std::string(c.param.scheme.name) + "__" + c.param.scene.name;
};
INSTANTIATE_TEST_SUITE_P(All, Refusals, testing::ValuesIn(cases(false)), name_of_case);
INSTANTIATE_TEST_SUITE_P(All, Contract, testing::ValuesIn(cases(true)), name_of_case);

TEST(Allocations, AreCounted) {
    const Allocations allocations;
    const std::vector<Scene> scenes(1);
    EXPECT_GT(allocations.count(), 0);
}

// Without barrier and thread a modal scheme is the exact solution: without losses to rounding.
TEST(LinearScene, ModalSchemesReachTheClosedForm) {
    if (references().empty()) GTEST_SKIP();
    Scene scene = lossless(c3_free());
    scene.strings.front().initial = TriangleInitial{0.3, 1e-3, 0.02};
    scene.duration = 1;
    const Settings settings{tap_rate, tap_rate, 133, {}};
    ASSERT_STREQ(references()[0].name, "exact_linear");
    const auto truth = run(references()[0], scene, settings);
    for (const Descriptor& d : schemes()) {
        if (std::string(d.name) != "modal_two_point" && std::string(d.name) != "modal_spatial_newton") continue;
        const auto r = run(d, scene, settings);
        for (int k = 0; k < r.trace.taps(); ++k) {
            double difference = 0, norm = 0;
            for (long n = 0; n < r.trace.rows; ++n) {
                difference += std::pow(r.trace.column(k)[n] - truth.trace.column(k)[n], 2);
                norm += std::pow(truth.trace.column(k)[n], 2);
            }
            EXPECT_LT(std::sqrt(difference / norm), 1e-10) << d.name << " " << r.trace.names[k];
        }
    }
}

}  // namespace
}  // namespace jvari

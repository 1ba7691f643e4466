// What can be left out of a scene: one list for the minimiser and trim.
#include "scenes/reduction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenes/scene_file.hpp"

using namespace jvari;

namespace {
const Reduction& named(const std::vector<Reduction>& all, const std::string& description) {
    const auto found = std::ranges::find_if(
        all, [&](const Reduction& r) { return r.description() == description; });
    if (found == all.end()) throw std::runtime_error("no reduction " + description);
    return *found;
}

TEST(Reductions, EachOfEveryLibrarySceneChangesItAndLeavesAScene) {
    for (const std::string& name : library_scenes()) {
        const Scene whole = read_scene(name);
        std::set<std::string> descriptions;
        for (const Reduction& r : reductions_of(whole)) {
            Scene left = whole;
            r.apply(left);
            EXPECT_NE(left, whole) << name << ": " << r.description();
            remove_idle_taps(left);
            EXPECT_NO_THROW(validate(left)) << name << ": " << r.description();
            EXPECT_TRUE(descriptions.insert(r.description()).second)
                << name << ": " << r.description() << " comes twice";
        }
    }
}

TEST(Reductions, AllTogetherInTheOrderOfTheListLeaveABareString) {
    for (const std::string& name : library_scenes()) {
        Scene left = read_scene(name);
        const std::string last = left.taps.front().name;
        const bool pluck = left.strings.front().pluck.has_value();
        for (const Reduction& r : reductions_of(left))
            if (r.key != "string.0" && r.key != "tap." + last && r.part != Part::pluck &&
                r.part != Part::initial_shape)
                r.apply(left);
        ASSERT_EQ(left.strings.size(), 1u) << name;
        const String& s = left.strings.front();
        EXPECT_TRUE(s.barriers.empty() && !s.thread && !s.polarisation && s.bending_stiffness == 0)
            << name;
        EXPECT_TRUE(std::holds_alternative<NoDamping>(s.damping)) << name;
        EXPECT_EQ(s.pluck.has_value(), pluck) << name;
    }
}

TEST(Reductions, AContactOfExponentOneHasTheForceOfTheOtherAtThePenetration) {
    constexpr double eta = 3e-7;
    Scene s = read_scene("two_point_bridge");
    const auto& before = std::get<LumpedBarrier>(s.strings[0].barriers[0]);
    const double force = before.stiffness.k * std::pow(eta, before.exponent);
    named(reductions_of(s, eta), "string.0.barrier.0.exponent = 1").apply(s);
    const auto& after = std::get<LumpedBarrier>(s.strings[0].barriers[0]);
    EXPECT_EQ(after.exponent, 1);
    EXPECT_NEAR(after.stiffness.k * eta, force, 1e-12 * force);
}

TEST(Reductions, ATermOfALawGoesAloneAndALawOfOneTermGoesWhole) {
    Scene s = read_scene("tanpura_c3_release");
    named(reductions_of(s), "string.0.damping.sigma1 = 0").apply(s);
    const auto& law = std::get<PolynomialDamping>(s.strings[0].damping);
    EXPECT_EQ(law.sigma1, 0);
    EXPECT_GT(law.sigma0, 0);
    named(reductions_of(s), "string.0.damping.sigma3 = 0").apply(s);
    // sigma0 alone is left
    for (const Reduction& r : reductions_of(s))
        EXPECT_NE(r.part, Part::damping_term) << r.description();
    EXPECT_NO_THROW(named(reductions_of(s), "string.0.damping left out"));
}

TEST(Reductions, AStringGoesWithItsTapsAndTheOthersKeepTheirs) {
    Scene s = read_scene("tanpura_drone");
    s.taps.push_back({"g2", Quantity::nut_force, 0, 0});
    s.taps.push_back({"c2", Quantity::nut_force, 3, 0});
    const String last = s.strings[3];
    named(reductions_of(s), "string.0 left out").apply(s);
    ASSERT_EQ(s.strings.size(), 3u);
    EXPECT_EQ(s.strings[2], last);
    EXPECT_TRUE(std::ranges::none_of(s.taps, [](const Tap& t) { return t.name == "g2"; }));
    EXPECT_EQ(*std::ranges::find(s.taps, "c2", &Tap::name)->string, 2);
    EXPECT_EQ(std::ranges::find(s.taps, "nut", &Tap::name)->string, std::nullopt);
}

TEST(Reductions, TapsOfForcesThatNothingMakesGoAndTheOneThatIsKeptStays) {
    Scene s = read_scene("tanpura_c3_release");
    named(reductions_of(s), "string.0.thread left out").apply(s);
    Scene kept = s;
    remove_idle_taps(s);
    remove_idle_taps(kept, "thread");
    EXPECT_EQ(s.taps.size(), 3u);
    EXPECT_EQ(kept.taps.size(), 4u);
}
}  // namespace

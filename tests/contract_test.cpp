// Every scheme and reference keeps every promise of bench/check, on every scene: each promise,
// scheme and scene is a test.
#include <gtest/gtest.h>

#include <algorithm>

#include "bench/check/allocations.hpp"
#include "bench/check/promise.hpp"
#include "reference/references.hpp"
#include "schemes/controls.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::check {
namespace {

class Kept : public testing::Test {
public:
    Kept(const Promise& promise, Case instance) : promise_(promise), case_(std::move(instance)) {}
    void TestBody() override {
        const Verdict v = verdict_on(promise_, case_);
        EXPECT_FALSE(v.broken()) << case_.scheme.name << ": " << v.why;
        if (v.answer == Verdict::Answer::excused || v.answer == Verdict::Answer::not_asked)
            GTEST_SKIP() << v.why;
    }

private:
    const Promise& promise_;
    const Case case_;
};

void register_all() {
    for (const auto table :
         {schemes(), references(), std::span<const Descriptor>(schemes_of_pairings())})
        for (const Descriptor& d : table)
            for (const Promise& p : promises())
                for (const Case& one : cases_of(d, p.scope)) {
                    const std::string name =
                        std::string(d.name) + (one.scene.name.empty() ? "" : "__" + one.scene.name);
                    testing::RegisterTest(
                        p.name, name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                        [&p, one]() -> testing::Test* { return new Kept(p, one); });
                }
}

TEST(Allocations, AreCounted) {
    const Allocations allocations;
    const std::vector<Scene> scenes(1);
    EXPECT_GT(allocations.count(), 0);
}

TEST(Scenes, TouchTheBarriersThatTheyHave) {
    for (Scene scene : contract_scenes()) {
        const auto bare = [](const String& s) { return s.barriers.empty(); };
        if (std::ranges::all_of(scene.strings, bare)) continue;
        scene.taps = {{"contact", Quantity::bridge_force, std::nullopt, 0}};
        const auto d = std::ranges::find_if(
            schemes(), [&scene](const Descriptor& one) { return represents(one, scene); });
        ASSERT_TRUE(d != schemes().end()) << scene.name;
        const Trace t = fresh({*d, scene, settings_for(*d, scene)}, {}).trace;
        EXPECT_TRUE(std::ranges::any_of(t.column(0), [](double f) { return f != 0; }))
            << scene.name;
    }
}

// A number of a kind that no scene has is felt by nobody. A rigid point has no stiffness to change.
TEST(Scenes, OfNumbersNeedEveryFeatureButARigidPointAndHaveEveryFile) {
    Features needed;
    bool of_modes = false, of_points = false, of_force = false, two_masses = false;
    for (const Scene& scene : scenes_of_numbers()) {
        needed = needed | needed_by(scene);
        for (const String& s : scene.strings) {
            const auto* table = s.start ? std::get_if<TableStart>(&*s.start) : nullptr;
            of_modes |= table && table->of_modes;
            of_points |= table && !table->of_modes;
            of_force |= s.pluck && !s.pluck->file.empty();
            two_masses |= s.masses.size() > 1;
        }
    }
    const Features every((1u << feature_count) - 1);
    EXPECT_EQ(names_of(every - needed), name_of(Feature::rigid_barrier));
    EXPECT_TRUE(of_modes && of_points && of_force && two_masses);
}

TEST(Excuses, AreOfControlsThatNeedThem) {
    for (const Excuse& e : excuses()) {
        const auto d = std::ranges::find_if(
            schemes(), [&e](const Descriptor& one) { return one.name == std::string(e.scheme); });
        const auto p = std::ranges::find_if(
            promises(), [&e](const Promise& one) { return one.name == std::string(e.promise); });
        ASSERT_TRUE(d != schemes().end() && p != promises().end()) << e.scheme << " " << e.promise;
        EXPECT_TRUE(is_control(*d)) << e.scheme;
        EXPECT_TRUE(std::ranges::any_of(
            cases_of(*d, p->scope),
            [&](const Case& c) { return verdict_on(*p, c).answer == Verdict::Answer::excused; }))
            << e.scheme << " keeps " << e.promise;
    }
}

}  // namespace
}  // namespace jvari::bench::check

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    jvari::bench::check::register_all();
    return RUN_ALL_TESTS();
}

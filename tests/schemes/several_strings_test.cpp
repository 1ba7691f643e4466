// Several strings as one scheme: whatever the scheme, what is heard of four strings is the sum of
// four runs of one, to the last bit.
#include "schemes/several_strings.hpp"
#include "scenes/start.hpp"

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <cstring>
#include <typeinfo>

#include "scenes/scene_file.hpp"
#include "schemes/making.hpp"
#include "schemes/vector_instructions.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

constexpr double tap_rate = 44100;
constexpr int strings = 4, rows = 80;
const Settings settings{4 * tap_rate, tap_rate, 40, {}};

// of a scheme whose own resolution would take most of the time, with a smaller one
Settings settings_for(const Descriptor& d) {
    Settings s = settings;
    if (d.name == std::string("characteristic_lattice")) s.options = {{"cells", "420"}};
    return s;
}

// The first scene of these that the scheme takes: a thread, a bridge and a pluck where it can have
// them.
Scene scene_for(const Descriptor& d) {
    Scene bridge = c3_pluck();
    bridge.strings.front().pluck->duration = 1e-3;
    // so that explicit schemes stand it
    std::get<LumpedBarrier>(bridge.strings.front().barriers.front()).stiffness.k = 1e5;
    std::vector<Scene> candidates{bridge};
    for (const char* name : {"sitar_c5_flat", "free_string"})
        candidates.push_back(read_scene(name));
    candidates.push_back(
        read_scene("flat_bridge_ideal", {"string.0.barrier.0.stiffness_density=rigid"}));
    for (const Scene& s : candidates)
        if (represents(d, s) && refusal(d.name, s, settings).empty()) return s;
    throw std::runtime_error(std::string(d.name) + " takes no scene of this test");
}

// String k of four that differ: in pitch and in how far they are pulled.
String variant(String s, int k) {
    s.tension *= 1 - 0.06 * k;
    if (s.pluck) s.pluck->start = 1e-4 * k;
    return scaled(s, 1 + 0.3 * k);
}

struct Instrument {
    Scene whole;
    std::vector<Scene> single;
};
// whole: the forces of all, then displacement and nut force of each string
Instrument instrument_of(const Scene& base) {
    Instrument i;
    i.whole = base;
    i.whole.duration = rows / tap_rate;
    i.whole.strings.clear();
    std::vector<Tap> sums{{"nut", Quantity::nut_force, {}, 0}};
    if (!base.strings.front().barriers.empty())
        for (const Quantity q : {Quantity::bridge_force, Quantity::driving_force})
            sums.push_back({name_of(q), q, {}, 0});
    if (base.strings.front().thread) sums.push_back({"thread", Quantity::thread_force, {}, 0});
    i.whole.taps = sums;
    for (int k = 0; k < strings; ++k) {
        const String s = variant(base.strings.front(), k);
        const Tap y{"y" + std::to_string(k), Quantity::displacement, k, 0.3 * s.length};
        Scene one = i.whole;
        one.strings = {s};
        one.taps = sums;
        one.taps.push_back(y);
        one.taps.back().string = 0;
        i.single.push_back(one);
        i.whole.strings.push_back(s);
    }
    for (int k = strings - 1; k >= 0; --k)  // in another order than the strings
        i.whole.taps.push_back(
            {"y" + std::to_string(k), Quantity::displacement, k, 0.3 * i.whole.strings[k].length});
    return i;
}

bool same(std::span<const double> a, std::span<const double> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

TEST(SeveralStrings, AreTheSumOfRunsOfOneInEverySchemeToTheLastBit) {
    for (const Descriptor* d : all_descriptors()) {
        const auto expect = [d](std::span<const double> a, std::span<const double> b,
                                const std::string& of) {
            EXPECT_TRUE(same(a, b)) << d->name << " " << of;
        };
        const Instrument i = instrument_of(scene_for(*d));
        const jvari::Run whole = run(*d, i.whole, settings_for(*d), {.energy = true});
        ASSERT_EQ(whole.trace.rows, rows + 1) << d->name;
        std::vector<jvari::Run> single;
        for (const Scene& s : i.single)
            single.push_back(run(*d, s, settings_for(*d), {.energy = true}));
        const int sums = static_cast<int>(i.single.front().taps.size()) - 1;
        const auto sum = [&](auto column) {
            std::vector<double> all(rows + 1, 0.0);
            for (int k = 0; k < strings; ++k)
                for (int n = 0; n <= rows; ++n)
                    all[n] =
                        k == 0 ? column(single[k].trace)[n] : all[n] + column(single[k].trace)[n];
            return all;
        };
        double largest = 0;
        for (int t = 0; t < sums; ++t)
            expect(whole.trace.column(t), sum([t](const Trace& x) { return x.column(t); }),
                   "tap " + std::to_string(t));
        for (int k = 0; k < strings; ++k) {
            expect(whole.trace.column(sums + strings - 1 - k), single[k].trace.column(sums),
                   "string " + std::to_string(k));
            for (const double y : single[k].trace.column(sums))
                largest = std::max(largest, std::abs(y));
            if (k > 0) {
                EXPECT_FALSE(same(single[k].trace.column(sums), single[0].trace.column(sums)))
                    << d->name;
            }
        }
        EXPECT_GT(largest, 1e-7) << d->name << " at rest: nothing was tested";
        for (int c = 0; c < 3; ++c)
            expect(whole.trace.energy_column(c),
                   sum([c](const Trace& x) { return x.energy_column(c); }), "energy");
        std::size_t facts = 0;
        for (int k = 0; k < strings; ++k)
            for (const Fact& f : single[k].facts) {
                ASSERT_LT(facts, whole.facts.size()) << d->name;
                const Fact& fact = whole.facts[facts++];
                EXPECT_EQ(fact.name, "string." + std::to_string(k) + "." + f.name) << d->name;
                if (f.value == f.value)
                    expect(std::span(&fact.value, 1), std::span(&f.value, 1), fact.name);
                else EXPECT_TRUE(fact.value != fact.value) << d->name << " " << fact.name;
            }
        EXPECT_EQ(facts, whole.facts.size()) << d->name;
        int dofs = 0;
        for (const jvari::Run& r : single) dofs += r.dofs;
        EXPECT_EQ(whole.dofs, dofs) << d->name;
    }
}

// Each of the vector instructions that this machine has, but none at all.
template <class Do>
void with_each_target(Do act) {
    const auto targets = hwy::SupportedTargets();
    for (auto left = targets & ~(HWY_SCALAR | HWY_EMU128); left != 0; left &= left - 1) {
        hwy::SetSupportedTargetsForTest(left & ~(left - 1));
        hwy::GetChosenTarget().Update(left & ~(left - 1));
        act(hwy::TargetName(left & ~(left - 1)));
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(targets);
}

TEST(VectorInstructions, AreThoseThatAKernelRunsWith) {
    std::vector<std::string> compiled;
    for (std::int64_t left = HWY_TARGETS; left != 0; left &= left - 1)
        compiled.emplace_back(hwy::TargetName(left & ~(left - 1)));
    const auto is_compiled = [&compiled](const std::string& name) {
        return std::ranges::count(compiled, name) > 0;
    };
    EXPECT_TRUE(is_compiled(vector_instructions())) << vector_instructions();
    with_each_target([&](const char* target) {
        if (is_compiled(target)) { EXPECT_EQ(vector_instructions(), target); }
    });
}

TEST(SeveralStrings, OneStringIsTheSchemeItself) {
    for (const Descriptor* d : all_descriptors()) {
        const Scene scene = scene_for(*d);
        Settings own = settings;
        const auto checked = make_scheme(*d, scene, own), itself = d->make(*d, scene, own);
        const Scheme &a = *checked, &b = *itself;
        EXPECT_EQ(typeid(a).name(), typeid(b).name()) << d->name;
    }
}

// A tap counts steps. The string fails at the step that its tension says.
class Counting final : public Scheme {
public:
    Counting(long fails, int taps, int per_row) : fails_(fails), taps_(taps), per_row_(per_row) {}
    void reset() noexcept override { step_ = 0; }
    Status advance(const Block& out) noexcept override {
        for (int n = 0; n < out.rows; ++n) {
            for (int k = 0; k < taps_; ++k)
                out.tap[k * out.stride + n] = static_cast<double>(step_);
            for (int i = 0; i < per_row_; ++i, ++step_)
                if (step_ == fails_) return {Outcome::diverged, step_};
        }
        return {};
    }
    int dofs() const override { return 1; }
    std::vector<Fact> facts() const override { return {{"steps", static_cast<double>(step_), ""}}; }

private:
    long fails_, step_ = 0;
    int taps_, per_row_;
};
const Descriptor counting = {
    "counting",
    "none: made for a test",
    Feature::damping,
    Balance::none,
    Clock::stepped,
    [](const Descriptor&, const Scene& scene, const Settings& s) -> std::unique_ptr<Scheme> {
        if (scene.strings.front().length > 1e3)
            throw Refusal("the string is too long for this room");
        if (scene.strings.front().length < 1e-3)
            throw BadScene("string.0.length", "too little", "more");
        const long fails = std::lround(scene.strings.front().tension);
        return std::make_unique<Counting>(fails, static_cast<int>(scene.taps.size()),
                                          steps_per_row(s));
    }};

Scene counted(const std::vector<double>& fails) {
    Scene scene;
    scene.name = "counted";
    scene.duration = 200 / tap_rate;
    for (const double f : fails) {
        scene.strings.emplace_back();
        scene.strings.back().length = 1;
        scene.strings.back().tension = f;
        scene.taps.push_back({"n" + std::to_string(scene.taps.size()), Quantity::nut_force,
                              static_cast<int>(scene.taps.size()), 0});
    }
    scene.taps.push_back({"sum", Quantity::nut_force, {}, 0});
    return scene;
}

TEST(SeveralStrings, TheFirstFailureEndsTheRunOfAll) {
    for (const std::vector<double>& fails : std::vector<std::vector<double>>{
             {1e6, 301, 299}, {299, 301, 1e6}, {301, 1e6, 299}, {302, 299, 300}})
        for (const int block : {1, 5, 64, 1000}) {
            const jvari::Run r = run(counting, counted(fails), settings, {.block_rows = block});
            EXPECT_EQ(r.status.outcome, Outcome::diverged);
            EXPECT_EQ(r.status.step, 299);
            ASSERT_EQ(r.trace.rows, 75);  // to row 74, steps 296 to 299
            for (int n = 0; n < 75; ++n) ASSERT_EQ(r.trace.column(3)[n], 3 * 4 * n);
            for (int k = 0; k < 3; ++k)
                // and not to the block's end
                EXPECT_LE(r.facts[k].value, 300) << block << " rows a block, string " << k;
        }
}

TEST(SeveralStrings, WhatRefusesNamesItsString) {
    Scene scene = counted({1e6, 1e6, 1e6});
    scene.strings[1].length = 2e3;
    try {
        make_scheme(counting, scene, settings);
        FAIL() << "made";
    } catch (const Refusal& e) {
        EXPECT_STREQ(e.what(), "string.1: the string is too long for this room");
    }
    scene.strings[1].length = 1;
    scene.strings[2].length = 1e-4;
    try {
        make_scheme(counting, scene, settings);
        FAIL() << "made";
    } catch (const BadScene& e) { EXPECT_EQ(e.key, "string.2.length"); }
}

TEST(SeveralStrings, ASumIsOverTheStringsThatHaveTheForce) {
    Scene scene = c3_pluck();
    scene.duration = rows / tap_rate;
    scene.strings.push_back(scene.strings.front());
    scene.strings[0].thread.reset();
    scene.strings[1].tension *= 0.9;
    scene.taps = {{"all", Quantity::thread_force, {}, 0}, {"second", Quantity::thread_force, 1, 0}};
    const jvari::Run r = run(schemes()[0], scene, settings);
    EXPECT_TRUE(same(r.trace.column(0), r.trace.column(1)));
    EXPECT_NE(r.trace.column(0)[rows], 0);
}

TEST(SeveralStrings, TheLimitIsThatOfTheStringNearestToIt) {
    const Descriptor& d = named("finite_difference_explicit");
    Scene scene = c3_pluck();
    const Settings on_a_grid{tap_rate, tap_rate, 0, {{"grid", "40"}}};
    const double slow = margin_of(d, scene, on_a_grid);
    scene.strings.push_back(scene.strings.front());
    scene.strings.back().tension *= 2;  // faster waves: a larger least spacing
    const double least = margin_of(d, scene, on_a_grid);
    EXPECT_LT(least, slow);
    std::swap(scene.strings[0], scene.strings[1]);
    EXPECT_EQ(margin_of(d, scene, on_a_grid), least);
}

}  // namespace
}  // namespace jvari

// The stepping loop: rows, blocks, divergence, denormals.
#include "schemes/run.hpp"
#include "schemes/making.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <thread>

#include "scenes/scene_file.hpp"
#include "schemes/registry.hpp"
#include "tests/c3.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

// y and its energy double at each row: diverges on purpose.
class Doubling final : public Scheme {
public:
    void reset() noexcept override { n_ = 0; }
    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row, ++n_) {
            for (int k = 0; k < out.taps; ++k)
                out.tap[k * out.stride + row] = std::ldexp(1.0, static_cast<int>(2 * n_));
            if (out.energy) {
                out.energy[row] = std::ldexp(1.0, static_cast<int>(n_));
                out.energy[out.stride + row] = out.energy[2 * out.stride + row] = 0;
            }
        }
        return {};
    }
    int dofs() const override { return 1; }

private:
    long n_ = 0;
};

Scene second() {
    Scene s = c3_free();
    s.duration = 1;
    // of which the scene's energy says nothing
    for (Tap& t : s.taps) t.quantity = Quantity::bridge_force;
    return s;
}

Scene with_profile(Scene scene) {
    scene.strings.front().thread.reset();
    scene.strings.front().barriers = {ProfileBarrier{ParabolaCurve{4}, 0, 0.1, {1e8}, 1.5, 0}};
    scene.taps.resize(2);
    return scene;
}
Scene sitar() {  // what the schemes on rails represent
    Scene scene = with_profile(c3_release());
    String& s = scene.strings.front();
    s.bending_stiffness = 0;
    s.damping = PerPeriodDamping{0.996};
    s.start = TriangleShape{0.3, 1e-3, 0};
    scene.taps = {{"nut", Quantity::nut_force, 0, 0}};
    return scene;
}

TEST(RunLoop, ATraceHasOneRowMoreThanItsDurationHasIntervals) {
    Doubling scheme;
    Scene s = second();
    s.duration = 0.06;
    const auto r = run(scheme, s, {2000, 1000, 0, {}}, {.timed = true});
    EXPECT_EQ(r.trace.rows, 61);
    EXPECT_EQ(r.steps, 122);
}

TEST(RunLoop, ATimedRunThatOverflowsEndsWithTheRowsThatAreValid) {
    Doubling scheme;
    for (const int block : {1, 7, 64, 5000}) {
        const auto r =
            run(scheme, second(), {2000, 1000, 0, {}}, {.block_rows = block, .timed = true});
        EXPECT_EQ(r.status.outcome, Outcome::diverged);
        EXPECT_EQ(r.trace.rows, 512);  // 2^1024 is infinite
        EXPECT_EQ(r.status.step, 2 * 512);
        EXPECT_TRUE(std::isfinite(r.trace.column(0).back()));
    }
}

TEST(RunLoop, ARunThatLeavesItsEnergyBudgetHasDivergedWhetherItsEnergyIsKeptOrNot) {
    Doubling scheme;
    for (const bool energy : {false, true})
        for (const int block : {1, 7, 64, 5000}) {
            const auto r =
                run(scheme, second(), {2000, 1000, 0, {}}, {.energy = energy, .block_rows = block});
            EXPECT_EQ(r.status.outcome, Outcome::diverged);
            EXPECT_EQ(r.status.step, 8);
            EXPECT_EQ(r.trace.rows, 4);  // stored 1, 2, 4, 8 and then 16 > 10 x 1
            EXPECT_EQ(r.trace.energy.empty(), !energy);
        }
}

// A scheme that says and does what a test tells it to; a row is a step.
struct Odd final : Scheme {
    std::function<Status(const Block&, long first)> act = [](const Block&, long) {
        return Status{};
    };
    std::function<std::vector<Fact>()> make_facts = [] { return std::vector<Fact>{}; };
    long row = 0;
    void reset() noexcept override { row = 0; }
    Status advance(const Block& out) noexcept override {
        const long first = row;
        row += out.rows;
        return act(out, first);
    }
    int dofs() const override { return 1; }
    std::vector<Fact> facts() const override { return make_facts(); }
};

// A scheme that tells no energy: the largest displacement that 10 times the energy of a string
// plucked to 1 mm allows is sqrt(10) mm.
TEST(RunLoop, ATapBeyondWhatTenfoldEnergyOfTheSceneAllowsHasDivergedWhateverTheSchemeTells) {
    class Growing final : public Scheme {
    public:
        explicit Growing(double last) : last_(last) {}
        void reset() noexcept override { n_ = 0; }
        Status advance(const Block& out) noexcept override {
            for (int row = 0; row < out.rows; ++row, ++n_) {
                for (int k = 0; k < out.taps; ++k)
                    out.tap[k * out.stride + row] = n_ == 700 ? last_ : 0;
                if (out.energy)
                    out.energy[row] = out.energy[out.stride + row] =
                        out.energy[2 * out.stride + row] = 0;
            }
            return {};
        }
        int dofs() const override { return 1; }

    private:
        double last_;
        long n_ = 0;
    };
    Scene s = c3_free();
    s.duration = 1;
    s.strings[0].start = ModeShape{1, 1e-3};
    s.strings[0].bending_stiffness = 0;
    s.taps = {{"y", Quantity::displacement, 0, 0.5 * s.strings[0].length}};
    const double antinode = 1e-3 * std::sqrt(10.0);  // of the one mode that it is asked to carry
    for (const bool timed : {false, true}) {
        Growing within(0.98 * antinode), beyond(-1.001 * antinode);
        EXPECT_EQ(run(within, s, {1000, 1000, 1, {}}, {.timed = timed}).status.outcome,
                  Outcome::ok);
        const auto r = run(beyond, s, {1000, 1000, 1, {}}, {.timed = timed});
        EXPECT_EQ(r.status.outcome, Outcome::diverged);
        EXPECT_EQ(r.trace.rows, 700);
    }
}

// Its nut force goes 3.2 times beyond what the string's own modes could make of the energy.
TEST(RunLoop, ARunWhoseModesAliasIsNotHeldAgainstTheStringsTaps) {
    const Scene scene = read_scene("flat_bridge_ideal",
                                   {"string.0.barrier.0.stiffness_density=1e6", "duration=0.02"});
    const auto r = play("modal_spatial_newton", scene, {44100, 44100, 0, {}});
    EXPECT_GT(fact_of(r.facts, facts::modes_above_nyquist), 0);
    EXPECT_EQ(r.status.outcome, Outcome::ok);
}

TEST(RunLoop, ARunThatFailsKeepsTheRowsUpToTheFailingStep) {
    for (const bool energy : {false, true})
        for (const int block : {1, 7, 64}) {
            Odd scheme;
            scheme.act = [](const Block& out, long first) {
                return first + out.rows > 100 ? Status{Outcome::not_converged, 200} : Status{};
            };
            const auto r =
                run(scheme, second(), {2000, 1000, 0, {}}, {.energy = energy, .block_rows = block});
            EXPECT_EQ(r.status.outcome, Outcome::not_converged);
            EXPECT_EQ(r.trace.rows, 101);
        }
}

// A string of which stored and supplied energy are told row by row; a row is a step.
Odd storing(std::function<double(long)> stored, std::function<double(long)> supplied) {
    Odd scheme;
    scheme.act = [=](const Block& out, long first) {
        for (int n = 0; n < out.rows && out.energy; ++n)
            write_energy(out, n, stored(first + n), supplied(first + n), 0);
        return Status{};
    };
    return scheme;
}
struct Met {
    Outcome outcome;
    long step, rows;
    bool operator==(const Met&) const = default;
};
Met met(Odd scheme, const Scene& scene, const RunOptions& options) {
    const auto r = run(scheme, scene, {1000, 1000, 0, {}}, options);
    return {r.status.outcome, r.status.step, r.trace.rows};
}
void expect_met(const Odd& scheme, const Scene& scene, const Met& expected) {
    for (const bool energy : {false, true})
        for (const int block : {1, 7, 64, 5000})
            EXPECT_EQ(met(scheme, scene, {.energy = energy, .block_rows = block}), expected)
                << block;
}

TEST(RunLoop, WhatAPluckSuppliesBelongsToTheBudget) {
    Scene scene = second();
    scene.strings.front().pluck = {.amplitude = 1, .duration = 0.01, .start = 0.4, .position = 0.1};
    const auto supplied = [](long row) { return row > 400 && row <= 410 ? 1.0 : 0.0; };
    const auto grown_to = [](double energy) {
        return [energy](long row) { return row > 410 ? energy : 0; };
    };
    expect_met(storing(grown_to(99), supplied), scene, {Outcome::ok, 0, 1001});
    expect_met(storing(grown_to(101), supplied), scene, {Outcome::diverged, 411, 411});
    // 40 J by then
    expect_met(storing([](long row) { return row >= 404 ? 41 : 0; }, supplied), scene,
               {Outcome::diverged, 404, 404});
}

// Of a long pluck some rows tell what it supplies: what they let seem too much is looked at row by
// row.
TEST(RunLoop, WhatALongPluckSuppliesIsSummedWhereItMatters) {
    Scene scene = second();
    // beyond the end
    scene.strings.front().pluck = {.amplitude = 1, .duration = 10, .start = 0.4, .position = 0.1};
    // between two of them
    const auto supplied = [](long row) { return row == 403 ? 1.0 : 0.0; };
    const auto from = [](long first, double energy) {
        return [=](long row) { return row >= first ? energy : 0; };
    };
    expect_met(storing(from(403, 9.9), supplied), scene, {Outcome::ok, 0, 1001});
    expect_met(storing(from(403, 10.1), supplied), scene, {Outcome::diverged, 403, 403});
    expect_met(storing(from(402, 1), supplied), scene, {Outcome::diverged, 402, 402});
    for (const long row : {404L, 512L, 700L, 701L, 999L, 1000L})
        expect_met(
            storing([row](long n) { return n >= row   ? 10.1
                                           : n >= 403 ? 1.0
                                                      : 0.0; }, supplied),
            scene, {Outcome::diverged, row, row});
}

TEST(RunLoop, ABudgetThatIsLeftNearTheEndIsSeen) {
    for (const long row : {1L, 255L, 256L, 257L, 999L, 1000L}) {
        const auto stored = [row](long n) { return n >= row ? 11.0 : 1.0; };
        expect_met(storing(stored, [](long) { return 0; }), second(),
                   {Outcome::diverged, row, row});
    }
}

TEST(RunLoop, ASchemeThatFailsOnceItsBudgetIsLeftHasDivergedWhereItWasLeft) {
    Odd scheme = storing([](long row) { return row >= 300 ? 11 : 1; }, [](long) { return 0; });
    scheme.act = [stores = scheme.act](const Block& out, long first) {
        stores(out, first);
        return first + out.rows > 310 ? Status{Outcome::not_converged, 310} : Status{};
    };
    expect_met(scheme, second(), {Outcome::diverged, 300, 300});
}

TEST(RunLoop, ARowThatIsLongerThanTheRunIsNoRow) {
    Odd scheme;
    Scene scene = second();
    for (const double row : {1.1, 2.0, 1000.0})
        EXPECT_THROW(run(scheme, scene, {1000, 1 / row, 0, {}}), BadScene) << row;
    EXPECT_EQ(run(scheme, scene, {1000, 1, 0, {}}).trace.rows, 2);
    scene.duration = 1 / 44100.0;
    EXPECT_EQ(run(scheme, scene, {44100, 44100, 0, {}}).trace.rows, 2);
}

TEST(RunLoop, AReferenceInContinuousTimeThatFailsKeepsItsRowsToo) {
    for (const bool energy : {false, true}) {
        Odd scheme;
        scheme.act = [](const Block& out, long first) {
            return first + out.rows > 83 ? Status{Outcome::not_converged, 83} : Status{};
        };
        const auto r = run(scheme, second(), {0, 1000, 0, {}}, {.energy = energy});
        EXPECT_EQ(r.status.step, 83);
        EXPECT_EQ(r.trace.rows, 84);
        EXPECT_EQ(r.steps, 0);
    }
}

TEST(RunLoop, FactsOfARunThatDivergesDoNotDependOnTheBlock) {
    const auto met = [](int block_rows, bool energy) {
        Odd scheme;  // stores 2^row, and tells the most that it has stored
        double most = 0;
        scheme.act = [&most](const Block& out, long first) {
            if (first == 0) most = 0;
            most = std::exp2(static_cast<double>(first + out.rows - 1));
            for (int n = 0; n < out.rows && out.energy; ++n)
                write_energy(out, n, std::exp2(static_cast<double>(first + n)), 0, 0);
            return Status{};
        };
        scheme.make_facts = [&most] { return std::vector<Fact>{{{"most", "J", ""}, most}}; };
        const auto r = run(scheme, second(), {1000, 1000, 0, {}},
                           {.energy = energy, .block_rows = block_rows});
        EXPECT_EQ(r.status.outcome, Outcome::diverged);
        return std::pair{r.trace.rows, r.facts.at(0).value};
    };
    for (const bool energy : {false, true})
        for (const int rows : {1, 7, 64}) EXPECT_EQ(met(rows, energy), met(64, true));
}

TEST(RunLoop, WhatASchemeCannotMeanIsASentence) {
    for (const Status status :
         {Status{static_cast<Outcome>(77), 5}, Status{Outcome::diverged, -1000000},
          Status{Outcome::diverged, 1L << 40}}) {
        Odd scheme;
        scheme.act = [status](const Block&, long) { return status; };
        EXPECT_THROW(run(scheme, second(), {1000, 1000, 0, {}}), BadScheme);
    }
    Odd throws;
    throws.make_facts = []() -> std::vector<Fact> { throw 42; };
    EXPECT_THROW(run(throws, second(), {1000, 1000, 0, {}}), BadScheme);
    throws.make_facts = []() -> std::vector<Fact> { throw std::runtime_error("no facts today"); };
    EXPECT_THROW(run(throws, second(), {1000, 1000, 0, {}}), std::runtime_error);
}

TEST(Made, IsASchemeOrASentence) {
    Descriptor d{"odd", "a test", needed_by(second()), Balance::none, Clock::stepped, nullptr};
    d.make = [](const Descriptor&, const Scene&, const Settings&) -> std::unique_ptr<Scheme> {
        return nullptr;
    };
    EXPECT_THROW(make_scheme(d, second(), {1000, 1000, 0, {}}), BadScheme);
    d.make = [](const Descriptor&, const Scene&, const Settings&) -> std::unique_ptr<Scheme> {
        throw 42;
    };
    EXPECT_THROW(make_scheme(d, second(), {1000, 1000, 0, {}}), BadScheme);
    d.make = [](const Descriptor&, const Scene&, const Settings&) -> std::unique_ptr<Scheme> {
        throw Refusal("not today");
    };
    EXPECT_THROW(make_scheme(d, second(), {1000, 1000, 0, {}}), Refusal);
    d.make = [](const Descriptor&, const Scene&, const Settings&) -> std::unique_ptr<Scheme> {
        return std::make_unique<Odd>();
    };
    EXPECT_NE(make_scheme(d, second(), {1000, 1000, 0, {}}), nullptr);
}

TEST(RunLoop, MoreStepsOrRowsThanCanBeCountedAreRefused) {
    EXPECT_EQ(steps_per_row({2147483647.0, 1, 0, {}}), 2147483647);
    EXPECT_THROW(steps_per_row({2147483648.0, 1, 0, {}}), Refusal);
    EXPECT_THROW(steps_per_row({132300000000000, 44100, 0, {}}), Refusal);
    Odd scheme;
    Scene scene = second();
    scene.duration = 1e300;
    EXPECT_THROW(run(scheme, scene, {1000, 1000, 0, {}}), Refusal);
}

// A row of 2^30 steps at 44.1 kHz, seven hours of sound, and a caller who has had enough at the
// second word.
struct Enough {};
void expect_enough(const Descriptor& d, Scene scene,
                   const std::vector<std::pair<std::string, std::string>>& options = {}) {
    scene.duration = 1e9;
    int words = 0;
    EXPECT_THROW(run(d, scene, {44100, 44100.0 / (1 << 30), 0, options},
                     {.progress =
                          [&](long, long) {
                              if (++words == 2) throw Enough{};
                          }}),
                 Enough)
        << d.name;
}

// so that explicit schemes stand it: one that diverges ends its row itself
Scene softened(Scene scene) {
    for (Barrier& barrier : scene.strings.front().barriers) {
        if (auto* lumped = std::get_if<LumpedBarrier>(&barrier)) lumped->stiffness.k = 1e3;
        else std::get<ProfileBarrier>(barrier).stiffness.K = 1e3;
    }
    return scene;
}

TEST(LongRow, OfEverySchemeCanBeEndedWithinIt) {
    int tried = 0;
    for (const Descriptor& d : schemes())
        for (const Scene& scene : {c3_pluck(), with_profile(c3_release()), sitar()}) {
            if (!represents(d, scene)) continue;
            const bool grid = std::string_view(d.name).starts_with("finite");
            expect_enough(d, d.balance == Balance::none ? softened(scene) : scene,
                          grid ? std::vector<std::pair<std::string, std::string>>{{"grid", "40"}}
                               : std::vector<std::pair<std::string, std::string>>{});
            ++tried;
        }
    EXPECT_GE(tried, static_cast<int>(schemes().size()));
}

TEST(Schemes, OnAStringWithoutAModeBelow20kHzRunOrRefuse) {  // the first at 720 kHz
    Scene lumped = c3_release();
    lumped.duration = 1e-3;
    Scene rails = sitar();
    rails.duration = 1e-3;
    for (Scene scene : {lumped, rails}) {
        scene.strings.front().tension = 1e9;
        for (const Descriptor& d : schemes())
            for (const std::string length : {"integer", "fractional"}) {
                if (!represents(d, scene)) continue;
                const bool waves = d.name == std::string("sitar_waveguide");
                Settings settings{44100 * 1024, 44100, 0, {}};
                if (waves) settings.options = {{"length", length}};
                try {
                    const auto r = run(d, scene, settings);
                    EXPECT_EQ(std::string(d.name).find("modal"), std::string::npos) << d.name;
                    EXPECT_FALSE(waves && length == "fractional");
                } catch (const Refusal& refusal) {
                    EXPECT_NE(std::string(refusal.what()).find("no mode below 20000 Hz"),
                              std::string::npos)
                        << d.name << ": " << refusal.what();
                }
            }
    }
}

TEST(RunLoop, ASlowRunSaysSoOnceWithItsFacts) {
    Odd scheme;
    scheme.act = [](const Block& out, long) {
        std::this_thread::sleep_for(std::chrono::milliseconds(400) * out.rows);
        return Status{};
    };
    scheme.make_facts = [] { return std::vector<Fact>{{"contact_points", 1600, ""}}; };
    Scene scene = second();
    scene.duration = 7e-3;
    std::vector<long> rows;
    run(scheme, scene, {1000, 1000, 0, {}},
        {.slow = [&](long done, long, const std::vector<Fact>& facts) {
            rows.push_back(done);
            EXPECT_EQ(facts.front().value, 1600);
        }});
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_GT(rows.front(), 0);
    EXPECT_LT(rows.front(), 8);
}

TEST(RunLoop, DenormalsAreFlushedForItsLifeOnly) {
    volatile double tiny = std::numeric_limits<double>::min(), half = 0.5;
    EXPECT_NE(tiny * half, 0);
    {
        const FlushDenormals flush;
        EXPECT_EQ(tiny * half, 0);
    }
    EXPECT_NE(tiny * half, 0);
}

}  // namespace
}  // namespace jvari

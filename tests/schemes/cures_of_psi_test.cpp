// The cures of psi, against what they must be equal to.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scene_file.hpp"
#include "schemes/contact/quadratised_rule.hpp"
#include "schemes/registry.hpp"
#include "schemes/run.hpp"

namespace jvari {
namespace {

jvari::Run cured(const char* variant, const char* levels, const char* lambda0, double rate) {
    for (const Descriptor& d : schemes())
        if (d.name == std::string("modal_quadratised")) {
            const Scene scene = read_scene("two_point_bridge", {"string.0.damping.law=none", "duration=0.003"});
            const Settings s{rate, 44100, 40, {{"variant", variant}, {"levels", levels}, {"lambda0", lambda0}}};
            return jvari::run(d, scene, s, {.energy = true});
        }
    throw Refusal("no scheme");
}
double fact(const jvari::Run& r, const char* name) {
    for (const Fact& f : r.facts)
        if (f.name == name) return f.value;
    return NAN;
}

TEST(CuresOfPsi, KeepTheirLedgerAndOnlyRelaxationLoses) {
    for (const char* levels : {"2", "3"})
        for (const char* variant : {"raw", "constrained", "released", "relaxed", "controlled"}) {
            const jvari::Run r = cured(variant, levels, "1e5", 352800);
            double worst = 0, lost = 0, least = 0;
            const auto stored = r.trace.energy_column(0), spent = r.trace.energy_column(2);
            for (long i = 1; i < r.trace.rows; ++i) {
                worst = std::max(worst, std::abs(stored[i] - stored[i - 1] + spent[i]));
                lost += spent[i];
                least = std::min(least, spent[i]);
            }
            EXPECT_LT(worst / stored[0], 1e-11) << variant << levels;
            EXPECT_GE(least / stored[0], -1e-12) << variant << levels;
            if (variant == std::string("relaxed")) EXPECT_GT(lost / stored[0], 1e-6) << levels;
            else EXPECT_LT(std::abs(lost) / stored[0], 1e-11) << variant << levels;
        }
}

TEST(CuresOfPsi, RelaxationLeavesNoPsiBehindAndControlOfZeroIsRaw) {
    for (const char* levels : {"2", "3"}) {
        EXPECT_EQ(fact(cured("relaxed", levels, "0", 352800), "psi_out_of_contact"), 0) << levels;
        const double raw = fact(cured("raw", levels, "0", 352800), "psi_gap");
        EXPECT_GT(raw, 0.5) << levels;
        EXPECT_NEAR(fact(cured("controlled", levels, "0", 352800), "psi_gap"), raw, 1e-6 * raw) << levels;
    }
}

// Where a force hardly moves the point psi falls by lambda0 dt of itself in each step out of contact.
TEST(CuresOfPsi, ControlDrawsPsiBackAtItsRate) {
    const ContactLaw law{1e6, 1.5};
    const double theta = 1e-20, rate = 1e5, lambda0 = 1e4;
    for (const int levels : {1, 2}) {
        QuadratisedContacts rule(std::span(&law, 1), std::span(&theta, 1), levels, Quadratisation::controlled);
        rule.choose({rate, rate, 1, {{"lambda0", std::to_string(lambda0)}}});
        const double inside = 1e-5;
        rule.begin(&inside);
        const double start = rule.potential(0, 0);
        for (int step = 1; step <= 20; ++step) {
            const double out = -1e-5 * step, b = -2e-6;
            double r, F;
            rule.solve({&out, &out, &b}, &r, &F);
            EXPECT_NEAR(rule.potential(0, 0) / start, std::pow(1 - lambda0 / rate, 2 * step), 1e-9) << levels << " " << step;
        }
    }
}

}  // namespace
}  // namespace jvari

// Steps of a collocated contact: few, as long as their errors allow, where the force is no
// polynomial.
#include "reference/exact/contact_steps.hpp"
#include "scenes/scene_file.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

struct Contact {
    int steps = 0, rejected = 0;
    double first = 0, last = 0;
};

// One contact of the length L, of a point whose steps err as contact_steps.hpp says: 1e-3 long at
// either end.
Contact one_contact(ContactSteps& steps, double L, double allowed) {
    const auto error = [&](double from, double d) {
        const auto beside = [&](double distance) {
            return std::min(1.0, 4e-5 * std::pow(d / distance, 4));
        };
        return allowed * std::pow(d / 1e-3, 2.3) *
               std::max(beside(from), from + d > L ? 1.0 : beside(L - from - d));
    };
    Contact c;
    steps.set_in();
    double leaves = HUGE_VAL;
    for (double at = 0; at < L && c.steps < 1000;) {
        const double d = steps.next(1, leaves);
        ++c.steps;
        const double e = error(at, d);
        leaves = L - at;
        if (!steps.fits(e)) {
            ++c.rejected;
            steps.rejected(e, leaves);
            continue;
        }
        c.last = std::min(d, L - at);
        if (at == 0) c.first = d;
        at += c.last;
        steps.accepted(e, c.last);
        leaves = L - at;
    }
    return c;
}

TEST(ContactSteps, LearnHowAForceSetsInAndEndsAndKeepIt) {
    constexpr double allowed = 1e-10;
    ContactSteps steps(allowed, 1.3);
    one_contact(steps, 0.3, allowed);
    for (int i = 0; i < 5; ++i) {
        const Contact c = one_contact(steps, 0.3, allowed);
        EXPECT_LE(c.rejected, 2) << i;
        EXPECT_LE(c.steps, 18) << i;
        EXPECT_GT(c.first, 5e-4) << i;
        EXPECT_LT(c.first, 1e-3) << i;
        EXPECT_LT(c.last, 1e-3) << i;
    }
}

// A spring's force is a polynomial everywhere: what is seen of its ends shortens nothing.
TEST(ContactSteps, ASpringsAreAsLongAsASmoothForceAllows) {
    ContactSteps steps(1e-10, 1);
    steps.set_in();
    for (int i = 0; i < 10; ++i) steps.next(1, 0.1), steps.accepted(1e-14, 1);
    EXPECT_EQ(steps.next(1, 0.1), 1);
}

// 32 points of exponent 1.3, 694 events within 2 ms: the string beside them, and at 0.3 m.
TEST(ContactSteps, AreFewForEachEventOfAParabolaWhoseErrorFollowsTheTolerance) {
    Scene scene = read_scene("sitar_parabola");
    scene.duration = 2e-3;
    const auto at = [&](const std::string& tolerance) {
        return play("exact_contact tolerance=" + tolerance, scene, {0, 44100, 0, {}});
    };
    const auto truth = at("1e-13");
    const struct {
        const char* tolerance;
        double value, most;  // steps an event
    } runs[] = {{"1e-6", 1e-6, 5.5}, {"1e-9", 1e-9, 9.5}, {"1e-12", 1e-12, 20}};
    constexpr double rounding = 1e-11;  // what 694 events make of it
    for (const auto& r : runs) {
        const auto met = at(r.tolerance);
        EXPECT_EQ(fact(met, "events"), 694) << r.tolerance;
        EXPECT_LT(fact(met, "contact_steps"), r.most * 694) << r.tolerance;
        EXPECT_LT(apart(met, truth, 1), r.value + rounding) << r.tolerance;
        EXPECT_LT(apart(met, truth, 2), r.value) << r.tolerance;
    }
}

}  // namespace
}  // namespace jvari

// A pluck shorter than a step: the impulse that arrives is that of the force, wherever it lies
// between the steps, in every scheme that takes a pluck.
#include "scenes/columns.hpp"
#include "tests/runs.hpp"

namespace jvari {
namespace {

// A string whose modes are slower than 5e-6 Hz, so that a blow leaves it with a velocity that
// stays: F's impulse times what its shape says.
Scene slack(const std::string& force) {
    Scene scene;
    scene.name = "slack";
    scene.duration = 0.02;
    String s;
    s.length = 1;
    s.linear_density = 5e-3;
    s.tension = s.linear_density * 4e-12;
    s.pluck = Pluck{};
    force_from("f.csv", force, *s.pluck);
    s.pluck->position = 0.4;
    s.pluck->width = 0.3;
    scene.strings = {s};
    scene.taps = {{"v", Quantity::velocity, 0, 0.37}};
    return scene;
}

std::vector<const Descriptor*> plucked() {
    std::vector<const Descriptor*> all;
    for (const auto& table : {schemes(), std::span(schemes_of_pairings())})
        for (const Descriptor& d : table)
            if (d.represents.has(Feature::pluck) && d.clock == Clock::stepped) all.push_back(&d);
    return all;
}

TEST(Pulse, OfTwentyMicrosecondsBringsItsWholeImpulseWhereverItLiesBetweenSteps) {
    const double dt = 1 / 44100.0;
    const auto triangle = [](double middle, double half, double peak) {
        std::ostringstream rows;
        rows.precision(17);
        rows << "time_s,force_N\n"
             << middle - half << ",0\n"
             << middle << ',' << peak << '\n'
             << middle + half << ",0\n";
        return rows.str();
    };
    const auto taken = plucked();
    EXPECT_GT(taken.size(), 15u);
    for (const Descriptor* d : taken) {
        Settings settings{44100, 44100, 5, {}};
        for (const Option& o : d->options)
            if (o.name == std::string("grid")) settings.options = {{"grid", "8"}};
        const auto end = [&](const std::string& force) {
            const jvari::Run r =
                run(*d, slack(force), settings, {.energy = d->balance == Balance::exact});
            EXPECT_EQ(r.status.outcome, Outcome::ok) << d->name;
            if (d->balance == Balance::exact) {
                double supplied = 0;
                for (const double E : r.trace.energy_column(1)) supplied += E;
                const double stored = r.trace.energy_column(0).back();
                EXPECT_NEAR(supplied, stored, 1e-9 * stored) << d->name;
            }
            return r.trace.column(0).back();
        };
        // 1 mN s: as a triangle over 40 steps, which their ends see, and within one
        const double slow = end(triangle(460 * dt, 20 * dt, 1e-3 / (20 * dt)));
        EXPECT_GT(slow, 1e-3) << d->name;
        for (const double lies : {0.45, 0.5, 0.55, 0.9, 1.0, 1.1})
            EXPECT_NEAR(end(triangle((460 + lies) * dt, 10e-6, 100)), slow, 1e-9 * slow)
                << d->name << ' ' << lies;
    }
}

}  // namespace
}  // namespace jvari

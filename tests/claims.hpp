// What is claimed of many schemes on many scenes: that energy balances, and that errors fall.
#pragma once

#include <optional>

#include "scenes/scene_file.hpp"
#include "tests/runs.hpp"

namespace jvari {

using Forms = std::vector<std::string>;
inline const Forms grids{"finite_difference_explicit", "finite_difference_theta",
                         "finite_difference_hamiltonian"};

inline Scene over_two_bridges(double seconds, double beta = 0) {
    Scene scene = lasting(read_scene("two_point_bridge"), seconds);
    scene.strings[0].barriers.push_back(scene.strings[0].barriers[0]);
    barrier(scene, 1).position = 14e-3;
    return with_loss(scene, beta);
}

struct LedgerAt {
    std::vector<double> rates = {44100};
    double tap_rate = 0;  // 0: a row a step
    int modes = 0;
};
struct LedgerOpen {  // at most, of the largest stored energy
    double row, sum = HUGE_VAL;
};
struct LedgerLost {  // as a part of it
    double at_most = HUGE_VAL;
    std::optional<double> more_than = {};
    double least = 0;  // of a row [J]
};
// The energy ledger of every form on every scene at every rate.
struct LedgerClaim {
    using At = LedgerAt;
    using Open = LedgerOpen;
    using Lost = LedgerLost;
    // pushes: touches, and never pulls; events: of a reference, more than these
    LedgerClaim(const char* name_, Forms forms_, std::vector<Scene> scenes_, At at_, Open open_,
                Lost lost_ = {}, bool pushes_ = false, std::optional<double> events_ = {})
        : name(name_),
          forms(std::move(forms_)),
          scenes(std::move(scenes_)),
          at(std::move(at_)),
          open(open_),
          lost(lost_),
          pushes(pushes_),
          events(events_) {}
    std::string name;
    Forms forms;
    std::vector<Scene> scenes;
    At at;
    Open open;
    Lost lost;
    bool pushes;
    std::optional<double> events;
};
inline void holds(const LedgerClaim& c) {
    for (const std::string& form : c.forms)
        for (const Scene& scene : c.scenes)
            for (const double rate : c.at.rates) {
                const auto where = form + " on " + scene.name + " at " + std::to_string(rate);
                const double tap_rate = c.at.tap_rate > 0 ? c.at.tap_rate : rate;
                const Run r = play(form, scene, {rate, tap_rate, c.at.modes, {}}, {.energy = true});
                EXPECT_EQ(r.status.outcome, Outcome::ok) << where;
                const Ledger l = ledger(r.trace);
                EXPECT_LE(l.row, c.open.row) << where;
                EXPECT_LE(l.sum, c.open.sum) << where;
                EXPECT_GE(l.least_loss, c.lost.least) << where;
                EXPECT_LE(l.lost, c.lost.at_most) << where;
                if (c.lost.more_than) { EXPECT_GT(l.lost, *c.lost.more_than) << where; }
                if (c.events) { EXPECT_GT(fact(r, "events"), *c.events) << where; }
                if (!c.pushes) continue;
                EXPECT_GE(fact(r, "smallest_contact_force"), 0) << where;
                EXPECT_GT(fact(r, "deepest_penetration"), 0) << where;
            }
}

// The error of every form against one truth, at rates that rise.
struct ConvergenceClaim {
    struct At {
        int modes = 0;
        int grid = 0;  // intervals at the rate of taps, and in proportion
        double tap_rate = 44100;
    };
    struct Truth {
        std::string form;
        int times = 0, modes = 0;  // 0: as many as the forms
    };
    struct Error {
        double first = HUGE_VAL, fall = 1, last = HUGE_VAL;  // at most; part of the one before
        std::optional<double> order = {};
        double within = 0;
        std::vector<double> errors = {};  // of the first tap, to `within` of them
        double left = 0;  // energy, as a part of the first: to so much over the rate
    };
    // times: of the rate of taps
    ConvergenceClaim(const char* name_, Forms forms_, Scene scene_, At at_, std::vector<int> times_,
                     Truth truth_, Error error_, std::vector<int> taps_ = {0})
        : name(name_),
          forms(std::move(forms_)),
          scene(std::move(scene_)),
          at(at_),
          times(std::move(times_)),
          truth(std::move(truth_)),
          error(std::move(error_)),
          taps(std::move(taps_)) {}
    std::string name;
    Forms forms;
    Scene scene;
    At at;
    std::vector<int> times;
    Truth truth;
    Error error;
    std::vector<int> taps;
};
inline void holds(const ConvergenceClaim& c) {
    const RunOptions how{.energy = c.error.left > 0};
    const int truth_modes = c.truth.modes > 0 ? c.truth.modes : c.at.modes;
    const Run truth = play(c.truth.form, c.scene,
                           {c.truth.times * c.at.tap_rate, c.at.tap_rate, truth_modes, {}}, how);
    const auto left = [](const Run& r) {
        return r.trace.energy_column(0).back() / r.trace.energy_column(0).front();
    };
    ASSERT_EQ(truth.status.outcome, Outcome::ok);
    for (const std::string& form : c.forms) {
        std::vector<double> before(c.taps.size());
        for (std::size_t i = 0; i < c.times.size(); ++i) {
            Settings s{c.times[i] * c.at.tap_rate, c.at.tap_rate, c.at.modes, {}};
            if (c.at.grid > 0) s.options = {{"grid", std::to_string(c.at.grid * c.times[i])}};
            const Run r = play(form, c.scene, s, how);
            ASSERT_EQ(r.status.outcome, Outcome::ok) << form;
            if (how.energy) { EXPECT_NEAR(left(r), left(truth), c.error.left / c.times[i]); }
            for (std::size_t k = 0; k < c.taps.size(); ++k) {
                const double error = apart(r, truth, c.taps[k]),
                             ratio = i > 0 ? double(c.times[i]) / c.times[i - 1] : 1;
                const auto where =
                    form + " x" + std::to_string(c.times[i]) + " tap " + r.trace.names[c.taps[k]];
                EXPECT_LT(error, i > 0 ? c.error.fall * before[k] : c.error.first) << where;
                if (i > 0 && c.error.order) {
                    EXPECT_NEAR(std::log(before[k] / error) / std::log(ratio), *c.error.order,
                                c.error.within)
                        << where;
                }
                if (i + 1 == c.times.size()) { EXPECT_LT(error, c.error.last) << where; }
                if (k == 0 && !c.error.errors.empty()) {
                    EXPECT_NEAR(error / c.error.errors[i], 1, c.error.within) << where;
                }
                before[k] = error;
            }
        }
    }
}

template <class Claim>
std::string name_of(const testing::TestParamInfo<Claim>& one) {
    return one.param.name;
}
inline void PrintTo(const LedgerClaim& c, std::ostream* out) { *out << c.name; }
inline void PrintTo(const ConvergenceClaim& c, std::ostream* out) { *out << c.name; }

}  // namespace jvari

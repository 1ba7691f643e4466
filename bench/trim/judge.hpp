// Models of one scene, judged: each against the motion of the whole scene, by one measure of one
// tap, and timed.
//
// A model is the scene less some of its parts, a scheme and its settings: a job of bench/study that
// is judged against the motion of the whole scene. Models that took more than a few milliseconds,
// costs and runs of the reference are kept in DIR/cells and DIR/references: they are read back by a
// study that was stopped and by the next one with another tolerance.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/compare/request.hpp"
#include "bench/study/run.hpp"
#include "bench/trim/target.hpp"
#include "scenes/reduction.hpp"

namespace jvari::bench::trim {

inline constexpr double worth = 0.95;  // what is cheaper costs less than this of the other

struct Request {
    std::string scene, measure = "l2_50ms", within, tap, scheme = "any", reference, out;
    std::vector<std::string> set, plugins;  // plugins: their files, which verdicts depend on
    // [s] that are run; absent: as far as the measure needs (Judge)
    std::optional<double> duration{};
    double tap_rate = 44100;  // [Hz]
    int reference_modes = 0;  // 0: doubled until nothing moves
    int jobs = 0;
    // of schemes: each value is tried, in place of those that trim tries by itself
    std::vector<compare::SchemeOption> options{};
};

struct Model {
    std::vector<int> left_out;  // of Judge::reductions, ascending
    const Descriptor* scheme;
    Settings settings;
    std::string settings_text() const;  // "modal_two_point compliance=matched, 80 modes, 44100 Hz"
};

Model toggled(Model, int part);  // without it, or with it once more

struct Verdict {
    // ok, or what speaks against it: refused, diverged, flags as compare has them
    std::string status;
    double error = std::numeric_limits<double>::quiet_NaN();
    double seconds = 0;  // of processor, of the judged run
};

struct Truth {  // of one start
    std::string reference, said;
    int modes = 0;
    double certificate = std::numeric_limits<double>::quiet_NaN();  // of the measure; NaN: unknown
    // what 1e-12 of the start changes
    double floor = 0;
    // [s], of the truth against itself with half its modes; NaN: not known
    double horizon = 0;
    double penetration = 1;  // deepest [m]
};

using CostOf = std::function<double(const Model&, const Scene& left)>;  // [s per s]
double processor_time(const Model&, const Scene&);                      // least of several samples

class Judge {
public:
    // It is judged from the end of its last pluck on: for 50 ms unless another duration is asked
    // for, by the decay to the end of the scene. Throws UsageError, SceneFileError, BadScene,
    // Refusal.
    Judge(const Request&, const compare::Catalogue&, const store::Listener&,
          CostOf = processor_time);

    const Scene& scene() const { return scene_; }  // whole, as long as it is judged
    double own_duration() const { return own_duration_; }
    double tap_rate() const { return request_.tap_rate; }
    const Target& target() const { return target_; }
    const Tap& tap() const { return scene_.taps[tap_]; }
    const std::vector<Reduction>& reductions() const { return reductions_; }
    const std::vector<compare::SchemeOption>& options() const { return request_.options; }
    // not what is listened to, nor a loss where the decay is not judged
    bool may_go(int reduction) const;

    // throws BadScene where what is left makes no sense
    Scene scene_of(const Model&, int start = 0) const;
    const Truth& truth(int start);

    // A run of more than `limit` s of processor is ended and not kept: "slow".
    Verdict verdict(const Model&, int start, double limit = HUGE_VAL);
    // NaN where one start fails, or what is left makes no scene
    double worst_error(const Model&, const std::vector<int>& of_starts);
    // The reference tells what is within the tolerance:
    // its certificate is below that, below half of it for other starts than the scene's.
    bool certain(int start);
    // Error and certificate together. Of another start whose reference is not certain: the error
    // alone.
    bool within(const Verdict&, int start);
    double cost(const Model&);  // [s of processor per s], least of several; kept
    // Cheaper than `now` by a twentieth and by more than the clock scatters, both timed anew in
    // turn.
    bool saves(const Model& less, const Model& now);
    // processor time, models in turn: what is quoted
    std::vector<Spread> costs(const std::vector<Model>&, int rounds);

    int judged() const { return keep_.ran; }
    int read_back() const { return keep_.kept - keep_.ran; }

private:
    bool judges_decay() const { return target_.measure->name == "decay"; }
    const study::Point& point(int start);          // the whole scene
    study::Plan plan_of(const Model&, int start);  // of one job

    Request request_;
    const compare::Catalogue& catalogue_;
    const store::Listener& listener_;
    CostOf cost_of_;
    Target target_;
    Scene scene_;
    double own_duration_;
    int tap_ = 0;
    // of the measure: of the whole run's error where the run is shorter than the measure's window
    std::size_t place_;
    std::string program_;
    std::vector<Reduction> reductions_;
    study::References references_;
    study::Kept keep_;
    store::Stamp stamp_;
    std::array<study::Plan, starts> points_;  // of one point each
    std::array<std::optional<Truth>, starts> truths_;
    std::map<std::string, Verdict> verdicts_;  // by the job's id
    std::map<std::string, double> costs_;
};

}  // namespace jvari::bench::trim

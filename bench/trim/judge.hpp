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
#include "bench/compare/target.hpp"
#include "bench/study/judgement.hpp"
#include "bench/study/run.hpp"
#include "scenes/reduction.hpp"

namespace jvari::bench::trim {

// ---- The scene's start and others of another family: higher modes, a sharp triangle near an end,
// a pluck or a hammer elsewhere. A model that is trimmed by one start is verified by the others, so
// that it is not tuned to one.

constexpr int starts = 5;
// 0: the scene's own. 1: a sharp corner near an end. 2: a higher mode. Further ones are elsewhere.
// Displacements and forces between six and nine tenths of its own, speeds between half and twice.
Scene started(Scene, int start);
std::string name_of_start(const Scene& own, int start);  // of the first string that it moves

// ---- Models and their judge.

using compare::Target;

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

std::string identity_of(const Request&);  // all that its results depend on but the program

struct Model {
    std::vector<int> left_out;  // of Judge::reductions, ascending
    const Descriptor* scheme;
    Settings settings;
    std::string settings_text() const { return compare::settings_text(*scheme, settings); }
};

Model toggled(Model, int part);  // without it, or with it once more

struct Judged {  // the run of a model; as it is: ended, for it took too long
    Verdict verdict = Verdict::error;
    double error = std::numeric_limits<double>::quiet_NaN();
    double seconds = HUGE_VAL;  // of processor
    bool trusted() const { return is_trusted(verdict); }
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
    const study::Truth& truth(int start);
    double certificate(int start);  // of the truth by the measure; NaN: unknown
    double floor(int start);        // what 1e-12 of the start changes

    // A run of more than `limit` s of processor is ended and not kept.
    Judged judged(const Model&, int start, double limit = HUGE_VAL);
    // NaN where one start fails, or what is left makes no scene
    double worst_error(const Model&, const std::vector<int>& of_starts);
    // The reference tells what is within the tolerance:
    // its certificate is below that, below half of it for other starts than the scene's.
    bool certain(int start);
    // Error and certificate together. Of another start whose reference is not certain: the error
    // alone.
    bool within(const Judged&, int start);
    double cost(const Model&);  // [s of processor per s], least of several; kept
    // Cheaper than `now` by a twentieth and by more than the clock scatters, both timed anew in
    // turn.
    bool saves(const Model& less, const Model& now);
    // processor time, models in turn: what is quoted
    std::vector<Spread> costs(const std::vector<Model>&, int rounds);

    int runs() const { return keep_.ran; }
    int read_back() const { return keep_.kept - keep_.ran; }

private:
    struct Known {
        study::References::Of reference;
        double certificate;
    };
    bool judges_decay() const { return target_.name == "decay"; }
    const study::Point& point(int start);          // the whole scene
    study::Plan plan_of(const Model&, int start);  // of one job
    const Known& known(int start);

    Request request_;
    const compare::Catalogue& catalogue_;
    const store::Listener& listener_;
    CostOf cost_of_;
    Target target_;
    Scene scene_;
    double own_duration_;
    std::size_t tap_ = 0;
    // of the measure: of the whole run's error where the run is shorter than the measure's window
    std::size_t measure_;
    std::string program_;
    std::vector<Reduction> reductions_;
    study::References references_;
    study::Kept keep_;
    store::Stamp stamp_;
    std::array<study::Plan, starts> points_;  // of one point each
    std::array<std::optional<Known>, starts> known_;
    std::map<std::string, Judged> judged_;  // by the job's id
    std::map<std::string, double> costs_;
};

}  // namespace jvari::bench::trim

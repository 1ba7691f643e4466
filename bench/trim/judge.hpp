// Judge of models for one scene: compares each model with the motion of the whole scene, by one
// measure at one tap, and times the model.
//
// A model is the scene without some of its parts, with a scheme and its settings. bench/study runs
// a model in the form of a job. DIR/cells and DIR/references keep costs, reference runs, and models
// that took more than a few milliseconds. A stopped study, or the next one with another tolerance,
// reads them back.
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

// ---- Starts: the scene's own, and others of another family: higher modes, a sharp triangle near
// an end, a pluck or a hammer elsewhere. The other starts verify a model trimmed by one start, so
// that the model is not tuned to one.

constexpr int starts = 5;
// Scene with another start. 0: the scene's own. 1: a sharp corner near an end. 2: a higher mode.
// Further starts are elsewhere. Displacements and forces are six to nine tenths of the own start's,
// speeds half to twice.
Scene started(Scene, int start);
std::string name_of_start(const Scene& own, int start);  // name for the first string that moves

// ---- Models and their judge.

using compare::Target;

inline constexpr double worth = 0.95;  // a cheaper model costs less than this share of the other

struct Request {
    std::string scene, measure = "l2_50ms", within, tap, scheme = "any", reference, out;
    std::vector<std::string> set, plugins;  // plugins: their files, because verdicts depend on them
    // duration of the run [s]; absent: the duration that the measure needs (Judge)
    std::optional<double> duration{};
    double tap_rate = 44100;  // [Hz]
    int reference_modes = 0;  // 0: doubled until the result settles
    int jobs = 0;
    // Options of schemes: trim tries each value, in place of its default values.
    std::vector<compare::SchemeOption> options{};
};

std::string identity_of(const Request&);  // everything that affects the results, except the program

struct Model {
    std::vector<int> left_out;  // places in Judge::reductions, ascending
    const Descriptor* scheme;
    Settings settings;
    std::string settings_text() const { return compare::settings_text(*scheme, settings); }
};

Model toggled(Model, int part);  // removes the part, or puts it back

struct Judged {  // run of a model; by default: ended for taking too long
    Verdict verdict = Verdict::error;
    double error = std::numeric_limits<double>::quiet_NaN();
    double seconds = HUGE_VAL;  // processor time
    bool trusted() const { return is_trusted(verdict); }
};

using CostOf = std::function<double(const Model&, const Scene& left)>;  // [s per s]
double processor_time(const Model&, const Scene&);  // smallest of several samples

class Judge {
public:
    // Judges from the end of the last pluck on, for 50 ms unless another duration is requested; for
    // the decay, to the end of the scene. Throws UsageError, SceneFileError, BadScene, Refusal.
    Judge(const Request&, const compare::Catalogue&, const store::Listener&,
          CostOf = processor_time);

    const Scene& scene() const { return scene_; }  // whole scene, with the judged duration
    double own_duration() const { return own_duration_; }
    double tap_rate() const { return request_.tap_rate; }
    const Target& target() const { return target_; }
    const Tap& tap() const { return scene_.taps[tap_]; }
    const std::vector<Reduction>& reductions() const { return reductions_; }
    const std::vector<compare::SchemeOption>& options() const { return request_.options; }
    // False for the judged tap, and for a loss unless the decay is judged.
    bool may_go(int reduction) const;

    // throws BadScene if the remaining scene is impossible
    Scene scene_of(const Model&, int start = 0) const;
    const study::Truth& truth(int start);
    double certificate(int start);  // uncertainty of the truth in this measure; NaN: unknown
    double floor(int start);        // noise floor: effect of changing the start by 1e-12

    // Runs a model. A run beyond `limit` s of processor time is ended and not kept.
    Judged judged(const Model&, int start, double limit = HUGE_VAL);
    // NaN if a start fails, or the remaining scene is impossible
    double worst_error(const Model&, const std::vector<int>& of_starts);
    // True if the reference can decide about the tolerance: its certificate is below the tolerance,
    // or below half the tolerance for starts other than the scene's.
    bool certain(int start);
    // Compares error plus certificate with the tolerance. For another start with an uncertain
    // reference, only the error counts.
    bool within(const Judged&, int start);
    double cost(const Model&);  // [s of processor per s], smallest of several; kept
    // True if cheaper than `now` by a twentieth and beyond the scatter of the timings. Both are
    // timed anew, in turn.
    bool saves(const Model& less, const Model& now);
    // Times the models in turn, for the quoted processor times.
    std::vector<Spread> costs(const std::vector<Model>&, int rounds);

    int runs() const { return keep_.ran; }
    int read_back() const { return keep_.kept - keep_.ran; }

private:
    struct Known {
        study::References::Of reference;
        double certificate;
    };
    bool judges_decay() const { return target_.name == "decay"; }
    const study::Point& point(int start);          // point of the whole scene
    study::Plan plan_of(const Model&, int start);  // plan with one job
    const Known& known(int start);

    Request request_;
    const compare::Catalogue& catalogue_;
    const store::Listener& listener_;
    CostOf cost_of_;
    Target target_;
    Scene scene_;
    double own_duration_;
    std::size_t tap_ = 0;
    // the target's measure, or the whole run's error if the run is shorter than the measure's
    // window
    std::size_t measure_;
    std::string program_;
    std::vector<Reduction> reductions_;
    study::References references_;
    study::Kept keep_;
    store::Stamp stamp_;
    std::array<study::Plan, starts> points_;  // plans with one point each
    std::array<std::optional<Known>, starts> known_;
    std::map<std::string, Judged> judged_;  // by the job's id
    std::map<std::string, double> costs_;
};

}  // namespace jvari::bench::trim

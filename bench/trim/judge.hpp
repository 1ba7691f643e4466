// Models of one scene, judged: each against the motion of the whole scene, by one measure of one tap, and timed.
//
// A model is the scene less some of its parts, a scheme and its settings. Truths, costs and verdicts that took more than a few milliseconds
// go to DIR/cells, addressed by all that they depend on: they are read back by a study that was stopped and by the next one with another
// tolerance.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/statistics.hpp"
#include "bench/compare/catalogue.hpp"
#include "bench/store/system/listener.hpp"
#include "bench/trim/start.hpp"
#include "bench/trim/target.hpp"
#include "scenes/reduction.hpp"

namespace jvari::bench::trim {

struct Request {
    std::string scene, measure = "l2_50ms", within, tap, scheme = "any", reference, out;
    std::vector<std::string> set, plugins;  // plugins: their files, which verdicts depend on
    double duration = 50e-3;                // [s] that are run and judged
    double tap_rate = 44100;                // [Hz]
    int reference_modes = 0;                // 0: doubled until nothing moves
    int jobs = 0;
};

struct Model {
    std::vector<int> left_out;  // of Judge::reductions, ascending
    const Descriptor* scheme;
    Settings settings;
    std::string settings_text() const;  // "modal_two_point compliance=matched, 80 modes, 44100 Hz"
};

struct Verdict {
    std::string status;  // ok, or what speaks against it: refused, diverged, flags as compare has them
    double error = std::numeric_limits<double>::quiet_NaN();
    double seconds = 0;  // of processor, of the judged run
    int dofs = 0;
};

struct Truth {  // of one start
    std::string reference, said;
    int modes = 0;
    double certificate = std::numeric_limits<double>::quiet_NaN();  // of the measure; NaN: unknown
    double floor = 0;                                               // what 1e-12 of the start changes
    double horizon = 0;                                             // [s], of the truth against itself with half its modes; NaN: not known
    double penetration = 1;                                         // deepest [m]
};

using CostOf = std::function<double(const Model&, const Scene& left)>;  // [s per s]
double processor_time(const Model&, const Scene&);                      // least of several samples

class Judge {
public:
    // Throws UsageError, SceneFileError, BadScene, Refusal.
    Judge(const Request&, const compare::Catalogue&, const store::Listener&, CostOf = processor_time);

    const Scene& scene() const { return scene_; }  // whole, as long as it is judged
    double own_duration() const { return own_duration_; }
    double tap_rate() const { return request_.tap_rate; }
    const Target& target() const { return target_; }
    const Tap& tap() const { return scene_.taps[tap_]; }
    const std::vector<Reduction>& reductions() const { return reductions_; }
    bool may_go(int reduction) const;  // not what is listened to

    Scene scene_of(const Model&, int start = 0) const;  // throws BadScene where what is left makes no sense
    const Truth& truth(int start);

    // A run of more than `limit` s of processor is ended and not kept: "slow".
    Verdict verdict(const Model&, int start, double limit = HUGE_VAL);
    // The reference tells what is within the tolerance: its certificate is below that, below half of it for other starts than the
    // scene's.
    bool certain(int start);
    // Error and certificate together. Of another start whose reference is not certain: the error alone.
    bool within(const Verdict&, int start);
    double cost(const Model&);                                               // [s of processor per s], least of several; kept
    std::vector<Spread> costs(const std::vector<Model>&, int rounds) const;  // processor time, models in turn: what is quoted

    int judged() const { return judged_; }
    int read_back() const { return read_back_; }

private:
    std::string identity(const Model&, int start, const char* what) const;
    const std::vector<double>& trace(int start);
    void run_truth(int start);
    std::filesystem::path file_of(const std::string& identity) const;
    template <class Read>
    auto kept(const std::string& identity, Read) const -> std::optional<std::invoke_result_t<Read, const nlohmann::ordered_json&>>;
    void keep(const std::string& identity, const nlohmann::ordered_json& content) const;

    Request request_;
    const compare::Catalogue& catalogue_;
    const store::Listener& listener_;
    CostOf cost_of_;
    Target target_;
    Scene scene_;
    double own_duration_;
    int tap_ = 0;
    std::string program_;
    std::vector<Reduction> reductions_;
    std::array<std::optional<Truth>, starts> truths_;
    std::array<std::optional<std::vector<double>>, starts> traces_;
    std::map<std::string, Verdict> verdicts_;  // by identity
    std::map<std::string, double> costs_;
    int judged_ = 0, read_back_ = 0;
};

}  // namespace jvari::bench::trim

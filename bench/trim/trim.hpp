// The cheapest model of a scene within a tolerance.
//
// A model is a set of parts left out, a scheme with its options, a rate and a number of modes.
//   0. The whole scene, compliance the scheme's own, as published: what the trimmed model is
//      compared with.
//   1. Of the whole scene, less the taps that are not judged: for each scheme, own and matched
//      compliance, and each rate the fewest modes that serve; the cheapest stays
//      (cheapest_settings.hpp). It begins with the settings that two runs advise
//      (compare/advice.hpp).
//   2. In turn the part that saves most for the error it costs is left out, the fewest modes at
//      half, the same and twice the rate are sought anew, and what is cheaper stays. Parts that
//      went before are put back in the same way: what one part costs depends on others.
//   3. Step 1 for what is left: a plainer scene is open to more schemes. What is cheaper stays, and
//      step 2 begins again.
// Cheaper is by a twentieth or more: a part that saves less stays, and so do losses unless the
// decay is judged. Of costs that are closer the more accurate model is taken, so that a clock's
// noise decides nothing. Costs are processor time, so that what else the machine does hardly
// counts.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "bench/compare/advice.hpp"
#include "bench/store/records.hpp"
#include "bench/trim/judge.hpp"

namespace jvari::bench::trim {

inline constexpr double longest = 10;  // of one judged run [s]
// a judged run is probed: it takes at most so much longer
inline constexpr double judged_over_timed = 4;

struct Variant {
    const Descriptor* scheme;
    OptionValues options;
    std::string name() const;
};
// The values asked for; of options that nobody named compliance=matched too, and with it fewer
// points of a profile.
std::vector<Variant> variants_of(const Descriptor&, const Scene&,
                                 const std::vector<compare::SchemeOption>& = {});

struct Step {
    std::string change;  // to the model of the step before
    Model model;
    // worst of the starts that it is judged by
    double error = std::numeric_limits<double>::quiet_NaN();
    double cost = std::numeric_limits<double>::quiet_NaN();  // [s of processor per s]
    bool within = false;
};

struct Path {
    // [0]: the whole scene without matched compliance; the last is the trimmed model
    std::vector<Step> steps;
    bool within_tolerance = false;   // the last step is
    std::vector<std::string> tried;  // schemes that represent the whole scene
    // variants of the whole scene, after a first look: "name (its errors)"
    std::vector<std::string> passed_over;
};

// Judged by these starts. advised: settings of the whole scene that two runs advise, or nullptr:
// what costs more is not looked at where they serve.
Path search(Judge&, const std::vector<const Descriptor*>& schemes, const std::vector<int>& starts,
            const store::Listener&, const compare::Advice* advised = nullptr);

// ---- Search, verification by another start, needs, and what was not tried.

// What each part of a scene is needed for: the error if it alone is left out, and what it costs.
struct Need {
    std::string part, becomes;
    // of the whole scene at the trimmed model's settings without it, worst of the starts; NaN: no
    // such model runs
    double error;
    // of that model's cost, a share; negative where the rest costs more. NaN: not timed
    double saved;
    // of the trimmed model, the part's state turned round: put back, or left out as well
    double error_in_trimmed;
    bool left_out;  // of the trimmed model
    bool needed;    // left out alone, the error is beyond the tolerance
};

struct Verified {
    int start;
    std::string name;           // "a triangle at 0.3 m, 0.00152 m"
    double error, certificate;  // certificate NaN: unknown
    bool within;
    bool judged_by;  // the search knew this start
    bool decided;    // Judge::certain
};

struct Trimmed {
    Scene whole, scene;  // the trimmed one as long as it was judged
    double own_duration;
    Path path;
    std::vector<Spread> costs;  // of the path's steps, timed in turn
    std::vector<Need> needs;
    std::vector<Verified> verified;  // of all starts
    std::vector<std::string> not_tried;
    int judged = 0, read_back = 0;
    int independent() const {  // how many starts verified it that the search did not know
        return static_cast<int>(std::ranges::count_if(
            verified, [](const Verified& v) { return v.decided && !v.judged_by; }));
    }
    const Step& full() const { return path.steps.front(); }
    const Step& last() const { return path.steps.back(); }
};

// The model is verified by all starts. Where it fails, the start where it fails worst joins those
// that the search is judged by. Throws Refusal where the reference is not certain enough to tell
// what is within.
Trimmed trimmed(Judge&, const Request&, const compare::Catalogue&, const store::Listener&);

// ---- As files: trimmed.toml, needs.csv, path.csv, manifest.json.

store::Table needs_table(const Trimmed&);
store::Table path_table(const Trimmed&, Judge&);
// that runs the trimmed model: "jvari run trimmed.toml --scheme ..."
std::string command_of(const Trimmed&, const std::string& file);
std::string trimmed_toml(const Trimmed&, const Judge&);
nlohmann::ordered_json manifest_of(const Trimmed&, Judge&, const Request&);

}  // namespace jvari::bench::trim

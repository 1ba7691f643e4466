// Trimming: the cheapest model of a scene within a tolerance.
//
// A model is a set of parts left out, a scheme with its options, a rate and a number of modes.
//   0.  Start: the whole scene with the scheme's own compliance, the published form. The trimmed
//       model is compared with this one.
//   1.  For the whole scene without unjudged taps: the smallest sufficient number of modes, for
//       each scheme, own and matched compliance, and each rate. The cheapest stays
//       (cheapest_settings.hpp). The search begins with the advised settings (compare/advice.hpp).
//   2.  In turn, the part with the largest saving per added error is left out. The smallest number
//       of modes at half, the same and twice the rate is searched again, and a cheaper model stays.
//       Parts left out earlier are put back in the same way, because the cost of a part depends on
//       other parts.
//   3.  Step 1 for the remaining scene, because more schemes can run a simpler scene. A cheaper
//       model stays, and step 2 begins again.
// "Cheaper" means by a twentieth or more. A part that saves less stays, and so do losses unless the
// decay is judged. At similar costs the more accurate model wins, so that timing noise decides
// nothing. Costs are processor times, so that other programs hardly affect them.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "bench/compare/advice.hpp"
#include "bench/store/records.hpp"
#include "bench/trim/judge.hpp"

namespace jvari::bench::trim {

inline constexpr double longest = 10;  // longest judged run [s]
// factor on the time limit, because a judged run has its energy probed
inline constexpr double judged_over_timed = 4;

struct Variant {
    const Descriptor* scheme;
    OptionValues options;
    std::string name() const;
};
// Variants: the requested values; for options that nobody named, also compliance=matched, and with
// matched compliance fewer points for a profile.
std::vector<Variant> variants_of(const Descriptor&, const Scene&,
                                 const std::vector<compare::SchemeOption>& = {});

struct Step {
    std::string change;  // relative to the model before
    Model model;
    // worst error over the starts for judging
    double error = std::numeric_limits<double>::quiet_NaN();
    double cost = std::numeric_limits<double>::quiet_NaN();  // [s of processor per s]
    bool within = false;
};

struct Path {
    // steps[0]: the whole scene without matched compliance; the last step is the trimmed model
    std::vector<Step> steps;
    bool within_tolerance = false;   // true if the last step is
    std::vector<std::string> tried;  // schemes that represent the whole scene
    // variants of the whole scene, after a first look: "name (its errors)"
    std::vector<std::string> passed_over;
};

// Searches with these starts for judging. advised: settings for the whole scene from two runs, or
// nullptr. If these settings are sufficient, models with higher costs are skipped.
Path search(Judge&, const std::vector<const Descriptor*>& schemes, const std::vector<int>& starts,
            const store::Listener&, const compare::Advice* advised = nullptr);

// ---- Search, verification by another start, needs, and attempts left out.

// Need for a part of a scene: the error if only this part is left out, and the part's cost.
struct Need {
    std::string part, becomes;  // becomes "": left out
    // worst error over the starts without the part, for the whole scene at the trimmed model's
    // settings; NaN: no such model runs
    double error;
    // saved share of the cost with the part; negative if the rest costs more. NaN: not timed
    double saved;
    // error of the trimmed model with this part put back, or left out in addition
    double error_in_trimmed;
    bool left_out;  // true if the trimmed model lacks the part
    bool needed;    // true if the error without this part is beyond the tolerance
};

struct Verified {
    int start;
    std::string name;           // "a triangle at 0.3 m, 0.00152 m"
    double error, certificate;  // certificate NaN: unknown
    bool within;
    bool judged_by;  // true if the search used this start
    bool decided;    // Judge::certain
};

struct Trimmed {
    Scene whole, scene;  // trimmed scene, with the judged duration
    double own_duration;
    Path path;
    std::vector<Spread> costs;  // for the path's steps, timed in turn
    std::vector<Need> needs;
    std::vector<Verified> verified;  // all starts
    std::vector<std::string> not_tried;
    int judged = 0, read_back = 0;
    int independent() const {  // number of verifying starts that the search did not use
        return static_cast<int>(std::ranges::count_if(
            verified, [](const Verified& v) { return v.decided && !v.judged_by; }));
    }
    const Step& full() const { return path.steps.front(); }
    const Step& last() const { return path.steps.back(); }
};

// Searches a model and verifies it with all starts. After a failure, the worst start joins the
// search's starts, and the search runs again. Throws Refusal if the reference is too uncertain to
// decide about the tolerance.
Trimmed trimmed(Judge&, const Request&, const compare::Catalogue&, const store::Listener&);

// ---- Files: trimmed.toml, needs.csv, path.csv, manifest.json.

store::Table needs_table(const Trimmed&);
store::Table path_table(const Trimmed&, Judge&);
// Command that runs the trimmed model: "jvari run trimmed.toml --scheme ...".
std::string command_of(const Trimmed&, const std::string& file);
std::string trimmed_toml(const Trimmed&, const Judge&);
nlohmann::ordered_json manifest_of(const Trimmed&, Judge&, const Request&);

}  // namespace jvari::bench::trim

// The maps of a suite: every point, the boundaries along x by bisection, minimised reproducers of
// what fails, and all of it as files. Each point is content-addressed and kept as
// DIR/points/<id>.json, so that a suite which was stopped goes on where it was and comes to the
// same tables. Processes that share DIR run each point once.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/store/records.hpp"
#include "bench/study/judgement.hpp"
#include "bench/study/run.hpp"
#include "bench/suite/suite.hpp"

namespace jvari::bench::suite {

// ---- One point of a map: a scheme at its settings on one scene, run for as long as the scene says
// and judged. A trial is what is varied; a job of bench/study is what is run of it.

struct Trial {
    const Descriptor* scheme;
    Scene scene;
    Settings settings;
    // "none"; a name; "": the first of the references that represents the scene
    std::string reference;
    int reference_modes = 0;  // 0: those of this trial
};

// The trial that the assignments describe; keys as an axis of a map has them. `rate` is 44100 Hz
// unless set. Rows are taken at the rate divided by the whole number that brings it nearest to 44.1
// kHz. Throws SceneFileError, BadScene, UsageError.
Trial trial_of(const std::string& scene, const Descriptor&, const std::string& reference,
               const std::vector<Assignment>&, int reference_modes = 0);

double row_rate(double sample_rate);

// What maps listen to in place of the scene's own taps:
// the displacement of every string at two points, and its nut force. The worst string decides.
Scene listened(Scene);

struct MapRequest {
    std::string program;  // program_identity: counts into the address of what is kept
    // DIR, in whose points/ records are kept, and references in references/; "" for nowhere
    std::filesystem::path folder;
    bool resume = false;  // what lies there is read back
    int jobs = 0;         // 0: as many as there are cores
};

struct Tried {
    study::Record record;
    double error;  // relative L2 of the worst string's nut force, NaN where there is none
    study::Judgement judgement;
};

// Runs trials as jobs. Their references are kept as long as it lives.
class Trials {
public:
    explicit Trials(const compare::Catalogue&, const MapRequest& = {"{}", {}, false, 0});

    // Where another process or thread runs it: what that comes to, or nothing unless `wait`.
    std::optional<Tried> operator()(const Trial&, bool wait);
    Tried operator()(const Trial& t) { return *(*this)(t, true); }
    study::Plan plan_of(const Trial&) const;  // of one job
    int ran() const { return keep_.ran; }

private:
    std::vector<study::ReferenceChoice> references_of(const Trial&) const;
    const compare::Catalogue& catalogue_;
    const MapRequest request_;
    study::References references_;
    study::Kept keep_;
};

// ---- All points and boundaries.

struct PointPlace {  // on a map
    const Map* map;
    const Descriptor* scheme;
    std::string x, y;  // "" for a map without y
};
Trial trial_at(const PointPlace&);

struct JudgedPoint {
    PointPlace at;
    Tried tried;
};
struct Boundary {
    const Map* map;
    const Descriptor* scheme;
    std::string y;
    study::Verdict low, high;            // outcomes on its sides
    std::string x_low, x_high;           // between them it lies
    double theory;                       // NaN where there is none
    double relative_difference() const;  // of the middle from theory
};
struct MapRun {
    std::vector<JudgedPoint> points;   // in the order of the file: map, scheme, y, x
    std::vector<Boundary> boundaries;  // in that order
    int ran = 0, read_back = 0;        // points, those of bisections included
};

// Throws what a scene or a name that is none throws, before anything is run.
MapRun run_maps(const std::vector<Map>&, const compare::Catalogue&, const MapRequest&,
                const store::Listener&);

// Bisection of a change between two outcomes along one axis: `verdict_at(x)` is asked at most
// `times` times, at the geometric mean of positive numbers and the arithmetic of others, and not
// between neighbours where only `whole` numbers count. Where a third outcome lies between, the
// search goes on towards where stability ends, and where both sides are stable, or neither is,
// towards the lower.
struct Bracket {
    double low, high;
    study::Verdict at_low, at_high;
};
template <class VerdictAt>
Bracket bisect(Bracket b, int times, bool whole, VerdictAt verdict_at) {
    for (int n = 0; n < times; ++n) {
        double middle = b.low > 0 ? std::sqrt(b.low) * std::sqrt(b.high) : 0.5 * (b.low + b.high);
        if (whole) middle = std::round(middle);
        if (!(middle > b.low && middle < b.high)) break;
        const study::Verdict v = verdict_at(middle);
        const bool stable = study::is_stable(b.at_low),
                   ends = stable != study::is_stable(b.at_high);
        const bool lower =
            v == b.at_low || (v != b.at_high && ends && study::is_stable(v) == stable);
        if (lower) b.low = middle, b.at_low = v;
        else b.high = middle, b.at_high = v;
    }
    return b;
}

// ---- Boundaries that are known, for maps to be compared with: those that schemes state as their
// limit (Descriptor::limit), and
//
//   nyquist         the highest mode's frequency is half the rate
//
// Of the schemes in the program:
//   grid_limit      the spacing of the grid is the least that is stable (finite_difference.hpp)
//   penalty_limit   the highest root of the string in lasting contact passes z = -1
//                   (modal_explicit_penalty.cpp)

std::vector<std::string> theories();

// For which motion it holds: "lasting contact: where the string parts from the barrier the boundary
// is elsewhere".
std::string motion_of(const std::string& theory);

// Positive on the sound side, 0 on the boundary; NaN where the theory has nothing to say of the
// scheme.
double theory_margin(const std::string& theory, const Descriptor&, const Scene&, const Settings&);

// ---- Minimised reproducers: a scene file <scheme>-<outcome>.toml for each way in which a scheme
// fails, and index.csv that says how to run it and what becomes of it.

struct Reproducer {
    std::string file;  // within its folder
    Trial trial;
    study::Judgement expected;
};

// Of each scheme and outcome that is neither sound nor without a run (refused, error), the failure
// that took the fewest steps, among maps that reproduce theirs.
// What was minimised is kept beside the points, so that processes that share a folder minimise each
// once.
std::vector<Reproducer> reproducers_of(const MapRun&, const compare::Catalogue&, const MapRequest&,
                                       const store::Listener&);

void write_failures(const std::filesystem::path& folder, const std::vector<Reproducer>&);
std::vector<Reproducer> read_failures(const std::filesystem::path& folder,
                                      const compare::Catalogue&);

// ---- A trial that fails, made as small as it still fails in the same way: delta debugging over
// what a scene and its settings are made of.
//
// Taken away one by one, in turn, until nothing more can be (scenes/reduction.hpp): strings,
// barriers, polarisation, pluck or initial shape (one of the two stays), thread, losses, bending
// stiffness, contact losses, an exponent other than 1; then duration, modes or the grid's intervals
// are shortened by halves, quarters ... down to single rows and modes.
// What is left is minimal step by step, not the smallest of all.

// in the way that is to be kept; what it throws counts as no
using Fails = std::function<bool(const Trial&)>;

Trial minimised(Trial, const Fails&);

// ---- As rows (maps.csv, boundaries.csv), as text, and as files of a suite. The report draws them.

store::Table maps_table(const MapRun&);

// Files of minimised reproducers by scheme and outcome. A boundary names that of the side that
// fails, of the upper one where both do.
using Reproducers = std::map<std::pair<std::string, study::Verdict>, std::string>;
store::Table boundaries_table(const MapRun&, const Reproducers&);

// for the terminal: outcomes of each map and scheme, boundaries that have a theory
std::string maps_text(const MapRun&);

struct RecordedMaps {
    std::vector<std::string> files;  // written
    std::string text;                // for the terminal; "" where there are no maps
};
// Runs them, and writes maps.csv, boundaries.csv and minimised reproducers in failures/ where there
// is a folder.
RecordedMaps run_and_record_maps(const std::vector<Map>&, const compare::Catalogue&,
                                 const MapRequest&, const store::Listener&);

}  // namespace jvari::bench::suite

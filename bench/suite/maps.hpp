// Maps of a suite: all points, boundaries along x by bisection, minimised reproducers of failures,
// and their files. Each point is content-addressed and kept in DIR/points/<id>.json, so a stopped
// suite continues and produces the same tables. Processes that share DIR run each point once.
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

// ---- Point of a map: a scheme with its settings on one scene, run for the scene's duration and
// judged. A trial holds the varied values; bench/study runs a trial in the form of a job.

struct Trial {
    const Descriptor* scheme;
    Scene scene;
    Settings settings;
    // "none"; a name; "": the first reference that represents the scene
    std::string reference;
    int reference_modes = 0;  // 0: this trial's modes
};

// Trial for the assignments, with keys in the syntax of a map's axis. `rate` is 44100 Hz by
// default. The row rate is `rate` divided by the whole number that brings it nearest to 44.1 kHz.
// Throws SceneFileError, BadScene, UsageError.
Trial trial_of(const std::string& scene, const Descriptor&, const std::string& reference,
               const std::vector<Assignment>&, int reference_modes = 0);

double row_rate(double sample_rate);

// Taps for maps, in place of the scene's own: the displacement of every string at two points, and
// its nut force. The worst string decides.
Scene listened(Scene);

struct MapRequest {
    std::string program;  // program_identity, part of the addresses
    // DIR, with records in points/ and references in references/; "" for nowhere
    std::filesystem::path folder;
    bool resume = false;  // true: reads back the files in DIR
    int jobs = 0;         // 0: the number of cores
};

struct Tried {
    study::Record record;
    double error;  // relative L2 error in the worst string's nut force, NaN if unknown
    study::Judgement judgement;
};

// Runs trials in the form of jobs, and keeps their references during its lifetime.
class Trials {
public:
    explicit Trials(const compare::Catalogue&, const MapRequest& = {"{}", {}, false, 0});

    // Tries a trial. If another process or thread is running the trial, waits for the result, or
    // returns nothing if not `wait`.
    std::optional<Tried> operator()(const Trial&, bool wait);
    Tried operator()(const Trial& t) { return *(*this)(t, true); }
    study::Plan plan_of(const Trial&) const;  // a single job
    int ran() const { return keep_.ran; }

private:
    std::vector<study::ReferenceChoice> references_of(const Trial&) const;
    const compare::Catalogue& catalogue_;
    const MapRequest request_;
    study::References references_;
    study::Kept keep_;
};

// ---- All points and boundaries.

struct PointPlace {  // place on a map
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
    std::string x_low, x_high;           // the boundary lies between
    double theory;                       // NaN if unknown
    double relative_difference() const;  // distance from theory, for the middle
};
struct MapRun {
    std::vector<JudgedPoint> points;   // in the order of the file: map, scheme, y, x
    std::vector<Boundary> boundaries;  // in the same order
    int ran = 0, read_back = 0;        // number of points, including bisections
};

// Runs maps. Throws for a wrong scene or name, before anything runs.
MapRun run_maps(const std::vector<Map>&, const compare::Catalogue&, const MapRequest&,
                const store::Listener&);

// Bisection for a change between two outcomes along one axis. `verdict_at(x)` is called at most
// `times` times, at the geometric mean of positive numbers and the arithmetic mean of others; with
// `whole`, not between neighbouring integers. If a third outcome lies between, the search continues
// toward the end of stability. If both sides are stable, or neither, the search continues toward
// the lower side.
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

// ---- Known boundaries, for comparison with maps: the limits declared by schemes
// (Descriptor::limit), and
//
//   nyquist         the highest mode's frequency is half the rate
//
// Limits from schemes in the program:
//   grid_limit      the grid has the smallest stable spacing (finite_difference.hpp)
//   penalty_limit   the highest root of the string in lasting contact passes z = -1
//                   (modal_explicit_penalty.cpp)

std::vector<std::string> theories();

// Kind of motion that the theory describes: "lasting contact: where the string parts from the
// barrier the boundary is elsewhere".
std::string motion_of(const std::string& theory);

// Margin: positive on the sound side, 0 on the boundary; NaN if the theory does not cover the
// scheme.
double theory_margin(const std::string& theory, const Descriptor&, const Scene&, const Settings&);

// ---- Minimised reproducers: a scene file <scheme>-<outcome>.toml for each kind of failure of a
// scheme, and index.csv with the command and the outcome.

struct Reproducer {
    std::string file;  // name within its folder
    Trial trial;
    study::Judgement expected;
};

// Reproducers for each scheme and each kind of failure. Cells without a run (refused, error) and
// outcomes sound, flagged and unjudged are no failures. Starts from the failure with the fewest
// steps, in maps with `reproduce`. The minimised files are kept beside the points, so that
// processes with a shared folder minimise each failure once.
std::vector<Reproducer> reproducers_of(const MapRun&, const compare::Catalogue&, const MapRequest&,
                                       const store::Listener&);

void write_failures(const std::filesystem::path& folder, const std::vector<Reproducer>&);
std::vector<Reproducer> read_failures(const std::filesystem::path& folder,
                                      const compare::Catalogue&);

// ---- Minimising a failing trial: delta debugging over the parts of a scene and its settings. The
// smaller trial still fails in the same way.
//
// Parts are removed one by one, in turn, until no more can go (scenes/reduction.hpp). The order is
// strings, barriers, polarisation, pluck or initial shape (one of the two stays), thread, losses,
// bending stiffness, contact losses, an exponent other than 1. Then duration, modes or the grid's
// intervals are reduced by halves, quarters ... down to single rows and modes. The result is
// minimal step by step, not the smallest possible.

// True if the trial fails in the required way; an exception counts as false.
using Fails = std::function<bool(const Trial&)>;

Trial minimised(Trial, const Fails&);

// ---- Rows (maps.csv, boundaries.csv), text, and files of a suite. The report draws them.

store::Table maps_table(const MapRun&);

// Files with minimised reproducers, by scheme and outcome. A boundary names the file for its
// failing side, for the upper side if both fail.
using Reproducers = std::map<std::pair<std::string, study::Verdict>, std::string>;
store::Table boundaries_table(const MapRun&, const Reproducers&);

// Text for the terminal: outcomes for each map and scheme, boundaries with a theory.
std::string maps_text(const MapRun&);

struct RecordedMaps {
    std::vector<std::string> files;  // written files
    std::string text;                // for the terminal; "" without maps
};
// Runs the maps. Writes maps.csv, boundaries.csv and minimised reproducers in failures/ if there is
// a folder.
RecordedMaps run_and_record_maps(const std::vector<Map>&, const compare::Catalogue&,
                                 const MapRequest&, const store::Listener&);

}  // namespace jvari::bench::suite

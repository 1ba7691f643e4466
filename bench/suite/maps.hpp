// Maps: the sets of cells whose facet is `outcome`, over one or two swept keys. Their points are
// cells like others: kept in DIR/cells, resumed and shared. Then boundaries along the first key are
// found by bisection, and failures are made as small as possible (failures.cpp).
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
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

// ---- Points: a scheme with its settings on a scene, judged by its outcome.

// Sample rate divided by the whole number that brings it nearest to 44.1 kHz: the rate of rows.
double row_rate(double sample_rate);

// Taps for maps, in place of the scene's own: the displacement of every string at two points, and
// its nut force. The worst string decides.
Scene listened(Scene);

// Point to judge schemes on. `reference`: "none"; a name; "": the first reference that represents
// the scene. `reference_modes` 0: those of the settings.
study::Point judged_point(const compare::Catalogue&, Scene, const Settings&,
                          const std::string& reference, int reference_modes);
study::Job judged_job(const Descriptor&, const study::Point&, const Settings&);

struct MapPoint {
    const study::Job* job;  // has the swept values, with its point
    study::Record record;
    double error;  // relative L2 error in the worst string's nut force, NaN if unknown
    study::Judgement judgement;
    MapPoint(const study::Job&, study::Record);
};
// Swept key and its value at a point; "" for a map without a second key.
const std::pair<std::string, std::string>& swept_at(const MapPoint&, std::size_t key);

// ---- All points and boundaries.

// Bisection for a change between two outcomes along one axis. `verdict_at(x)` is called at most
// `times` times, at the geometric mean of positive numbers and the arithmetic mean of others; with
// `whole`, not between neighbouring integers. If a third outcome lies between, the search continues
// toward the end of stability. If both sides are stable, or neither, the search continues toward
// the lower side.
struct Bracket {
    double low, high;
    study::Verdict at_low, at_high;
    double middle() const { return 0.5 * (low + high); }
};
std::optional<double> middle_of(const Bracket&, bool whole);  // nothing if there is none
void narrow(Bracket&, double middle, study::Verdict);
template <class VerdictAt>
Bracket bisect(Bracket b, int times, bool whole, VerdictAt verdict_at) {
    while (times-- > 0)
        if (const auto x = middle_of(b, whole)) narrow(b, *x, verdict_at(*x));
    return b;
}

struct Boundary {
    const MapPoint* below;  // last point of the grid before the boundary
    Bracket between;
    double theory = nan;
    double relative_difference() const { return between.middle() / theory - 1; }
};
struct MapRun {
    const std::vector<CellSet>* maps;
    std::vector<MapPoint> points{};      // in the order of the file: map, scheme, y, x
    std::vector<Boundary> boundaries{};  // in the same order
    int ran = 0, read_back = 0;          // number of points, including bisections
    const CellSet& map_of(const MapPoint& p) const {
        return (*maps)[static_cast<std::size_t>(p.job->set)];
    }
};

// Runs the plan of these maps, and their bisections, with records in `folder` (DIR/cells). The plan
// must outlive the result.
MapRun run_maps(const std::filesystem::path& folder, bool resume, const std::vector<CellSet>& maps,
                const study::Plan&, const compare::Catalogue&,
                const std::vector<std::string>& plugins, int jobs, const store::Listener&);

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

// ---- Failures: a scene file <scheme>-<outcome>.toml for the cheapest failure of each kind of a
// scheme, minimised, and index.csv with the command and the outcome.

struct Failure {
    std::string file;  // name within its folder
    const Descriptor* scheme;
    Scene scene;
    Settings settings;
    std::string reference;  // as for judged_point
    int reference_modes = 0;
    study::Judgement expected{};
};

// Plan of one job: the failing run.
study::Plan plan_of(const Failure&, const compare::Catalogue&, const std::string& program);
// Runs it. The references stay, for other forms of the same failure.
study::Judgement outcome_of(const Failure&, const compare::Catalogue&, study::References&);

// Failure of each scheme and kind. Cells without a run (refused, error) and outcomes sound, flagged
// and unjudged are no failures. Starts from the failure with the fewest steps, in maps with
// `reproduce`. The minimised files are kept beside the cells, so that processes with a shared
// folder minimise each failure once.
std::vector<Failure> failures_of(const std::filesystem::path& folder, bool resume, const MapRun&,
                                 const compare::Catalogue&, const std::vector<std::string>& plugins,
                                 int jobs, const store::Listener&);

void write_failures(const std::filesystem::path& folder, const std::vector<Failure>&);
std::vector<Failure> read_failures(const std::filesystem::path& folder, const compare::Catalogue&);

// Delta debugging over the parts of a scene and its settings. The smaller failure still fails in
// the same way, by `fails`; an exception counts as false.
//
// Parts are removed one by one, in turn, until no more can go (scenes/reduction.hpp). The order is
// strings, barriers, polarisation, pluck or initial shape (one of the two stays), thread, losses,
// bending stiffness, contact losses, an exponent other than 1. Then duration, modes or the grid's
// intervals are reduced by halves, quarters ... down to single rows and modes. The result is
// minimal step by step, not the smallest possible.
using Fails = std::function<bool(const Failure&)>;
Failure minimised(Failure, const Fails&);

// ---- Rows (maps.csv, boundaries.csv) and text. The report draws them.

store::Table maps_table(const MapRun&);
// A boundary names the file of the failure on its failing side, on the upper side if both fail.
store::Table boundaries_table(const MapRun&, const std::vector<Failure>&);

// Text for the terminal: outcomes for each map and scheme, boundaries with a theory.
std::string maps_text(const MapRun&);

}  // namespace jvari::bench::suite

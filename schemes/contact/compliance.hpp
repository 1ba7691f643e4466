// Computes the compliance that a scheme takes from its string; matching puts it back in series with
// the contacts.
//
// Under a steady force of 1 N at point q the string yields by C_true,pq at point p. A scheme's
// string yields by C_scheme,pq: it has cut the modes above some frequency (MacNeal 1971; Rubin
// 1975: residual flexibility), and its step or its grid stiffens or softens the rest. With C =
// C_true - C_scheme in series, Y_p = (reading of the scheme's string at p) + sum_q C_pq F_q, both
// yield alike under any steady load. The taps are corrected likewise: tap r = (reading of the
// scheme's string) + sum_q R_rq F_q. docs/compliance-matching.md explains the rest.
//
// C_true is in closed form for the stiff string under tension with simply supported ends: with l =
// sqrt(T/EI), x <= z,
//     G(x, z) = [x (L - z)/L - sinh(l x) sinh(l (L - z))/(l sinh(l L))]/T,
// averaged over cosine footprints (van Walstijn et al. 2016, eqs 5-6). For measured modes C_true is
// the sum over all of them.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// Option of every scheme that can carry the series compliance.
inline constexpr Option compliance_option{
    "compliance",
    "own",
    "matched: what cut and step take from the string's compliance, in series with its contacts",
    {"own", "matched"}};

struct Footprint {        // region in which a force acts and a displacement is read
    double position = 0;  // centre [m]
    double width = 0;     // width of the cosine [m]; 0: a point
    double sign = 1;      // -1: both count downwards, at a barrier above
};
std::vector<double> footprint_weights(const Modes&, const Footprint&);

// C_true [m/N]
double static_deflection(const String&, const Footprint& at, const Footprint& force);

// Resistance at a point from the modes beyond the first `kept`, represented by a single damper
// beside the spring C_cut that they form under a steady force [kg/s]. With their admittance H(s) =
// sum of g_i^2/(m (s^2 + omega_i^2)), H(s) = C_cut/(1 + s R C_cut) at a third of the last kept
// mode's frequency. If no mode is left out, half the string's wave resistance, sqrt(T mu). For
// schemes from outside.
double radiation_resistance(const String&, const Footprint&, int kept);

// Effect of the modes beyond the first `kept` at the points, in matrices over the points. C is
// their static yield, the sum of g g'/(m omega^2); `folded` is the part of C from modes above
// `nyquist` [rad/s]. E is the inertia of the others, the sum of g g'/(m omega^4). Empty if no mode
// is left out.
struct CutModes {
    // the kept modes and, after them, the cut modes that are summed
    Modes modes;
    std::vector<std::vector<double>> g;  // for each point
    std::vector<double> C, E, folded;    // [m/N], [m s^2/N], [m/N]
};
CutModes cut_modes(const String&, std::span<const Footprint> points, int kept, double nyquist);

// Ladder beside the spring C, with D' the velocity of the points: a damper, and masses behind
// dampers. Each mass belongs to a pattern V_k of the points.
//     F = C^-1 D + damper D' + sum of V_k resistance_k (V_k.D' - v_k),
//     mass_k v_k' = resistance_k (V_k.D' - v_k)
struct Ladder {
    std::vector<double> damper;  // points x points [kg/s]
    // equally many patterns and points, x points; unit length, the first component not negative
    std::vector<double> V;
    std::vector<double> mass, resistance;  // for each pattern [kg], [kg/s]; 0: none
};

double static_nut_force(const String&, const Footprint& force);  // for 1 N [1]

struct Reading {
    Footprint at;
    bool nut_force = false;  // the force on the nut, in place of the displacement at `at`
    double below = std::numeric_limits<double>::infinity();  // limit for the modes read [Hz]
};
std::vector<double> reading_weights(const Reading&, const Modes&, const String&);

// Places at which a scene's only string is pushed and read. Forces are its contacts, thread and
// pluck in this order, if present; readings are contacts and thread, then the displacement and
// nut-force taps.
struct Sites {
    std::vector<Footprint> forces;
    int contacts = 0;
    bool thread = false, pluck = false;
    int points() const { return contacts + (thread ? 1 : 0); }
    std::vector<Reading> readings;
    std::vector<std::size_t> tap;  // tap in the scene, for each reading after the points
};
Sites sites_of(const Scene&, std::span<const Footprint> contacts);
Sites sites_of(const Scene&);  // for a scene with one lumped barrier at most

// own(r, f): displacement of a scheme's string at reading r under 1 N of force f.
using OwnResponse = std::function<double(int reading, int force)>;

// Missing compliance for several contacts. A string may yield more than the true one under some
// load patterns; grids and exact three-point recursions do so under smooth ones. Nothing can stand
// in series there: C is then the positive part of C_true - C_scheme, and `excess` is the size of
// the rest. Refuses if the rest is the larger part.
struct MissingMatrix {
    int contacts = 0;
    bool thread = false;
    // points x points, the contacts first and then the thread [m/N]
    std::vector<double> C;
    std::vector<double> pluck;  // on each point; empty without a pluck [m/N]
    // per tap in the scene, for each point and then the pluck; empty for nonlinear taps
    std::vector<std::vector<double>> taps;
    double excess = 0;  // [m/N]
    Ladder ladder;      // for a stepping scheme

    int points() const { return contacts + (thread ? 1 : 0); }

    double on_tap(std::size_t k, const double* force, double F_e) const {  // force: for each point
        if (taps[k].empty()) return 0;
        double sum = pluck.empty() ? 0 : taps[k][points()] * F_e;
        for (int p = 0; p < points(); ++p) sum += taps[k][p] * force[p];
        return sum;
    }
};
// `kept`: number of the string's modes that the scheme has. step: dt for a scheme that samples the
// series compliance, 0 for an exact one; none: no ladder. Refuses a string that is too soft
// already, since only a positive compliance can stand in series; `who` opens the sentence.
MissingMatrix missing_matrix(const std::string& who, const String&, const Sites&, std::size_t taps,
                             int kept, std::optional<double> step, const OwnResponse& own);

// True if compliance=matched is requested, for a scheme that then leaves out contact loss and a
// moving body: Refusal if the scene has one.
bool matched_without_loss(const Descriptor&, const Scene&, const Settings&);

// ---- Profiles. Nothing can stand in series at a scheme's nodes: a grid yields more than the true
// string there. So a profile is touched at separate points, in the middles of equally many equal
// parts.

constexpr int most_profile_points = 256;
inline constexpr Option profile_points_option{
    "points", "16", "points that stand for a profile that is not touched at nodes, up to 256"};

// Replaces its profiles; Refusal for an impossible number of points
String with_profile_points(String, const Settings&);
std::vector<Footprint> footprints_of(const String&);  // for lumped barriers and masses

}  // namespace jvari

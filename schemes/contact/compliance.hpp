// The compliance that a scheme takes from its string, and that stands in series with its contacts
// where it is put back.
//
// Under a steady force of 1 N at point q the string yields by C_true,pq at point p. A scheme's
// string yields by C_scheme,pq: it has cut the modes above some frequency (MacNeal 1971; Rubin
// 1975: residual flexibility), and its step or its grid stiffens or softens the rest. With C =
// C_true - C_scheme in series, Y_p = (what the scheme's string reads at p) + sum_q C_pq F_q, both
// yield alike under any steady load. The same for what is listened to: tap r = (what the scheme's
// string reads) + sum_q R_rq F_q. docs/compliance-matching.md tells the rest.
//
// C_true is in closed form for the stiff string under tension with simply supported ends: with l =
// sqrt(T/EI), x <= z,
//     G(x, z) = [x (L - z)/L - sinh(l x) sinh(l (L - z))/(l sinh(l L))]/T,
// averaged over cosine footprints (van Walstijn et al. 2016, eqs 5-6). Where modes are measured, it
// is the sum over all of them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// Of a scheme that can carry it.
inline constexpr Option compliance_option{
    "compliance",
    "own",
    "matched: what cut and step take from the string's compliance, in series with its contacts",
    {"own", "matched"}};

struct Footprint {        // where a force acts and a displacement is read
    double position = 0;  // centre [m]
    double width = 0;     // of the cosine [m]; 0: a point
};

// C_true [m/N]
double static_deflection(const String&, const Footprint& at, const Footprint& force);

// What the modes beyond the first `kept` resist at a point, if a damper alone stands beside the
// spring C_cut that they are under a steady force [kg/s]: with their admittance H(s) = sum of
// g_i^2/(m (s^2 + omega_i^2)), H(s) = C_cut/(1 + s R C_cut) at a third of the frequency of the last
// mode kept. Where no mode is left out, half the wave resistance of the string, sqrt(T mu). For
// schemes from outside.
double radiation_resistance(const String&, const Footprint&, int kept);

// What the points see of the modes beyond the first `kept`, as matrices over the points: their
// static yield C, the sum of g g'/(m omega^2); `folded`, the part of C whose modes lie above
// `nyquist` [rad/s]; and E, the inertia of the others, the sum of g g'/(m omega^4). Empty where no
// mode is left out.
struct CutModes {
    // those kept and, after them, as many of those cut as are summed
    Modes modes;
    std::vector<std::vector<double>> g;  // of each point
    std::vector<double> C, E, folded;    // [m/N], [m s^2/N], [m/N]
};
CutModes cut_modes(const String&, std::span<const Footprint> points, int kept, double nyquist);

// What stands beside the spring C, where D' is the velocity of the points: a damper, and masses
// behind dampers. Each mass belongs to a pattern V_k of the points.
//     F = C^-1 D + damper D' + sum of V_k resistance_k (V_k.D' - v_k),
//     mass_k v_k' = resistance_k (V_k.D' - v_k)
struct Ladder {
    std::vector<double> damper;  // points x points [kg/s]
    // as many patterns as points, x points; of unit length, their first not negative
    std::vector<double> V;
    std::vector<double> mass, resistance;  // of each pattern [kg], [kg/s]; 0: none
};

double static_nut_force(const String&, const Footprint& force);  // of 1 N [1]

struct Reading {
    Footprint at;
    bool nut_force = false;  // the force on the nut, in place of the displacement at `at`
};

// Where one string of a scene is pushed and read: forces are its contacts, thread and pluck in this
// order, as far as it has them; readings are those of contacts and thread, then the taps of
// displacement and nut force.
struct Sites {
    std::vector<Footprint> forces;
    int contacts = 0;
    bool thread = false, pluck = false;
    int points() const { return contacts + (thread ? 1 : 0); }
    std::vector<Reading> readings;
    std::vector<std::size_t> tap;  // of the scene, for each reading after the points
};
Sites sites_of(const Scene&, std::span<const Footprint> contacts);
Sites sites_of(const Scene&);  // with one lumped barrier at most

// own(r, f): what a scheme's string makes at reading r of 1 N of force f.
using OwnResponse = std::function<double(int reading, int force)>;

// Of several contacts. A string may yield more than the true one under some patterns of loads, as
// grids and exact three-point recursions do under smooth ones. Nothing can stand in series there: C
// is then the part of C_true - C_scheme that is positive, and `excess` says how much is left.
// Refuses where that is the larger part.
struct MissingMatrix {
    int contacts = 0;
    bool thread = false;
    // points x points, the contacts first and then the thread [m/N]
    std::vector<double> C;
    std::vector<double> pluck;  // on each point; empty without a pluck [m/N]
    // per tap of the scene, of each point and then the pluck; empty for what is no linear tap
    std::vector<std::vector<double>> taps;
    double excess = 0;  // [m/N]
    Ladder ladder;      // of a scheme that steps

    int points() const { return contacts + (thread ? 1 : 0); }

    double on_tap(std::size_t k, const double* force, double F_e) const {  // force: of each point
        if (taps[k].empty()) return 0;
        double sum = pluck.empty() ? 0 : taps[k][points()] * F_e;
        for (int p = 0; p < points(); ++p) sum += taps[k][p] * force[p];
        return sum;
    }
};
// `kept`: how many of the string's modes the scheme has. step: dt of one that samples what stands
// in series, 0 of one that is exact in it; none: no ladder.
// Refuses a string that is too soft already, since what is missing can stand in series only where
// it is more than nothing; `who` opens the sentence.
MissingMatrix missing_matrix(const std::string& who, const String&, const Sites&, std::size_t taps,
                             int kept, std::optional<double> step, const OwnResponse& own);

// Whether compliance=matched is asked for, of a scheme that leaves out contact loss and a moving
// body then: Refusal where the scene has one.
bool matched_without_loss(const Descriptor&, const Scene&, const Settings&);

// ---- Profiles. A scheme's nodes are no places for what stands in series: at them a grid yields
// more than the true string. So a profile is touched at points of its own, in the middles of as
// many equal parts.

constexpr int most_profile_points = 256;
inline constexpr Option profile_points_option{
    "points", "16", "points that stand for a profile that is not touched at nodes, up to 256"};

// its profiles replaced; Refusal of a number of points that cannot be
String with_profile_points(String, const Settings&);
std::vector<Footprint> footprints_of(const String&);  // of lumped barriers and masses

}  // namespace jvari

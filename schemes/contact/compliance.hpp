// The compliance that a scheme takes from its string, and that stands in series with its contacts where it is put back.
//
// Under a steady force of 1 N at point q the string yields by C_true,pq at point p. A scheme's string yields by C_scheme,pq: it has cut the
// modes above some frequency (MacNeal 1971; Rubin 1975: residual flexibility), and its step or its grid stiffens or softens the rest. With
// C = C_true - C_scheme in series, Y_p = (what the scheme's string reads at p) + sum_q C_pq F_q, both yield alike under any steady load.
// The same for what is listened to: tap r = (what the scheme's string reads) + sum_q R_rq F_q. docs/compliance-matching.md tells the rest.
//
// C_true is in closed form for the stiff string under tension with simply supported ends: with l = sqrt(T/EI), x <= z,
//     G(x, z) = [x (L - z)/L - sinh(l x) sinh(l (L - z))/(l sinh(l L))]/T,
// averaged over cosine footprints (van Walstijn et al. 2016, eqs 5-6). Where modes are measured, it is the sum over all of them.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari {

// Of a scheme that can carry it.
inline constexpr Option compliance_option{
    "compliance", "own", "matched: what cut and step take from the string's compliance, in series with its contacts", {"own", "matched"}};
inline constexpr Option compliance_options[] = {compliance_option};

struct Footprint {        // where a force acts and a displacement is read
    double position = 0;  // centre [m]
    double width = 0;     // of the cosine [m]; 0: a point
};

double static_deflection(const String&, const Footprint& at, const Footprint& force);  // C_true [m/N]
double static_nut_force(const String&, const Footprint& force);                        // of 1 N [1]

struct Reading {
    Footprint at;
    bool nut_force = false;  // the force on the nut, in place of the displacement at `at`
};

// Where one string of a scene, with at most one barrier, is pushed and read: forces are barrier, thread and pluck, as far as it has them;
// readings are those of barrier and thread, then the taps of displacement and nut force.
struct Sites {
    std::vector<Footprint> forces;
    std::vector<int> part;  // of each force: 0 barrier, 1 thread, 2 pluck
    int points = 0;         // barrier and thread
    std::vector<Reading> readings;
    std::vector<std::size_t> tap;  // of the scene, for each reading after the points
};
Sites sites_of(const Scene&, int string);

struct MissingCompliance {                          // [m/N]; 0 where a part is absent
    double bb = 0, bc = 0, cc = 0, be = 0, ce = 0;  // barrier, thread, pluck
    std::vector<std::array<double, 3>> taps;        // per tap of the scene, of 1 N at each; 0 for what is no linear tap of this string
};
// own(r, f): what the scheme's string makes at reading r of 1 N of force f. Refuses a string that is too soft already, since what is
// missing can stand in series only where it is more than nothing; `who` opens the sentence.
MissingCompliance missing_compliance(const std::string& who, const String&, const Sites&, std::size_t taps,
                                     const std::function<double(int reading, int force)>& own);

}  // namespace jvari

// What stands in series with the barrier and the thread of a string whose modes are cut (compliance=matched): the static deflection of the
// modes left out (schemes/contact/compliance.hpp). The references are exact in time, so nothing else is missing. With C that deflection,
//
//     Y_b - y_b = C_bb F_b + C_bc F_c + C_be F_e,      Y_c - y_c = C_bc F_b + C_cc F_c + C_ce F_e,
//
// Y where a part touches, y of the modes. Written with e = C_bc/C_cc and F_s = F_c + e F_b, the force of the spring between thread and
// string (series_points.hpp), a barrier's force pushes the modes at b and pulls them, e of it, at c; its law is the one with S in series.
// Leaves out: several barriers, profiles, contact loss.
#pragma once

#include <optional>

#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"
#include "schemes/contact/series_points.hpp"

namespace jvari {

struct InSeries {
    MissingCompliance C;
    SeriesPoints points;

    // Both of y and Y are what the modes read and where the thread is, from its height; the pluck's part of y is to be counted in.
    double pull() const { return points.barrier && points.thread ? points.e : 0; }                      // e
    bool relaxes() const { return points.thread && points.r_c > 0; }                                    // the thread has a state
    double share(bool thread) const { return thread ? C.cc : points.barrier ? C.bc : 0; }               // of F_s in y [m/N]
    double plucked(bool thread) const { return thread ? C.ce : C.be; }                                  // of F_e
    double lag(double y_c, double F_s) const { return relaxes() ? y_c + C.cc * F_s - points.h_c : 0; }  // Y_c - h_c
};

// What the forces of an instant add to a row of taps.
void add_series(const Block&, int row, const InSeries&, const SeriesPoints::Forces&, double F_e) noexcept;

// Nothing where option `compliance` says own; a Refusal where the scene is none that can carry it.
std::optional<InSeries> in_series(const Descriptor&, const Scene&, const Modes&, const Settings&);

}  // namespace jvari

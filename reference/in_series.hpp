// Missing compliance at the points of a string with cut modes (compliance=matched): each point
// yields by D more than the modes do,
//
//     Y_a = y_a + D_a + C_ae F_e,      F = C^-1 D + R (D' - v),      M v' = R (D' - v),
//
// a spring with a mass beside it that a damper holds: C the static deflection of the modes left
// out, M their inertia (schemes/contact/compliance.hpp). The references are exact in time, so
// nothing else is missing. Between contact events this is linear; in first-order form with the
// states z = (D, v),
//
//     z' = A z + B F,      z' Q z' is lost [W],      z' S z/2 is stored.
//
// docs/compliance-matching.md has the derivation. Leaves out: profiles.
#pragma once

#include <optional>
#include <vector>

#include "scenes/modes.hpp"
#include "schemes/contact/compliance.hpp"

namespace jvari {

struct InSeries {
    MissingMatrix C;
    int points = 0, states = 0;  // contacts and thread, in this order
    // [state][state] [1/s], [state][point] [1/(N s) times the state's unit]
    std::vector<double> A, B;
    std::vector<double> stiff;         // C^-1 [point][point] [N/m]
    std::vector<double> energy, loss;  // S and Q [state][state]

    double plucked(int point) const { return C.pluck.empty() ? 0 : C.pluck[point]; }  // C_ae [m/N]
    // z under steady forces at the points, or without forces [N]
    std::vector<double> resting(const std::vector<double>& force) const {
        std::vector<double> z(states, 0.0);
        for (std::size_t k = 0; k < force.size() * force.size(); ++k)
            z[k / points] += C.C[k] * force[k % points];
        return z;
    }
    double stored(const double* z) const {  // [J]
        double sum = 0;
        for (int i = 0; i < states; ++i)
            for (int j = 0; j < states; ++j) sum += 0.5 * z[i] * energy[i * states + j] * z[j];
        return sum;
    }
};

// Adds the springs' contribution in the state z to a row of taps.
void add_series(const Block&, int row, const InSeries&, const double* z, double F_e) noexcept;

double series_rate(const InSeries&);  // rate of the fastest own motion under given forces [1/s]

// Empty if option `compliance` is own; Refusal if the scene cannot carry the series compliance.
std::optional<InSeries> in_series(const Descriptor&, const Scene&, const Modes&, const Settings&);

}  // namespace jvari

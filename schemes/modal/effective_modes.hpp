// A few modes in place of the many above the cut, as barrier, thread and pluck see them: Rayleigh-Ritz of the modes left out on the Krylov
// space of their static response, L^-1 B, L^-2 B, ... with L their omega0^2 and B their weights at the points. The first block keeps the
// static compliance exactly, the next ones how it changes with frequency. (Craig & Hale 1988; docs/compliance-matching.md.)
#pragma once

#include <vector>

#include "scenes/modes.hpp"

namespace jvari {

// Modes of the string and effective ones after them, all of the same modal mass.
class ModeBasis {
public:
    ModeBasis(const String&, int kept, int effective);

    int kept() const { return kept_; }
    int count() const { return static_cast<int>(omega0.size()); }
    double mass = 0;                    // [kg]
    std::vector<double> omega0, sigma;  // [rad/s], [1/s]

    std::vector<double> footprint(double position, double width) const { return reduced(footprint_weights(all_, position, width)); }
    std::vector<double> displacement(double position) const { return reduced(displacement_weights(all_, position)); }
    std::vector<double> nut_force(const String& s) const { return reduced(nut_force_weights(all_, s)); }
    std::vector<double> initial(const String& s) const { return reduced(initial_displacement(all_, s)); }

private:
    std::vector<double> reduced(const std::vector<double>& weights) const;  // the kept ones, and those of the effective modes

    int kept_;
    Modes all_;
    std::vector<std::vector<double>> shape_;  // of each effective mode, over the modes left out
};

}  // namespace jvari

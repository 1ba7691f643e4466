// What a run has to say of itself beside its trace.
#pragma once

#include <string>

#include "schemes/run.hpp"

namespace jvari::bench::compare {

struct Summary {
    std::string scheme, scene;
    double rate;  // [Hz]; NaN for a continuous-time reference
    int modes;    // of the first string; interior nodes for a scheme on a grid
    int dofs;
    long steps, rows;
    double duration;                                    // simulated [s]: up to the last valid row
    double wall_seconds, ns_per_step, times_real_time;  // NaN where there is nothing to divide
    Status status;
    double energy_residual_per_step, energy_residual_accumulated;  // relative to the largest stored energy; NaN unless probed
    double smallest_contact_force;                                 // [N]; NaN where the scheme does not say
    double deepest_penetration;                                    // [m]
    std::vector<Fact> facts;                                       // the others
};

Summary summary_of(const Descriptor&, const Scene&, const Settings&, const Run&);

// The value of a fact, NaN where the scheme does not report it. Where each of several strings has its own: the least of smallest contact
// forces, of any other the largest.
double fact(const std::vector<Fact>&, const std::string& name);
inline double fact(const std::vector<Fact>& all, const FactName& known) {
    return fact(all, known.name);
}

}  // namespace jvari::bench::compare

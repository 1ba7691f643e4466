// An adaptive integrator for Equations that stops where a barrier's surface is crossed: SUNDIALS behind plain doubles.
//
// Multi-step (CVODE: BDF, Adams) and one-step methods (ARKODE: explicit and ESDIRK). A crossing is found by the library's own root finding
// on the penetrations, from outside where a barrier is not touched and from inside where it is. The library interpolates the state there
// with fifth degree at most, which is worse than a one-step method's own order: so the last step is made again to end at the crossing, and
// one Newton step puts the state onto the surface. A step whose ends' tangents meet beyond the surface is made again in two, so that no way
// there and back is stepped over. The error weights leave the equations' four sums out.
#pragma once

#include <cmath>
#include <memory>

#include "reference/equations.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

enum class Method { bdf, adams, erk, esdirk };
enum class LinearSolver { woodbury, dense };  // of the implicit methods

class Integrator {
public:
    struct Settings {
        Method method;
        double
            tolerance;  // relative, per step; absolute: this times `floor` times the root of equations.scale_squared()/size at the restart
        double floor;
        LinearSolver solver;
        int order;  // highest, of the multi-step methods
    };
    Integrator(Equations&, const Settings&);  // throws std::bad_alloc
    ~Integrator();

    double* state() noexcept;                                       // of size equations.size()
    double time() const noexcept;                                   // since the restart [s]
    void restart(double first_step, double longest_step) noexcept;  // from state() at time 0 [s]

    enum class Stop { reached, crossed, failed };
    Stop advance(double to, const Block& out) noexcept;  // fails where the caller wants no more of `out`; allocates nothing
    int crossed() const noexcept;                        // the contact

    struct Effort {  // and what the steps met
        double steps = 0, slopes = 0, solves = 0;
        double deepest = 0, smallest_force = HUGE_VAL, largest_force = 0;  // [m], [N]
    };
    Effort effort() const noexcept;
    void forget_effort() noexcept;

private:
    struct Library;
    std::unique_ptr<Library> library_;
};

}  // namespace jvari

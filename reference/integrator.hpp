// Adaptive integrator for Equations that stops when a barrier's surface is crossed: SUNDIALS behind
// plain doubles.
//
// Multi-step methods (CVODE: BDF, Adams). The library's own root finding on the penetrations finds
// a crossing: from outside for an untouched barrier, from inside for a touched one. One Newton step
// then puts the state onto the surface. A step whose end tangents meet beyond the surface is
// repeated in two halves, so that no way there and back is stepped over. The error weights leave
// out the equations' sums.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari {

// First-order equations with contacts: string_equations.hpp for one string,
// instrument_equations.hpp for all strings on a body that moves.
struct Equations {
    // number of components in p, and in v, in whole vectors; the padding stays zero
    int padded = 0;
    int contacts = 0;           // points 0 ... contacts - 1 are barriers
    std::vector<char> touched;  // [contact]: given, not decided here

    virtual ~Equations() = default;
    virtual int size() const = 0;  // p, v, sums: the sums are not weighed
    virtual void slope(double t, const double* z, double* dz) const noexcept = 0;
    // eta [m]
    virtual double penetration(int contact, const double* z) const noexcept = 0;
    // [m/s]
    virtual double penetration_speed(int contact, const double* z) const noexcept = 0;
    // [N], whether touched or not
    virtual double contact_force(int contact, const double* z) const noexcept = 0;
    // scale of p and v [m^2/s^2]
    virtual double scale_squared(const double* z) const noexcept = 0;
    // change of a component by rounding in the acting forces [m/s]
    virtual double rounding(const double*) const noexcept { return 0; }
    // (I - gamma J(z)) x = b
    virtual void solve(double t, double gamma, const double* z, const double* b,
                       double* x) noexcept = 0;
};

enum class Method { bdf, adams };

class Integrator {
public:
    struct Settings {
        Method method;
        // relative, per step; absolute: multiplied by a thousandth of
        // sqrt(equations.scale_squared()/size) at the restart, and not below equations.rounding()
        double tolerance;
    };
    Integrator(Equations&, const Settings&);  // throws std::bad_alloc
    ~Integrator();

    double* state() noexcept;                    // array with equations.size() entries
    double time() const noexcept;                // since the restart [s]
    void restart(double longest_step) noexcept;  // from state() at time 0 [s]

    enum class Stop { reached, crossed, failed };
    // fails if the caller has abandoned `out`; allocates nothing
    Stop advance(double to, const Block& out) noexcept;
    int crossed() const noexcept;  // the contact

    // effort, with its linear solves or without, and contact values met by the steps
    std::vector<Fact> facts(double events, bool solves) const;
    void reset() noexcept;  // restores the constructed state: zeros, no effort

private:
    struct Library;
    std::unique_ptr<Library> library_;
};

}  // namespace jvari

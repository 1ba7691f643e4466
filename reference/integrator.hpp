// An adaptive integrator for Equations that stops where a barrier's surface is crossed: SUNDIALS
// behind plain doubles.
//
// Multi-step methods (CVODE: BDF, Adams). A crossing is found by the library's own root finding on
// the penetrations, from outside where a barrier is not touched and from inside where it is, and
// one Newton step puts the state onto the surface. A step whose ends' tangents meet beyond the
// surface is made again in two, so that no way there and back is stepped over. The error weights
// leave the equations' sums out.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "schemes/scheme.hpp"

namespace jvari {

// First-order equations with contacts: string_equations.hpp of one string, instrument_equations.hpp
// of all strings on a body that moves.
struct Equations {
    // components of p, and of v, in whole vectors; what is beyond the last stays zero
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
    // of p and v [m^2/s^2]
    virtual double scale_squared(const double* z) const noexcept = 0;
    // what the rounding of the forces that act moves a component by [m/s]
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
        // relative, per step; absolute: of a thousandth of the root of
        // equations.scale_squared()/size at the restart, and not below equations.rounding()
        double tolerance;
    };
    Integrator(Equations&, const Settings&);  // throws std::bad_alloc
    ~Integrator();

    double* state() noexcept;                    // of size equations.size()
    double time() const noexcept;                // since the restart [s]
    void restart(double longest_step) noexcept;  // from state() at time 0 [s]

    enum class Stop { reached, crossed, failed };
    // fails where the caller wants no more of `out`; allocates nothing
    Stop advance(double to, const Block& out) noexcept;
    int crossed() const noexcept;  // the contact

    // what it took, with its linear solves or without, and what the steps met
    std::vector<Fact> facts(double events, bool solves) const;
    void reset() noexcept;  // as it was made: a state of zeros, no effort

private:
    struct Library;
    std::unique_ptr<Library> library_;
};

}  // namespace jvari

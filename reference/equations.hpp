// First-order equations with contacts, as integrator.hpp takes them: string_equations.hpp of one string, instrument_equations.hpp of all
// strings on a body that moves.
#pragma once

#include <vector>

namespace jvari {

struct Equations {
    int padded = 0;             // components of p, and of v, in whole vectors; what is beyond the last stays zero
    int contacts = 0;           // points 0 ... contacts - 1 are barriers
    std::vector<char> touched;  // [contact]: given, not decided here

    virtual ~Equations() = default;
    virtual int size() const = 0;  // p, v, sums: the sums are not weighed
    virtual void slope(double t, const double* z, double* dz) const noexcept = 0;
    virtual double penetration(int contact, const double* z) const noexcept = 0;        // eta [m]
    virtual double penetration_speed(int contact, const double* z) const noexcept = 0;  // [m/s]
    virtual double contact_force(int contact, const double* z) const noexcept = 0;      // [N], whether touched or not
    virtual double scale_squared(const double* z) const noexcept = 0;                   // of p and v [m^2/s^2]

    // For implicit methods.
    virtual void solve(double t, double gamma, const double* z, const double* b, double* x) noexcept = 0;  // (I - gamma J(z)) x = b
    virtual void jacobian(double t, const double* z, double* J) const noexcept = 0;                        // dense, column by column
};

}  // namespace jvari

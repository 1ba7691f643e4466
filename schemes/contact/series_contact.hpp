// A contact law with a compliance S [m/N] in series: what the string above sees of both is one potential,
//
//     Phi(zeta) = min over eta of  V(eta) + (zeta - eta)^2/(2 S),      zeta the approach of what is above [m], eta the penetration
//
// At the minimum zeta = eta + S V'(eta) and Phi' = V'(eta), so Phi is convex and never pulls, and Phi'' < 1/S however stiff V is.
// With exponent 1 it is the law k' = k/(1 + S k) of contact.hpp. Else the contact equation of contact.hpp is solved with eta as unknown:
//     zeta(eta+) - zeta - b + theta F = 0,   F = [Phi+ - Phi]/(zeta+ - zeta) = [dV + S mean(V') dV']/(d eta + S dV')
#pragma once

#include "schemes/contact/contact.hpp"

namespace jvari {

struct SeriesLaw {
    ContactLaw law;
    double S = 0;  // [m/N]

    double depth(double zeta) const;  // eta [m]; zeta itself where that is negative
    double potential(double zeta) const {
        const double eta = depth(zeta), F = law.force(eta);
        return law.potential(eta) + 0.5 * S * F * F;
    }
    double force(double zeta) const { return law.force(depth(zeta)); }
    double slope(double zeta) const {  // Phi''
        if (zeta <= 0) return 0;
        const double V = law.slope(depth(zeta));
        return V / (1 + S * V);
    }
};

inline ContactLaw linear_in_series(double k, double S) {  // exponent 1
    return {k / (1 + S * k), 1};
}

// r + b = theta F as in contact.hpp, with zeta in place of eta.
ContactSolution solve_series_contact(const SeriesLaw&, double zeta, double b, double theta);

}  // namespace jvari

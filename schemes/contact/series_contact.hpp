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
    double S = 0;     // [m/N]
    double both = 0;  // k' with exponent 1 [N/m]

    SeriesLaw() = default;
    SeriesLaw(const ContactLaw& l, double compliance) : law(l), S(compliance), both(l.alpha == 1 ? l.k / (1 + compliance * l.k) : 0) {}

    double depth(double zeta) const {  // eta [m]; zeta itself where that is negative
        return zeta <= 0 ? zeta : law.alpha == 1 ? both / law.k * zeta : power_depth(zeta);
    }
    double force(double zeta) const { return zeta <= 0 ? 0 : law.alpha == 1 ? both * zeta : law.force(power_depth(zeta)); }
    double potential(double zeta) const {
        if (zeta <= 0) return 0;
        if (law.alpha == 1) return 0.5 * both * zeta * zeta;
        const double eta = power_depth(zeta), F = law.force(eta);
        return law.potential(eta) + 0.5 * S * F * F;
    }
    double slope(double zeta) const {  // Phi''
        if (zeta <= 0) return 0;
        const double V = law.slope(depth(zeta));
        return V / (1 + S * V);
    }

private:
    double power_depth(double zeta) const;
};

inline ContactLaw linear_in_series(double k, double S) {  // exponent 1
    return {k / (1 + S * k), 1};
}

// r + b = theta F as in contact.hpp, with zeta in place of eta.
ContactSolution solve_series_contact(const SeriesLaw&, double zeta, double b, double theta);

}  // namespace jvari

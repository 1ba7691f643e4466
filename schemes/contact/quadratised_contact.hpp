// Contact by energy quadratisation: psi = sqrt(2V) is stepped as a state of its own, so that the
// force follows without iteration (Ducceschi, Bilbao, Willemsen & Serafin, "Linearly-implicit
// schemes for collisions in musical acoustics based on energy quadratisation", JASA 149, 2021).
// With g = dpsi/deta = sqrt(K (alpha+1)/2) [eta]^((alpha-1)/2) taken at eta^n, both forms are
//
//     psi+ = psi - gamma r,   F = c gamma (psi + psi+),   r = r0 + theta F
//
// two-point: gamma = g, c = 1/2, r = y^{n+1} - y^n;  three-point: gamma = g/2, c = 1, r = y^{n+1} -
// y^{n-1}, psi at half steps. F r = c (psi^2 - psi+^2) whatever gamma is: the energy with psi in it
// is balanced exactly, and nothing but g ties psi to sqrt(2V).
//
// raw       g as above, and psi wherever that leads: out of contact it stays behind and pulls (F <
//           0).
// released  where psi+ would turn negative, and wherever psi > 0 out of contact, gamma is the one
// that makes psi+ = 0:
//           c theta psi gamma^2 + r0 gamma - psi = 0.
//           F >= 0 always, and the whole stored energy goes back to the string.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "schemes/contact/contact.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

enum class Quadratisation { raw, released };

struct QuadratisedLaw {
    ContactLaw law;
    Quadratisation variant = Quadratisation::released;
    double c = 0.5;      // two-point 1/2, three-point 1
    double slope = 0;    // sqrt(K (alpha+1)/2)/(2 c): gamma = slope [eta]^((alpha-1)/2)
    double root_2V = 0;  // sqrt(2 K/(alpha+1)): psi = root_2V [eta]^((alpha+1)/2)

    static QuadratisedLaw make(const ContactLaw& law, Quadratisation variant, double c) {
        return {law, variant, c, std::sqrt(0.5 * law.k * (law.alpha + 1)) / (2 * c),
                std::sqrt(2 * law.k / (law.alpha + 1))};
    }
    double psi(double eta) const {  // sqrt(2 V(eta))
        if (eta <= 0) return 0;
        return law.alpha == 1 ? root_2V * eta : root_2V * power(eta, 0.5 * (law.alpha + 1));
    }
    double gamma(double eta) const {  // eta > 0
        return law.alpha == 1 ? slope : slope * power(eta, 0.5 * (law.alpha - 1));
    }
};

struct QuadratisedStep {
    double force;  // [N]
    double psi;    // psi+ [sqrt(J)]
};

inline QuadratisedStep release(double c, double psi, double r0, double theta) {
    const double root = std::sqrt(r0 * r0 + 4 * c * theta * psi * psi);
    // F = c gamma psi
    return {r0 > 0 ? 2 * c * psi * psi / (r0 + root) : 0.5 * (root - r0) / theta, 0.0};
}

inline QuadratisedStep solve_quadratised(const QuadratisedLaw& q, double eta, double psi, double r0,
                                         double theta) {
    if (eta <= 0) {
        if (q.variant == Quadratisation::released && psi != 0) return release(q.c, psi, r0, theta);
        return {0.0, psi};
    }
    const double gamma = q.gamma(eta);
    const double force = q.c * gamma * (2 * psi - gamma * r0) / (1 + q.c * gamma * gamma * theta);
    const double next = psi - gamma * (r0 + theta * force);
    if (q.variant == Quadratisation::released && (next < 0 || force < 0))
        return psi > 0 ? release(q.c, psi, r0, theta) : QuadratisedStep{0.0, 0.0};
    return {force, next};
}

// How far psi went from sqrt(2V) in a run.
struct QuadratisedFacts {
    double gap = 0, stuck = 0, largest = 0, energy_gap = 0;

    void note(double psi, double true_psi) {
        gap = std::max(gap, std::abs(psi - true_psi));
        if (true_psi == 0) stuck = std::max(stuck, std::abs(psi));
        largest = std::max(largest, true_psi);
        energy_gap = std::max(energy_gap, 0.5 * std::abs(psi * psi - true_psi * true_psi));
    }
    std::vector<Fact> list() const {
        const double scale = largest > 0 ? largest : 1;
        return {{facts::psi_gap, gap / scale},
                {facts::psi_out_of_contact, stuck / scale},
                {facts::energy_gap, energy_gap}};
    }
};

}  // namespace jvari

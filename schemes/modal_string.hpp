// One string, at most one lumped barrier and one thread, as arrays over the modes: what the modal three-point and quadratised schemes start
// from (van Walstijn et al. 2016, eqs 16-22). Arrays are padded with zero modes to whole vectors; an absent part has empty arrays.
#pragma once

#include <vector>

#include "schemes/contact.hpp"
#include "schemes/modal_pass.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

constexpr double modal_overflow = 1e140;  // [m] not finite, or so far off that the energy columns no longer are
using ModalArray = std::vector<double>;

struct ModalTap {
    Quantity quantity;
    ModalArray weights;  // empty for forces of contact
};

struct ModalString {
    int count = 0, size = 0;  // modes, and modes with padding
    int steps_per_row = 1;
    double dt = 0;                            // [s]
    double mass = 0;                          // modal mass [kg]
    ModalArray num, den, loss, omega, sigma;  // of modal_coefficients.hpp; omega < 0 where overdamped: then it holds -|omega| [rad/s]
    ModalArray y0;                            // [m]
    ModalArray g_b, g_c, g_e;                 // bridge, thread, pluck
    ContactLaw barrier;
    double h_b = 0;                    // [m]
    double true_compliance = 0;        // of these modes under a steady force at the bridge [m/N]
    double k_c = 0, r_c = 0, h_c = 0;  // thread [N/m], [kg/s], [m]
    long pluck_first = 0;              // step of the first sample of `pluck`
    std::vector<double> pluck;         // F_e at t = n dt [N]; 0 outside
    std::vector<ModalTap> taps;

    double pluck_at(long n) const {
        const long k = n - pluck_first;
        return k < 0 || k >= static_cast<long>(pluck.size()) ? 0 : pluck[k];
    }
};

// Refuses what the descriptor does not represent and modes above half the sample rate, where they would alias.
ModalString modal_string(const Descriptor&, const Scene&, const Settings&);

double modal_dot(const ModalArray&, const ModalArray&);

}  // namespace jvari

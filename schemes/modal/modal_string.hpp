// One string, at most one lumped barrier and one thread, as arrays over the modes: what the modal three-point and quadratised schemes start
// from (van Walstijn et al. 2016, eqs 16-22). Arrays are padded with zero modes to whole vectors; an absent part has empty arrays.
#pragma once

#include <vector>

#include "scenes/modes.hpp"
#include "schemes/aligned.hpp"
#include "schemes/contact/contact.hpp"
#include "schemes/modal/kernels/modal_pass.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

constexpr double modal_overflow = 1e140;  // [m] not finite, or so far off that the energy columns no longer are
using ModalArray = std::vector<double, LineAllocator<double>>;

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

// What a scheme of one string in its modes represents.
constexpr Features modal_features = Features(Feature::bending_stiffness) | Feature::damping | Feature::frequency_dependent_damping |
                                    Feature::measured_modes | Feature::lumped_barrier | Feature::power_law_contact | Feature::thread |
                                    Feature::initial_shape | Feature::pluck;

// The steps of dt that a pluck acts in. Refusal where it lasts longer than its table can.
struct PluckSteps {
    long first, count;
};
PluckSteps pluck_steps(const Pluck&, double dt);

bool touches_once_without_loss(const String&);  // one lumped barrier at most: what the kernels of one contact take

// Modes above half the sample rate would alias.
void refuse_above_nyquist(const Descriptor&, const Modes&, double sample_rate);

// Refuses modes above half the sample rate.
ModalString modal_string(const Descriptor&, const Scene&, const Settings&);

// d^0 = q^0 - q^{-1} of the free motion that passes y0 at rest, for three-point recursions.
ModalArray rest_increments(const ModalString&);
std::vector<FreeMode> three_point_modes(const ModalString&);  // as those recursions have them

// sin(omega t)/omega, omega as it stands in ModalString: sinh where overdamped, t at 0 [s].
double sine_over(double omega, double t);
ModalArray impulse_gain(const ModalString&);  // dt R sin(omega dt)/(m omega) of each mode [m/N]

double modal_dot(const ModalArray&, const ModalArray&);
double modal_dot_by_eights(const ModalArray&, const ModalArray&);  // eight partial sums: of padded arrays, and faster

// A row of taps: y the modal displacements, velocity(weights) what weights read of their velocities, the means of the contact forces.
template <class Velocity>
void write_taps(const Block& out, int row, const std::vector<ModalTap>& taps, const ModalArray& y, Velocity velocity, double bridge,
                double thread) noexcept {
    for (int k = 0; k < out.taps; ++k) {
        double& cell = out.tap[k * out.stride + row];
        switch (taps[k].quantity) {
            case Quantity::displacement:
            case Quantity::nut_force: cell = pass_dot(taps[k].weights.data(), y.data(), static_cast<int>(y.size())); break;
            case Quantity::velocity: cell = velocity(taps[k].weights); break;
            case Quantity::bridge_force: cell = bridge; break;
            case Quantity::thread_force: cell = thread; break;
            case Quantity::driving_force: cell = -(bridge + thread); break;
        }
    }
}

}  // namespace jvari

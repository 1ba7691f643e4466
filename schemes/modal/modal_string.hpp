// Shared code for schemes with a string in its modes. Arrays over the modes are padded with zero
// modes to whole vectors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "scenes/modes.hpp"
#include "schemes/aligned.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

// [m] a larger value is not finite, or so large that the energy columns overflow
constexpr double modal_overflow = 1e140;
constexpr int modal_padding = 16;  // whole vectors on any machine, in pairs

// Features represented by a scheme for one string in its modes.
constexpr Features modal_features = Feature::bending_stiffness | Feature::damping |
                                    Feature::frequency_dependent_damping | Feature::measured_modes |
                                    Feature::lumped_barrier | Feature::power_law_contact |
                                    Feature::thread | Feature::initial_shape | Feature::pluck |
                                    Feature::initial_velocity | Feature::equilibrium;
constexpr Features modal_features_of_points =
    modal_features | Feature::profile_barrier | Feature::several_barriers | Feature::contact_loss;
inline constexpr Approximation modal_approximates[] = {
    {Feature::profile_barrier, facts::contact_points},
    {Feature::rigid_profile, facts::contact_points}};
inline constexpr std::span<const Approximation> modal_approximates_elastic =
    std::span(modal_approximates).first(1);

// Steps of dt in which a pluck acts, and the number that begin before the scene ends, which are
// tabulated. Refusal if they cannot be counted.
struct PluckSteps {
    long first, count, tabulated;
};
PluckSteps pluck_steps(const Pluck&, double dt, double duration);
// Number of whole rows, at most `rows`, in whose steps a pluck does not act; k: the next step,
// counted from the pluck's first.
inline long rows_without_pluck(long rows, long k, long pluck_steps, long steps_per_row) {
    const bool comes = pluck_steps > 0 && k < pluck_steps;
    return comes ? std::min(rows, std::max(-k, 0L) / steps_per_row) : rows;
}

// Weights with which a displacement, velocity or nut-force tap reads the modes' displacements or
// velocities; empty for contact forces.
std::vector<double> tap_weights(const Tap&, const Modes&, const String&);

// Modes above half the sample rate would alias.
void refuse_above_nyquist(const Descriptor&, const Modes&, double sample_rate);

// Adds F w to a column in a stream, whose lines with `line` modes lie `stride` doubles apart;
// w: padded.
template <int line>
inline void add_to_column(double* column, std::ptrdiff_t stride, const AlignedVector& w, double F) {
    for (std::size_t i = 0; i < w.size(); i += line, column += stride)
        for (int k = 0; k < line; ++k) column[k] += w[i + k] * F;
}

// sum w x for padded arrays (kernels/modal_two_point_kernel.cpp)
double modal_dot(const AlignedVector& w, const AlignedVector& x);
// the same for unpadded arrays, in order
inline double modal_dot(const std::vector<double>& w, const std::vector<double>& x) {
    return std::inner_product(w.begin(), w.end(), x.begin(), 0.0);
}

}  // namespace jvari

#include "schemes/modal/modal_string.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/wording.hpp"
#include "schemes/making.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

using std::numbers::pi;

void refuse_above_nyquist(const Descriptor& d, const Modes& modes, double sample_rate) {
    for (int i = 0; i < modes.count(); ++i) {
        const double square = omega_squared_damped(modes.omega0[i], modes.sigma[i]);
        const double kHz = std::round(std::sqrt(square) / (2 * pi)) / 1000;
        if (square >= pi * pi * sample_rate * sample_rate)
            throw Refusal(std::string(d.name) + ": mode " + std::to_string(i + 1) + " at " +
                          number_text(kHz) + " kHz is not below half the sample rate of " +
                          number_text(sample_rate / 1000) + " kHz, where it would alias; " +
                          (i > 0 ? "at most " + std::to_string(i) + " modes fit" : "none fits") +
                          " at this rate");
    }
}

std::vector<double> tap_weights(const Tap& tap, const Modes& modes, const String& s) {
    switch (tap.quantity) {
        case Quantity::displacement:
        case Quantity::velocity:
            return weights_below(tap.below, displacement_weights(modes, tap.position), modes);
        case Quantity::nut_force:
            return weights_below(tap.below, nut_force_weights(modes, s), modes);
        default: return {};
    }
}

PluckSteps pluck_steps(const Pluck& pluck, double dt, double duration) {
    constexpr double most = 0.5 * static_cast<double>(std::numeric_limits<long>::max());
    const double first = std::floor(pluck.start / dt), end = pluck.start + pluck.duration,
                 last = std::ceil(end / dt);
    if (!(last < most))
        throw Refusal("the pluck ends at " + number_text(end) +
                      " s, after more steps than can be " + "counted at " + number_text(1 / dt) +
                      " Hz");
    const double kept = std::clamp(std::ceil(duration / dt) - first, 0.0, last - first);
    return {static_cast<long>(first), static_cast<long>(last - first), static_cast<long>(kept)};
}

}  // namespace jvari

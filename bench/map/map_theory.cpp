#include "bench/map/map_theory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenes/modes.hpp"
#include "schemes/making.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::map {

namespace {
constexpr const char* nyquist = "nyquist";

double nyquist_margin(const Scene& scene, const Settings& settings) {
    double fastest = 0;  // mode of all strings: omega^2 [rad^2/s^2]
    for (const String& s : scene.strings) {
        const Modes modes = modes_of(s, modes_for(s, settings));
        fastest = std::max(fastest, omega_squared_damped(modes.omega0.back(), modes.sigma.back()));
    }
    return 0.5 * settings.sample_rate * 2 * std::numbers::pi / std::sqrt(fastest) - 1;
}
}  // namespace

std::vector<std::string> theories() {
    std::vector<std::string> names{nyquist};
    for (const Descriptor& d : schemes())
        if (d.limit.name && std::find(names.begin(), names.end(), d.limit.name) == names.end()) names.emplace_back(d.limit.name);
    return names;
}

bool is_theory(const std::string& name) {
    const auto known = theories();
    return std::find(known.begin(), known.end(), name) != known.end();
}

std::string motion_of(const std::string& theory) {
    if (theory == "grid_limit") return "any motion: it is of the grid alone";
    if (theory == "penalty_limit")
        return "lasting contact; where the string parts from the barrier, failures were seen to begin 16 to 71 % off";
    if (theory == "equal_shares") return "motion without losses that starts in one mode and has had time to spread over all";
    return "any motion: it is of the highest mode alone";
}

double theory_margin(const std::string& name, const Descriptor& d, const Scene& scene, const Settings& settings) {
    if (name == nyquist) return nyquist_margin(scene, settings);
    return d.limit.name && name == d.limit.name ? margin_of(d, scene, settings) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jvari::bench::map

// Sources: van Walstijn et al. 2016 eq 18; Issanchou et al. 2016 eq 12; Deshmukh &
// Rayavarapu (decay factor per period).
#include "scenes/damping.hpp"

#include <cmath>
#include <numbers>

namespace jvari {

using std::numbers::pi;

double decay_rate(const PolynomialDamping& law, double beta) {
    return law.sigma0 + (law.sigma1 + law.sigma3 * beta * beta) * beta;
}

double decay_rate(const QualityFactorDamping& law, const String& s, double nu) {
    const double R =
        2 * pi * law.air_viscosity +
        2 * pi * law.diameter * std::sqrt(pi * law.air_viscosity * law.air_density * nu);
    const double air = R / (2 * pi * s.linear_density * nu);
    const double viscoelastic = 4 * pi * pi * s.linear_density * s.bending_stiffness *
                                law.viscoelastic_angle * nu * nu / (s.tension * s.tension);
    return pi * nu * (air + viscoelastic + law.thermoelastic_loss);  // sigma = pi nu/Q  (12)
}

double decay_rate(const PerPeriodDamping& law, double f1) { return -f1 * std::log(law.factor); }

}  // namespace jvari

// Loss laws of the free string. sigma is the modal decay rate [1/s]: amplitude ~ exp(-sigma t).
#pragma once

#include "scenes/scene.hpp"

namespace jvari {

// sigma0 + sigma1 beta + sigma3 beta^3, beta [1/m]   (van Walstijn et al. 2016, eq 18)
double decay_rate(const PolynomialDamping&, double beta);

// pi nu/Q(nu), 1/Q = 1/Q_air + 1/Q_ve + 1/Q_te, nu the undamped frequency [Hz]   (Issanchou et al.
// 2016, eq 12)
double decay_rate(const QualityFactorDamping&, const String&, double nu);

// -f1 ln(factor), f1 the frequency of the first mode [Hz]   (Deshmukh & Rayavarapu: a factor per
// period)
double decay_rate(const PerPeriodDamping&, double f1);

}  // namespace jvari

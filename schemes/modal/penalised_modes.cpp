#include "schemes/modal/penalised_modes.hpp"

#include <limits>

#include "schemes/making.hpp"

namespace jvari {

PenalisedModes::Sides PenalisedModes::sides(double k_b) const {
    const int n = points().count();
    std::vector<double> G;
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            G.push_back(0);
            for (int j = 0; j < p_.modes.count(); ++j)
                G.back() += p_.update.gain_of(j) * p_.update.ports[a].weights[j] * p_.update.ports[b].weights[j] /
                            (2 * (2 - p_.three_point.loss[j]) - p_.three_point.kappa[j]);
        }
    const Residual yields = points().series ? Residual(by_backward_differences(*points().series, points().dt), 0.5 * points().dt)
                                            : Residual();  // whose K is 2 C (1 + 4 R C/dt)^-1
    const auto C = [&yields, n](int a, int b) { return yields.K.empty() ? 0 : 0.5 * yields.K[a * n + b]; };
    Sides of{1 / k_b + C(0, 0), G[0]};
    if (!points().threads.empty()) {
        const Thread& thread = points().threads.front();
        const double k = thread.stiffness, kappa = k + (points().series ? 4 * thread.damping / points().dt : 0);
        const double all = 1 + k * G[3] + kappa * C(1, 1);
        of.contact -= (kappa * C(0, 1) + (k - kappa) * G[1]) * C(0, 1) / all;
        of.string -= k * G[1] * G[1] / all;
    }
    return of;
}

double PenalisedModes::margin() const {
    if (points().contacts.count() != 1) return std::numeric_limits<double>::quiet_NaN();
    const Sides of = sides(stiffest());
    return of.contact / of.string - 1;
}

double PenalisedModes::stiffest() const {
    const ContactLaw& law = points().contacts.laws[0];
    if (law.alpha == 1) return law.k;
    if (points().pluck) return std::numeric_limits<double>::quiet_NaN();
    double E = 0;
    for (int j = 0; j < p_.modes.count(); ++j) {
        const double w = p_.modes.omega0[j] * p_.initial[j];
        E += 0.5 * p_.modes.mass * w * w;
    }
    return law.slope(std::pow((law.alpha + 1) * E / law.k, 1 / (law.alpha + 1)));
}

std::vector<Fact> PenalisedModes::facts() const {
    std::vector<Fact> f = ThreePointModes::facts();
    if (points().contacts.count() == 1) f.push_back({facts::stable_stiffness_limit, 1 / sides(points().contacts.laws[0].k).string});
    return f;
}

std::unique_ptr<Scheme> penalised(const Descriptor& descriptor, const Scene& scene, const Settings& settings, const ModalGain& gain) {
    return driven<ExplicitRule>(std::make_unique<PenalisedModes>(problem_of_modes(descriptor, scene, settings, gain)), descriptor,
                                settings);
}

double penalty_margin(const Descriptor& descriptor, const Scene& scene, const Settings& settings, const ModalGain& gain) try {
    return PenalisedModes(problem_of_modes(descriptor, scene, settings, gain)).margin();
} catch (const Refusal&) {
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jvari

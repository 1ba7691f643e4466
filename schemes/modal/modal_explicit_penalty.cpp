// Control: the contact force at the instant, F_b^n = V'(eta^n) (contact/explicit_rule.hpp), on the
// string in three_point_modes.hpp. Only the contact is the control: the string is exact and the
// thread implicit. No energy balance is promised. The stored energy is the true one, so that the
// columns show the scheme's gains and losses.
//
// Its limit is the stiffness at which, for one lasting contact with exponent 1, the highest root
// passes z = -1. There y^{n+1} = -y^n. With G = sum g_p e_q/den (three_point_modes.hpp), den = 1 +
// C + C~, contact b and thread c, which takes the mean of the outer levels, the scheme is stable if
//
//     1/k_b > G_bb - k_c G_bc^2/(1 + k_c G_cc)
//
// The condition is necessary and not sufficient: impacts gain energy below the limit too (C3
// released without losses: still at a limit of 1.4 k, no longer at 11 k). For another exponent the
// contact's stiffness is V'' at the deepest penetration. The penetration never exceeds the depth at
// which V holds the string's whole initial energy, so that stiffness bounds the critical step from
// below (Feng 2026, arXiv 2604.02533, for one mass). In lasting contact the scheme is stable on
// this side of the line, and may be stable beyond it. There is no statement about a pluck, whose
// work is not known in advance.
//
// Leaves out: a stability limit for several contacts, rigid barriers, compliance=matched,
// polarisation, a body that moves.
#include <cmath>

#include "schemes/contact/explicit_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/three_point_modes.hpp"
#include "schemes/trace.hpp"

namespace jvari {

extern const Descriptor modal_explicit_penalty;

namespace {

constexpr Option options[] = {profile_points_option};

class PenalisedModes : public ThreePointModes {
public:
    using ThreePointModes::ThreePointModes;
    // The contact's yield over the least stable yield, minus 1; NaN unless there is one contact
    double margin() const {
        return points().contacts.count() == 1 ? 1 / stiffest() / least_yield() - 1 : nan;
    }
    std::vector<Fact> facts() const {
        std::vector<Fact> f = ThreePointModes::facts();
        if (points().contacts.count() == 1)
            f.push_back({facts::stable_stiffness_limit, 1 / least_yield()});
        return f;
    }

private:
    double least_yield() const {  // the limit's right side [m/N]
        const auto G = [this](int a, int b) {
            double sum = 0;
            for (int j = 0; j < p_.modes.count(); ++j)
                sum += p_.update.gain_of(j) * p_.update.ports[a].weights[j] *
                       p_.update.ports[b].weights[j] /
                       (2 * (2 - p_.three_point.loss[j]) - p_.three_point.kappa[j]);
            return sum;
        };
        if (points().threads.empty()) return G(0, 0);
        const double k = points().threads.front().stiffness, G_bc = G(0, 1);
        return G(0, 0) - k * G_bc * G_bc / (1 + k * G(1, 1));
    }
    // Greatest stiffness of the contact in this run [N/m]; NaN if unknown
    double stiffest() const {
        const ContactLaw& law = points().contacts.laws[0];
        if (law.alpha == 1) return law.k;
        if (points().pluck) return nan;
        double E = 0;
        for (int j = 0; j < p_.modes.count(); ++j) {
            const double w = p_.modes.omega0[j] * p_.start.displacement[j],
                         v = p_.start.velocity[j];
            E += 0.5 * p_.modes.mass * (w * w + v * v);
        }
        return law.slope(std::pow((law.alpha + 1) * E / law.k, 1 / (law.alpha + 1)));
    }
};

std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    return driven(std::make_unique<PenalisedModes>(problem_of_modes(descriptor, scene, settings)),
                  descriptor, settings, rule_of<ExplicitRule>(settings));
}

double margin_of(const Scene& scene, const Settings& settings) try {
    return PenalisedModes(problem_of_modes(modal_explicit_penalty, scene, settings)).margin();
} catch (const Refusal&) { return nan; }
}  // namespace

extern const Descriptor modal_explicit_penalty = {
    .name = "modal_explicit_penalty",
    .source = "exact modes, contact force of the last step (conditionally stable control)",
    .represents = modal_features_of_points,
    .balance = Balance::none,
    .make = make,
    .options = options,
    .approximates = modal_approximates_elastic,
    .limit = {"penalty_limit", margin_of}};

}  // namespace jvari

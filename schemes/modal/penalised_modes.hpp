// A string by three-point steps whose contact force is known before the step (contact/explicit_rule.hpp), and the limit that is known of
// it: the stiffness of one lasting contact of exponent 1 at which the highest root passes z = -1. There y^{n+1} = -y^n and D' = 4 D/dt.
// With G = sum g_p e_q/den (three_point_modes.hpp), den = 1 + C + C~, and with C (1 + 4 R C/dt)^-1 for C, what yields in series, contact b
// and thread c, which takes the mean of the outer levels of y, F_c = k y_c - kappa D_c, kappa = k_c + 4 r_c/dt, stand where
//
//     1/k_b + C_bb - [kappa C_bc^2 + (k - kappa) G_bc C_bc]/N > G_bb - k G_bc^2/N,      N = 1 + k G_cc + kappa C_cc
//
// It is the limit of lasting contact, necessary and not sufficient: impacts gain energy below it too (C3 released without losses: still
// where the limit is 1.4 k, no longer where it is 11 k).
// Of another exponent the contact is as stiff as V'' where it is deepest. That is nowhere deeper than where V holds all that the string had
// at its start, so that stiffness bounds the critical step from below (Feng 2026, arXiv 2604.02533, of one mass): in lasting contact the
// scheme is stable on this side of the line, and may be so beyond it. Of a pluck, whose work is not known before, nothing is said.
#pragma once

#include "schemes/contact/explicit_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/modal/three_point_modes.hpp"

namespace jvari {

class PenalisedModes : public ThreePointModes {
public:
    using ThreePointModes::ThreePointModes;
    double margin() const;  // the sides of the limit, the left over the right, less 1; NaN unless there is one contact
    std::vector<Fact> facts() const;

private:
    struct Sides {
        double contact, string;  // [m/N]
    };
    Sides sides(double k_b) const;  // of a contact of that stiffness
    double stiffest() const;        // that the contact can be in this run [N/m]; NaN where that is not known
};

std::unique_ptr<Scheme> penalised(const Descriptor&, const Scene&, const Settings&, const ModalGain&);
double penalty_margin(const Descriptor&, const Scene&, const Settings&, const ModalGain&);  // NaN where there is no such scheme

}  // namespace jvari

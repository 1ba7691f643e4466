// One contact over a step in which its force is a line, F = phi_0 + phi_1 P_1(s), s = (t - t_n)/H,
// P_1 = 2s - 1 (docs/two-moments.md, which numbers the equations).
//
//     symbol    meaning                                                            unit
//     r_0, r_1  moments of the point's velocity, int Y' dt and int Y' P_1 dt       m
//     b, T      of the free motion, and compliances: r = b + T phi                 m, m/N
//     eta       penetration, at the step's beginning eta_0                         m
//     E_1, E_0  eta_0 - b_0 and eta_0 + b_1: the ends of the line without forces   m
//     e_0, e_1  ends of the line that the contact sees: eta_0 + r_1, eta_0 - r_0   m
//     V, DV     potential; discrete gradient [V(e_1) - V(e_0)]/(e_1 - e_0)         J, N
//     c         1/k; a rigid barrier has 1e-10 T_00                                m/N
//     rho       3 T_11/T_00: 1 of a point that only radiates, 0 of a free mass     1
//
// Rule D (rho >= 0.2, rigid barriers, several contacts):
//     phi_0 = DV, phi_1 = DV - V'(e_0), eta -> e_1                                    (6)
//     lost = V(eta_0) - V(e_0) - V'(e_0) (eta_0 - e_0) >= 0                           (7)
// Rule G (rho < 0.2, a contact alone): moments of V' over the parabola
//     eta_0 - r_0 s - 3 r_1 (s^2 - s)                                                (10)
//
// Contact loss V'(eta) (1 + beta eta'): rule G integrates it directly. In rule D the loss is a line
// lambda >= 0 of dampers with the moments l_0, l_1 (11); the step uses the lossless rule with the
// compliances (1 + T L/H)^-1 T.
#pragma once

#include "schemes/contact/contact.hpp"

namespace jvari {

struct MomentMatrix {  // rows r_0, r_1; columns phi_0, phi_1
    double m00 = 0, m01 = 0, m10 = 0, m11 = 0;
};
inline MomentMatrix times(const MomentMatrix& a, const MomentMatrix& b) {
    return {a.m00 * b.m00 + a.m01 * b.m10, a.m00 * b.m01 + a.m01 * b.m11,
            a.m10 * b.m00 + a.m11 * b.m10, a.m10 * b.m01 + a.m11 * b.m11};
}

struct MomentContact {            // over a step
    double phi_0 = 0, phi_1 = 0;  // force on the string [N]
    double from = 0, to = 0;      // e_0 and e_1; by rule G eta_0 and e_1 [m]
    double lost = 0;              // by rule G, or with contact loss [J]
    bool touches = false;         // at the end of the step
    bool by_parabola = false;     // by rule G
    bool lost_by_ends = false;    // by rule D without contact loss: lost() computes (7)
    MomentMatrix slope;           // d phi/d r, if requested [N/m]
    int iterations = 0;           // 0: closed form
    bool converged = true;
    double residual = 0;  // relative, in the last iteration
};

class MomentRule {
public:
    MomentRule() = default;
    // T: for the contact alone, the thread eliminated [m/N]; span: H [s]; alone: rule G may take
    // the contact
    MomentRule(const ContactLaw&, double beta, LossLaw, const MomentMatrix& T, double span,
               bool alone = true);

    bool conserves() const { return galerkin_; }  // rule G
    // closed form, by rule D without loss, exponent 1
    bool is_linear() const { return linear_; }
    double c() const { return c_; }
    const ContactLaw& law() const { return law_; }  // a rigid barrier's is a stiff spring

    // stays out, without forces
    bool stays_out(double eta, double b_0, double b_1) const;
    // One step from eta. T: the compliances, own or with others eliminated.
    void solve(const MomentMatrix& T, double eta, double b_0, double b_1,
               MomentContact&) const noexcept;
    // d phi/d b = slope (1 - T slope)^-1 for a step solved with these T
    MomentMatrix answer(const MomentMatrix& T, const MomentContact&) const noexcept;

    // (7), for exponent 1 without cancellation [J]
    double lost(double eta, double from) const {
        if (law_.alpha != 1)
            return law_.potential(eta) - law_.potential(from) - law_.force(from) * (eta - from);
        if (from <= 0) return law_.potential(eta);
        return eta > 0 ? 0.5 * law_.k * (eta - from) * (eta - from)
                       : 0.5 * law_.k * from * (from - 2 * eta);
    }
    double lost(double eta, const MomentContact& s) const {  // in a step from eta [J]
        return s.lost_by_ends ? lost(eta, s.from) : s.lost;
    }

private:
    struct Powers {  // powers of a penetration, and its square root if 2 alpha is odd
        double V, force, slope, root;
    };
    struct Quotient {  // DV and its derivatives by both ends
        double value, by_from, by_to;
    };
    Powers powers(double eta) const noexcept;
    double quotient_by_sums(double from, double to, const Powers& a,
                            const Powers& b) const noexcept;
    Quotient quotient(double from, double to, const Powers& a, const Powers& b) const noexcept;

    bool by_lines(const MomentMatrix& T, double E_0, double E_1, MomentContact&) const noexcept;
    void by_newton(const MomentMatrix& T, double guess, double E_0, double E_1,
                   MomentContact&) const noexcept;
    struct Ends {
        double from, to;
    };
    Ends first_guess(const MomentMatrix& T, double eta, double E_0, double E_1) const noexcept;
    bool by_polynomials(const MomentMatrix& T, const Ends& guess, double E_0, double E_1,
                        MomentContact&) const noexcept;
    void end_from_energy(double p, double x, MomentContact&) const noexcept;
    void by_bracket(const MomentMatrix& T, double E_0, double E_1, MomentContact&) const noexcept;
    void without_loss(const MomentMatrix& T, double eta, double E_0, double E_1,
                      MomentContact&) const noexcept;
    void with_loss(const MomentMatrix& T, double eta, double b_0, double b_1,
                   MomentContact&) const noexcept;
    void damped(const MomentMatrix& T, double eta, double b_0, double b_1, double l_0, double l_1,
                MomentContact&) const noexcept;
    void shrink(const MomentMatrix& T, double eta, double b_0, double b_1, double l_0, double l_1,
                MomentContact&) const noexcept;

    struct Integrals {  // integrals of the force over the parabola, and their derivatives by r
        double phi_0 = 0, phi_1 = 0, lost = 0;
        MomentMatrix slope;
    };
    Integrals integrals(double eta, double r_0, double r_1) const noexcept;
    bool guess_in_full(const MomentMatrix& T, double eta, double b_0, double b_1,
                       MomentContact&) const noexcept;
    bool galerkin_from(const MomentMatrix& T, double eta, double b_0, double b_1,
                       MomentContact&) const noexcept;
    void by_rule_d(const MomentMatrix& T, double eta, double b_0, double b_1,
                   MomentContact&) const noexcept;
    void by_galerkin(const MomentMatrix& T, double eta, double b_0, double b_1,
                     MomentContact&) const noexcept;

    ContactLaw law_;
    double beta_ = 0, span_ = 1, c_ = 0, share_ = 0.5;  // share_: 1/(alpha + 1)
    int halves_ = 0;                                    // 2 alpha, if that is a small whole number
    bool clipped_ = false, galerkin_ = false, linear_ = true;
};

}  // namespace jvari

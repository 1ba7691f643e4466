// Contact with any law over one step in a window, by collocation at Gauss-Legendre nodes (Hairer,
// Norsett & Wanner, section II.7): the forces are polynomials, and the points' motion under them is
// exact,
//
//     p_a(c_i d) = r_a(c_i d) + sum_b sum_l h_ab^(l) d^(l+1) sum_j w^l_ij F_bj,
//     w^l_ij = int_0^c_i (c_i - x)^l/l! L_j(x) dx,
//
// so that a step touches no mode. F = k eta|eta|^(alpha-1) (1 - beta v), odd beyond the surface
// like in string_equations.hpp; a clipped force has 0 in place of a negative factor. The last
// Legendre coefficients say whether the step was short enough.
//
// Newton's iteration solves for the node forces. A step that resolves the contact moves its points
// little by these forces: for many points the fixed-point iteration F = F(p(F)) gains two to three
// digits each time, and Newton's, with its cube of the points, goes on only where that fails.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "schemes/contact/contact.hpp"

namespace jvari {

class MacroWindow;

struct BarrierLaw {  // odd beyond the surface
    ContactLaw law;
    double beta = 0;  // for a contact loss [s/m]
    bool clipped = false;
    bool spring() const noexcept { return law.alpha == 1 && beta == 0; }
    // -dF/dy if the elastic force is known
    double stiffness(double eta, double elastic) const noexcept {
        if (eta == 0) return law.alpha == 1 ? law.k : 0;
        return law.alpha * std::abs(elastic / eta);
    }
    double elastic(double eta) const noexcept {
        return std::copysign(law.force(std::abs(eta)), eta);
    }
    // F over the elastic force, for a string that leaves at v
    double give(double v) const noexcept {
        return clipped ? std::max(0.0, 1 - beta * v) : 1 - beta * v;
    }
    double force(double eta, double v) const noexcept { return elastic(eta) * give(v); }
};

class CollocatedContact {
public:
    CollocatedContact(const MacroWindow&, std::span<const BarrierLaw> per_contact);

    // Makes a step of length d from r[contact][stride]; the touching points are given. Returns its
    // error relative to the speeds there, or infinity. From: the start of this step relative to the
    // last one, whose forces are a first guess
    enum class From { elsewhere, last_end, same_start };
    double step(const double* r, std::span<const int> touching, double d, From) noexcept;

    // Results of the last step: every contact's derivatives, forces and their moments, and the
    // energy that contact losses took [J].
    void path(const double* r, double* path) const noexcept;
    // `at` from the step's start [N]
    double force(int which, double at) const noexcept;
    // until no later than the step's end
    void moments(int which, double until, int count, double* m) const noexcept;
    double dissipated(int which) const noexcept;

private:
    // derivatives of a force, at the step's start
    void derivatives(int which, double* f) const noexcept;
    static constexpr int nodes = 8, orders = 34;
    const MacroWindow* window_;
    std::vector<BarrierLaw> law_;
    // and the rows that give the last two Legendre coefficients
    std::array<double, nodes> node_, weight_, last_, before_last_;
    std::vector<double> within_;  // w^l_ij [order][j][i]
    // int_0^1 (1 - x)^i/i! L_j(x) dx
    std::array<double, orders * nodes> whole_;
    // node values -> coefficients of x^n
    std::array<double, nodes * nodes> powers_;

    void guess(std::span<const int> touching, double d, From) noexcept;
    int orders_of(double d) const noexcept;
    void couple(double d) noexcept;
    void move_points(double d) noexcept;
    // Tests whether the contact lets go in the last step, or takes hold again: returns its force,
    // or the force that it would have [N]; 0 if neither happens
    double lets_go_within(int which) const noexcept;

    std::vector<int> touching_;
    int count_ = 0;
    double d_ = 0;  // 0: no step worth a guess
    std::vector<double> force_, guess_, position_, speed_, base_, base_speed_, couple_,
        couple_speed_, matrix_, right_, stiffness_, drag_, scratch_, integrals_;
    bool lossy_ = false;
};

}  // namespace jvari

// Solves an implicit step, (a0 I + a2 D2 + a4 D4) u = x, by two short symmetric sums over
// neighbours instead of a recursion.
//
// On sequences that are odd about both ends the matrix is a convolution, A(z) = A0 + A1 (z + 1/z) +
// A2 (z^2 + z^-2). So A(-z) A(z) = B(z^2), again in that form, and 1/A(z) = A(-z) B(-z^2)/C(z^4)
// (Graeffe 1837; cyclic reduction, Hockney 1965). The off-diagonal part is squared each time: 1/C
// is a sum of few terms, cut once the rest is below 2^-58 times the first. Every node is
// independent of its neighbours' results, unlike in a factorisation L D L'. If there are more than
// `most` terms, or if the grid is short beside them, the factors L D L' solve.
#pragma once

#include <array>

#include "schemes/aligned.hpp"
#include "schemes/grid/finite_difference.hpp"

namespace jvari {

class GridSolve {
public:
    GridSolve() = default;
    GridSolve(const Grid&, double a0, double a2, double a4);  // Refusal unless positive definite

    // x_0 at [0]; room before x_0, and a vector after x_N
    double* input() noexcept { return from_.data() + offset; }
    // input x_1..x_{N-1}; u_N and a vector beyond it become zero
    void operator()(double* u) noexcept;
    Stencil response(const Stencil& s) const { return factor_.solve(s); }
    int terms() const { return terms_; }  // in 1/C; 0: factors

private:
    // nodes beyond either end; node 1 on a 64-byte boundary
    static constexpr int most = 16, near = 6, offset = 4 * most + 15;
    using Sums = void (*)(const double* close, const double* far, int terms, int intervals,
                          double* x, double* between, double* u);
    static Sums sums(int pairs);
    int intervals_ = 0;
    BandedFactor factor_;
    std::array<double, near + 1> near_{};  // A(-z) B(-z^2)
    std::array<double, most> far_{};       // 1/C, in z^4
    int terms_ = 0;
    AlignedVector from_, between_;
    Sums sums_ = nullptr;
};

// Ends a midpoint step (finite_difference_hamiltonian.cpp): y_l <- y_l + s_l, q_l <- s_l - q_l; s_N
// and a vector beyond it are zero.
using MidpointPass = void (*)(int intervals, double* y, double* q, const double* s);
MidpointPass midpoint_pass();

// Ends a step that solves for an increment (finite_difference_theta.cpp): u_l <- u_l + before_l;
// u_N and a vector beyond it are zero.
using IncrementPass = void (*)(int intervals, double* u, const double* before);
IncrementPass increment_pass();

}  // namespace jvari

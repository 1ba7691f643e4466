// The inner loops of a macro window, compiled once per instruction set: the modes read once, the
// modes moved once, and the sums over short vectors in between. Modes are in blocks of sweep_lanes,
// each with its own number of terms: slow modes need few.
#pragma once

namespace jvari {

constexpr int sweep_lanes = 32;  // modes in a block; they are padded to a multiple of 8

struct ModalSweep {
    int modes = 0, outputs = 0, forces = 0;
    int count = 0, stride = 0;                // read: derivatives of an output, and between outputs
    const int* terms = nullptr;               // [block]
    const double *y = nullptr, *u = nullptr;  // state; u = velocity in units of the window
    const double *a = nullptr, *b = nullptr;  // y'' = -a y' - b y
    // The last output's weights are `base`, and the others' are in units of those: a product less
    // for each term. Likewise of the forces.
    // [mode], zero for what fills a vector alone
    const double* base = nullptr;
    // [output but the last][mode]
    const double* weights = nullptr;
    // read: [output][stride], derivatives; reach behind them
    double *p = nullptr, *scratch = nullptr;
    // read: [output], sum |w| (|y| + |u|)
    double* reach = nullptr;
    // move: the free motion's matrix
    const double *e11 = nullptr, *e12 = nullptr, *e21 = nullptr, *e22 = nullptr;
    // [term], of a force whose gains are `base`
    const double* base_moments = nullptr;
    // [force][mode], over base
    const double* const* gains = nullptr;
    const double* const* moments = nullptr;  // [force][term]
    double *y_out = nullptr, *u_out = nullptr;
};
struct SweepFunctions {
    // p[o][n] = n-th derivative of sum_i base_i w_oi y_i. scratch: (outputs (count + 1) + 4 count)
    // x 8 doubles
    void (*read)(const ModalSweep&);
    // y_out = e11 y + e12 u + ..., with base sum_n A^n (0, m_n + sum_f gain_f m_fn) by Horner
    void (*move)(const ModalSweep&);
    // out[i] += sum_j x_j A[j step + i], i < size: shifts, convolutions and matrices, by the step.
    // size: a multiple of 8. For step -1 there are `count` zeros before A, or before A + 1.
    void (*combine)(double* out, int size, const double* x, int count, const double* A, long step);
    // the same, out[i] = ...
    void (*combined)(double* out, int size, const double* x, int count, const double* A, long step);
    // e[n] = u^n/n!, n < count in whole vectors of at most 8
    void (*powers)(double u, int count, const double* inverse_factorial, double* e);
    // out[k] = sum_n p[n + k] u^n/n!, k < 3, n < size <= 32: a motion of derivatives p at u, and
    // its first two derivatives there
    void (*evaluate)(const double* p, int size, double u, double* out);
    // The same of |p[n + k]| for k = 2, 3: bounds of the second and third derivatives up to u
    void (*bound)(const double* p, int size, double u, double* out);
    // The least and the largest coefficient of the motion of derivatives p over [0, u] in
    // Bernstein's polynomials of degree size - 1 <= 31, which it stays between. bernstein: C(i,
    // n)/(C(size - 1, n) n!) [n][i]
    void (*range)(const double* p, const double* bernstein, int size, double u, double* out);
    // sum_j matrix[j][i] x[j] = right[i] without pivots, first the factors in the place of the
    // matrix, then x in the place of right. scratch: size, a multiple of 8
    void (*factor)(double* matrix, double* scratch, int size);
    void (*substitute)(const double* matrix, double* right, double* scratch, int size);
    // out[j][i] = row[i] A[j][i] + row2[i] A2[j][i], and 1 more where i = j; A2 may be absent
    void (*scale_rows)(double* out, const double* row, const double* A, const double* row2,
                       const double* A2, int size);
};
const SweepFunctions& sweep_functions();

}  // namespace jvari

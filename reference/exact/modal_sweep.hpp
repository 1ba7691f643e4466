// Inner loops of a macro window, compiled once per instruction set: the modes read once, the modes
// moved once, and the sums over short vectors in between. Modes are in blocks of sweep_lanes, each
// with its own number of terms: slow modes need few.
#pragma once

namespace jvari {

constexpr int sweep_lanes = 32;  // modes in a block; they are padded to a multiple of 8

struct ModalSweep {
    int modes = 0, outputs = 0, forces = 0;
    // read: derivatives per output, and distance between outputs
    int count = 0, stride = 0;
    const int* terms = nullptr;               // [block]
    const double *y = nullptr, *u = nullptr;  // state; u = velocity in window units
    const double *a = nullptr, *b = nullptr;  // y'' = -a y' - b y
    // Weights: the last output's are `base`, and the others' are relative to them, which saves a
    // product in each term. The forces' gains are stored likewise. [mode], zero in the padding of a
    // vector
    const double* base = nullptr;
    // [output but the last][mode]
    const double* weights = nullptr;
    // read: [output][stride], derivatives; reach behind them
    double *p = nullptr, *scratch = nullptr;
    // read: [output], sum |w| (|y| + |u|)
    double* reach = nullptr;
    // move: the free motion's matrix
    const double *e11 = nullptr, *e12 = nullptr, *e21 = nullptr, *e22 = nullptr;
    // [term], for a force with gains `base`
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
    // out[k] = sum_n p[n + k] u^n/n!, k < 3, n < size <= 32: a motion with derivatives p at u, and
    // its first two derivatives there
    void (*evaluate)(const double* p, int size, double u, double* out);
    // Likewise for |p[n + k]|, k = 2, 3: bounds on the second and third derivatives up to u
    void (*bound)(const double* p, int size, double u, double* out);
    // Least and largest coefficient in Bernstein's polynomials of degree size - 1 <= 31 for the
    // motion with derivatives p over [0, u]; the motion stays between them. bernstein: C(i,
    // n)/(C(size - 1, n) n!) [n][i]
    void (*range)(const double* p, const double* bernstein, int size, double u, double* out);
    // Solves sum_j matrix[j][i] x[j] = right[i] without pivots: first the factors replace the
    // matrix, then x replaces right. scratch: size, a multiple of 8
    void (*factor)(double* matrix, double* scratch, int size);
    void (*substitute)(const double* matrix, double* right, double* scratch, int size);
    // out[j][i] = row[i] A[j][i] + row2[i] A2[j][i], and 1 more where i = j; A2 may be absent
    void (*scale_rows)(double* out, const double* row, const double* A, const double* row2,
                       const double* A2, int size);
};
const SweepFunctions& sweep_functions();

}  // namespace jvari

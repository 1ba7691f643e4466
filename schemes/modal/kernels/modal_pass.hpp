// One fused pass over the modes: the update and the dots that the next step asks for, compiled once per instruction set.
#pragma once

namespace jvari {

constexpr int modal_lanes = 8;  // arrays are padded to a multiple of this

struct ModalPass {
    int size = 0;
    double *x = nullptr, *v = nullptr;                            // state
    const double *p = nullptr, *r = nullptr;                      // coefficients
    const double *g_b = nullptr, *g_c = nullptr;                  // weights of the dots
    const double *e_b = nullptr, *e_c = nullptr, *e_e = nullptr;  // what a force does to the increment
    double F_b = 0, F_c = 0, F_e = 0;                             // [N]
    double x_b = 0, v_b = 0, x_c = 0, v_c = 0;                    // out: g.x and g.(next increment)
};
using ModalPassFunction = void (*)(ModalPass&);

// x' = x + s, v' = p s - (v + r x), s = v + e F; v_z = g_z.v'.   x = y, v = u, p = 2(1-A)/J, r = 4A/J of the two-point form
ModalPassFunction two_point_pass(bool barrier, bool thread, bool pluck);

// sum w x, x of whole vectors: what a tap reads.
double pass_dot(const double* w, const double* x, int size);

}  // namespace jvari

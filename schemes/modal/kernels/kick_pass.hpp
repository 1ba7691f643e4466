// One fused pass over modes that are kicked and then move freely for a given time, compiled once per instruction set.
#pragma once

namespace jvari {

// v <- v + g_b P_b + g_c P_c + g_e P_e,  (q, v) <- (a q + b v, c q + d v),  y_z = g_z.q
struct KickPass {
    int size = 0;                                                         // whole vectors
    double *q = nullptr, *v = nullptr;                                    // [m], [m/s]
    const double *a = nullptr, *b = nullptr, *c = nullptr, *d = nullptr;  // of the free motion
    const double *g_b = nullptr, *g_c = nullptr, *g_e = nullptr;          // not read where the part is absent
    double P_b = 0, P_c = 0, P_e = 0;                                     // impulses over the modal mass [m/s]
    double y_b = 0, y_c = 0;                                              // out [m]
};
using KickPassFunction = void (*)(KickPass&);
KickPassFunction kick_pass(bool barrier, bool thread, bool pluck);

}  // namespace jvari

// Pass of three-point schemes over a string's nodes; Highway compiles it once per instruction set:
//
//     next_l = a0 u_l + a1 p_l + a2 q_l + b0 u-_l + b1 p-_l + b2 q-_l,   p_l = u_{l-1} + u_{l+1},
//     q_l = u_{l-2} + u_{l+2},   l = 1..N-1
//
// which is W u+ in (M + dt R/2) u+ = (2M - dt^2 K) u - (M - dt R/2) u- (three_point_string.hpp).
// The sum b1 p + b2 q for a level is formed with a1 p + a2 q and kept for the next step, when the
// level is the old one: a loss in space costs one load and one store more, however far it reaches.
// One indirect call per pass of hundreds of operations picks the instruction set. u_N and up to a
// vector beyond it are set to zero: the arrays are that long.
#pragma once

namespace jvari {

struct FivePointWeights {
    double a0 = 0, a1 = 0, a2 = 0, b0 = 0, b1 = 0, b2 = 0;
};
constexpr int five_point_overhang = 16;  // doubles beyond node N that an array must have

// kept: in, b1 p- + b2 q-; out, b1 p + b2 q. Not touched if b1 = b2 = 0.
using FivePointPass = void (*)(const FivePointWeights&, int intervals, double* next,
                               const double* now, const double* before, double* kept);
FivePointPass five_point_pass(const FivePointWeights&);  // the shorter pass if b1 = b2 = 0

}  // namespace jvari

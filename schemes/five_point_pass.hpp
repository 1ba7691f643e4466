// The pass of three-point schemes over the nodes of a string, compiled once per instruction set by Highway:
//
//     next_l = a0 u_l + a1 (u_{l-1} + u_{l+1}) + a2 (u_{l-2} + u_{l+2}) + b0 u-_l + b1 (u-_{l-1} + u-_{l+1}),   l = 1..N-1
//
// which is W u+ of (M + dt R/2) u+ = (2M - dt^2 K) u - (M - dt R/2) u- (three_point_string.hpp). One indirect call per pass of hundreds of
// operations picks the instruction set. u_N and up to a vector beyond it are set to zero: the arrays are that long.
#pragma once

namespace jvari {

struct FivePointWeights {
    double a0 = 0, a1 = 0, a2 = 0, b0 = 0, b1 = 0;
};
constexpr int five_point_overhang = 16;  // doubles beyond node N that an array must have

using FivePointPass = void (*)(const FivePointWeights&, int intervals, double* next, const double* now, const double* before);
FivePointPass five_point_pass(const FivePointWeights&);  // the shorter one where b1 = 0

}  // namespace jvari

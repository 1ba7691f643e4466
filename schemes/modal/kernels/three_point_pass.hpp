// One step of a string in its modes by a three-point scheme, and what its points read of it:
// compiled once per instruction set by Highway.
//
// Per mode  y+ = C y - C~ y- + gain F  (Issanchou et al. 2016, eq 14) is carried as displacement
// and increment, d+ = C~ d - kappa y + gain F, y+ = y + d+, kappa = 1 + C~ - C: the same recursion,
// but a rounding error in C (which is 2 - O(omega dt)^2) would detune low modes at high rates. A
// port is a place where a force enters the string or a displacement is read, by modal weights.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "schemes/aligned.hpp"

namespace jvari {

struct Port {
    std::vector<double> weights;  // g_j: displacement is sum_j g_j y_j, force on mode j is g_j F
    // 1 .. N-1 where the weights are those of a node, sin(j pi node/N); else 0
    int node = 0;
};

struct LinearUpdate {
    int intervals = 0;               // N: modes 1 .. N-1, nodes x_i = i L/N
    std::vector<double> Ct, kappa;   // C~ and 1 + C~ - C of each mode
    double gain = 0;                 // dt^2/m [s^2/kg]
    std::vector<double> over_plain;  // what each mode's gain is times that; empty: 1
    std::vector<Port> ports;
    int reads = 0;  // the first `reads` ports are read, every one can be pushed
    int modes() const { return intervals - 1; }
    // of mode j + 1
    double gain_of(int j) const { return over_plain.empty() ? gain : gain * over_plain[j]; }
};

// The two levels that a form carries, in its own coordinates, and a copy of the increment taken
// when asked for.
struct Levels {
    AlignedVector displacement;  // y^n [m]
    AlignedVector increment;     // y^{n+1} - y^n without the force of step n [m]
    AlignedVector kept;          // an earlier increment

    void listen() { kept = AlignedVector(increment.size()); }  // before keep()
    void keep() { std::copy_n(increment.data(), increment.size(), kept.data()); }
};

class ThreePointPass {
public:
    explicit ThreePointPass(const LinearUpdate&);
    ~ThreePointPass();
    void start(const double* y, const double* free_increment);  // modal values at t = 0
    // displacement of the reads at n+1 without the force of step n
    void read(double* free) const;
    // applies the forces of step n, n -> n+1, then reads
    void advance(const double* force, double* free);
    void to_modal(const AlignedVector& level, double* modal) const;
    // weights of the same quantity in own coordinates
    AlignedVector reading(const std::vector<double>& modal_weights) const;
    Levels levels;

private:
    struct Plan;
    std::unique_ptr<Plan> plan_;
};

}  // namespace jvari

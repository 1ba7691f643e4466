// One step of a string in its modes by a three-point scheme, and its readings at the points;
// Highway compiles it once per instruction set.
//
// Per mode  y+ = C y - C~ y- + gain F  (Issanchou et al. 2016, eq 14) is carried in displacement
// and increment, d+ = C~ d - kappa y + gain F, y+ = y + d+, kappa = 1 + C~ - C. This is the same
// recursion, but a rounding error in C (which is 2 - O(omega dt)^2) would detune low modes at high
// rates. A port is a place at which a force enters the string or a displacement is read, by modal
// weights.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "schemes/aligned.hpp"

namespace jvari {

struct Port {
    std::vector<double> weights;  // g_j: displacement is sum_j g_j y_j, force on mode j is g_j F
    // 1 .. N-1 if the weights are node weights, sin(j pi node/N); otherwise 0
    int node = 0;
};

struct LinearUpdate {
    int intervals = 0;               // N: modes 1 .. N-1, nodes x_i = i L/N
    std::vector<double> Ct, kappa;   // C~ and 1 + C~ - C for each mode
    double gain = 0;                 // dt^2/m [s^2/kg]
    std::vector<double> over_plain;  // factor between each mode's gain and `gain`; empty: 1
    std::vector<Port> ports;
    int reads = 0;  // the first `reads` ports are read, every port can be pushed
    int modes() const { return intervals - 1; }
    // for mode j + 1
    double gain_of(int j) const { return over_plain.empty() ? gain : gain * over_plain[j]; }
};

// Two levels in a form's own coordinates, and a copy of the increment taken on demand.
struct Levels {
    AlignedVector displacement;  // y^n [m]
    AlignedVector increment;     // y^{n+1} - y^n without the force in step n [m]
    AlignedVector kept;          // an earlier increment

    void listen() { kept = AlignedVector(increment.size()); }  // before keep()
    void keep() { std::copy_n(increment.data(), increment.size(), kept.data()); }
};

class ThreePointPass {
public:
    explicit ThreePointPass(const LinearUpdate&);
    ~ThreePointPass();
    void start(const double* y, const double* free_increment);  // modal values at t = 0
    // displacement at the reads at n+1 without the force in step n
    void read(double* free) const;
    // applies the forces in step n, n -> n+1, then reads
    void advance(const double* force, double* free);
    void to_modal(const AlignedVector& level, double* modal) const;
    // weights for the same quantity in own coordinates
    AlignedVector reading(const std::vector<double>& modal_weights) const;
    Levels levels;

private:
    struct Plan;
    std::unique_ptr<Plan> plan_;
};

}  // namespace jvari

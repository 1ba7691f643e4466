// Several strings of the modal two-point scheme stepped together, a lane of a vector for each: linear contact, the modes' own compliance.
//
// A mode carries r = u - sum_z g_z F_z', F' the forces of the step before, where modal_two_point_kernel.hpp carries u. Then
//     s = r + sum_z g_z (F_z + F_z'),   y <- y + s,   r <- s - loss s - c y
// and what a point sees of the modes needs, but for r_z = g_z.r, no sum over them: with theta_zw = g_z.g_w
//     u_z = r_z + sum_w theta_zw F_w',   s_z = u_z + sum_w theta_zw F_w,   y_z <- y_z + s_z.
// That is seven operations a mode, where one string alone takes eleven, and no sum over lanes. y_z is summed anew at times, lest its
// rounding grow; theta_zw must be right to the last bit, as its error adds up at every step of contact.
#pragma once

#include <span>
#include <vector>

#include "schemes/aligned.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

constexpr int most_lanes = 16;

struct alignas(64) PerString {  // a number of each string; 0 where there is none
    double of[most_lanes] = {};
};

struct CompanyRead {           // a tap of each string from its modes
    AlignedVector on_y, on_u;  // weights, as Company::weights; on_u: empty where all are of y alone
    PerString value;           // at the last row
};

struct CompanyPluck {
    const double* force = nullptr;  // mean of step first + n, n < steps [N]
    long first = 0, steps = 0;
};

struct Company {
    int lanes = 0, modes = 0;
    int steps_per_row = 1;
    AlignedVector state;    // [mode][y, r][lane]
    AlignedVector weights;  // [mode][g_b, g_c, c, loss][lane]; [mode][..] where they are the same in all strings
    AlignedVector g_e;      // [mode][lane] likewise
    std::vector<CompanyRead> reads;
    CompanyPluck plucks[most_lanes];
    PerString k, h_b, k_c, h_c, lost_c;         // lost_c = r_c/dt
    PerString theta, phi_c, inverse_c, beta_c;  // of the elimination, as TwoPoint has them
    PerString theta_bb, theta_bc, theta_cc, theta_be, theta_ce;

    // what changes from step to step
    long step = -1;                            // -1: not begun
    long steady_until = 0;                     // no pluck begins or ends before
    bool plucked = false;                      // until then
    long read_at = -1;                         // the step at which a pass summed reads.front()
    PerString y_b, y_c, r_b, r_c;              // dots of the present state
    PerString F_b, F_c, F_e;                   // of the step before [N]
    PerString impulse_b, impulse_c;            // sums of forces since the last row [N]
    PerString supplied, dissipated;            // since the last row [J]
    PerString least_force, most_force, depth;  // over the run
    std::vector<PerString> rows;               // that wait to be handed out, [row][quantity]
};
enum CompanyWeight { on_bridge, on_thread, on_c, on_loss, company_weights };

// What a row tells of each string: forces [N], energies [J] and its reads.
enum CompanyQuantity { bridge_mean, thread_mean, driving_mean, stored_energy, supplied_energy, dissipated_energy, first_read };
constexpr int company_rows = 8;  // a line of each column at a time: a pass leaves little of it in the first-level cache

struct CompanyColumn {  // of one string, into its block
    int quantity, lane;
    double* to;
};

// In the widest vector instructions of this machine. advance: writes each row of the block and then makes its steps; of a member's block,
// for rows, stop, and whether energy is probed.
struct CompanyKernel {
    std::size_t lanes = 0;              // 0: not on this machine
    void (*begin)(Company&) = nullptr;  // by a new state
    void (*advance)(Company&, std::span<const CompanyColumn>, const Block&) = nullptr;
};
CompanyKernel company_kernel(bool alike, bool thread);

}  // namespace jvari

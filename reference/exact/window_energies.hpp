// Energy that a string gains and loses within a macro window (van Walstijn et al. 2016, eqs 1, 12
// and 19):
//
//     dissipated = int sum_i 2 m sigma_i v_i^2 + r_c v_c^2 + z' Q z' dt,
//     supplied = int F_e v_e - F_e' sum_a C_ae F_a dt
//
// with v the velocities of modes, thread and pluck, and z and C_ae for the series compliance
// (in_series.hpp). If stiff contacts touch, v = S + Re sum_k beta_k W_k e^(lambda_k t): S varies at
// the string's rate, with one fast pair per contact (touching_set.hpp); a slow pair stays in S.
// Slow products are integrated by Gauss-Legendre, S against a pair by a Legendre series against its
// exponential, two pairs in closed form. So the nodes follow the string, not the contact.
#pragma once

#include <complex>
#include <vector>

#include "reference/exact/macro_window.hpp"
#include "reference/exact/touching_set.hpp"

namespace jvari {

class WindowEnergies {
public:
    // the window outlives this object
    WindowEnergies(MacroWindow&, const Modes&, double tolerance);

    struct Sums {
        double supplied = 0, dissipated = 0;  // [J]
    };

    // Contribution of one touching set's pairs to all losses and gains, per unit of beta; empty for
    // a soft set.
    struct Pairs {
        std::vector<std::complex<double>> rates;  // [1/window]
        // [2 pair][contact x stride]: real and imaginary part
        std::vector<double> moments;
        std::vector<double> velocity;  // W [2 pair][mode]
        // at the thread [pair], for z [pair][state]
        std::vector<std::complex<double>> thread, series;
        // for contacts and thread [pair][point]
        std::vector<std::complex<double>> force;
        // W' L W and W' L conj(W) [pair][pair], L the losses
        std::vector<std::complex<double>> product, product_of_conjugate;
        // W_k at the pluck
        std::vector<std::complex<double>> pluck;
        // row' W_k
        std::complex<double> against(const std::vector<double>& row, int pair,
                                     const Oscillators&) const;
    };
    Pairs pairs_of(const TouchingSet&);  // overwrites the open window
    struct Touch {
        TouchingSet set;
        Pairs pairs;
    };

    // Interval between two instants in the window opened on (y, u).
    struct Stretch {
        double from, to;
        const double *y, *u;
        const Touch* touch = nullptr;  // solved at `from`; nullptr: no springs touch
    };
    // moments(at, M, F) gives the contact forces' moments M[contact][stride], and the forces.
    template <class Moments>
    void spend(const Stretch& s, Moments&& moments, Sums& sums) noexcept {
        const int pieces = plan(s);
        for (int i = 0; i < pieces; ++i) {
            const double start = s.from + length_ * i;
            for (int q = 0; q < rule_->nodes; ++q) {
                const double at = start + length_ * rule_->node[q];
                moments(at, moments_.data(), force_.data());
                add_node(s, q, at, sums);
            }
            if (!split_.empty()) add_pairs(s, start, sums);
        }
    }

private:
    static constexpr int most_nodes = 12;
    struct Rule {  // Gauss-Legendre on 0 ... 1
        int nodes;
        double growth;  // growth that the rule integrates well over a piece, in powers of e
        double node[most_nodes], weight[most_nodes];
    };
    int plan(const Stretch&) noexcept;  // returns the number of pieces; sets the members below
    void add_node(const Stretch&, int q, double at, Sums&) noexcept;
    void add_pairs(const Stretch&, double start, Sums&) noexcept;

    MacroWindow* window_;
    std::vector<Rule> rules_;          // the coarsest first
    std::vector<double> loss_;         // [mode]: J per squared displacement in a window
    double thread_loss_ = 0;           // and at the thread's point
    std::vector<double> series_loss_;  // and for z [state][state]
    // per mode's displacement in a window: thread and pluck, the latter per window
    std::vector<double> thread_, pluck_;
    std::vector<double> legendre_;  // [degree][node]: values to a Legendre series
    std::vector<double> moments_, y_, u_, lost_, force_, speed_;  // at a node
    // [pair][node]: S against W_k, and F_e
    std::vector<std::complex<double>> lost_to_, gained_by_;
    const Rule* rule_ = nullptr;
    double length_ = 0;       // length of a piece [window]
    std::vector<int> split_;  // the fast pairs
};

}  // namespace jvari

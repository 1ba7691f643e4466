// Exact flight of a string that touches no barrier, thread and pluck acting, until it reaches one: series, rigorous remainder and Bernstein
// isolation of exact_contact.cpp without its contacts. Times are in units of 1/rate (oscillators.hpp).
#pragma once

#include <array>
#include <vector>

#include "reference/oscillators.hpp"
#include "reference/springs.hpp"

namespace jvari {

class Flight {
public:
    Flight(const Modes&, const String&);

    Oscillators osc;
    Springs springs;

    struct Landing {
        double length;  // flown; negative: the state is no number
        int contact;    // which barrier is reached, -1: none yet
    };
    struct Sums {                                                     // of a row's interval
        double bridge = 0, thread = 0, supplied = 0, dissipated = 0;  // [N s], [N s], [J], [J]
    };
    // One window, no longer than `left`. `leaving`: the barrier whose surface the string has just left, -1: none. Energies where `probe`.
    Landing fly(double left, bool plucked, double since_pluck, int leaving, double* y, double* u, Sums&, bool probe) noexcept;

    double tolerance() const { return tolerance_; }  // no contact deeper than this was missed [m]
    void reset() { tolerance_ = 0; }

private:
    double bound(int contact, double z, int p_terms, double growth) const noexcept;
    void to(double fraction, double z, int p_terms, bool plucked, const double* y, const double* u, double* y_out, double* u_out) noexcept;
    void spend(double fraction, double z, int p_terms, bool plucked, const double* y, const double* u, Sums&) noexcept;

    static constexpr int nodes = 8;  // Gauss-Legendre nodes per window, of the energies
    std::vector<Pluck> pluck_;       // none or one
    std::vector<char> none_;
    std::vector<double> loss_;  // 2 m sigma rate, per mode
    double mass_, growth_, tolerance_ = 0;
    int terms_ = 0;
    std::vector<double> p_, displacement_, force_, gap_, reach_, scratch_, moments_, impulse_, y_node_, u_node_;
    std::vector<const double*> acting_;
    std::array<double, nodes> node_{}, weight_{};
};

}  // namespace jvari

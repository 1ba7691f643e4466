// Exact flight of a string that touches no barrier, thread and pluck acting, until it reaches one:
// a macro window without its contacts, and the first crossing of its gaps. Times are in units of
// 1/rate (oscillators.hpp), and so are the velocities here.
#pragma once

#include <algorithm>
#include <vector>

#include "reference/exact/macro_window.hpp"
#include "reference/exact/window_energies.hpp"

namespace jvari {

class Flight {
public:
    // between rows [s]
    Flight(const Modes&, const String&, double interval, const std::optional<InSeries>& = {});

    MacroWindow window;

    struct Landing {
        double length;  // flown; negative: the state is no number
        int contact;    // which barrier is reached, -1: none yet
    };
    struct Sums {                       // of a row's interval
        double bridge = 0, thread = 0;  // [N s]
        WindowEnergies::Sums energies = {};
    };
    std::vector<double> z;  // of what is in series (in_series.hpp), of the present state

    // One window, no longer than `left`. `leaving`: the barrier whose surface the string has just
    // left, -1: none. Energies where `probe`.
    Landing fly(double left, bool plucked, double since_pluck, int leaving, double* y, double* u,
                Sums&, bool probe) noexcept;

    double tolerance() const { return tolerance_; }  // no contact deeper than this was missed [m]
    void reset() {
        tolerance_ = 0;
        std::fill(z.begin(), z.end(), 0.0);
    }

private:
    double longest_plucked_ = 1, tolerance_ = 0;  // of a window under the pluck [window]
    std::vector<double> r_, none_;
    WindowEnergies energies_;
};

}  // namespace jvari

// Computes the exact flight of a string that touches no barrier, with thread and pluck acting,
// until it reaches one. The flight uses a macro window without its contacts and finds the first
// crossing of its gaps. Times are in units of 1/rate (oscillators.hpp), and so are the velocities
// here.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/exact/crossing.hpp"
#include "reference/exact/macro_window.hpp"
#include "reference/exact/pluck_series.hpp"
#include "reference/exact/window_energies.hpp"

namespace jvari {

class Flight {
public:
    // between rows [s]
    Flight(const Modes& modes, const String& s, double interval,
           const std::optional<InSeries>& series)
        : window(modes, s, interval, of_window, series), energies_(window, modes, of_window) {
        if (s.pluck) longest_plucked_ = std::min(1.0, pluck_window(*s.pluck) / window.seconds());
        if (series) z.assign(series->states, 0.0);
        r_.assign(static_cast<std::size_t>(window.contacts + 1) * window.stride, 0.0);
        none_ = r_;
    }

    MacroWindow window;

    struct Landing {
        double length;  // flown; negative: the state is no number
        int contact;    // barrier reached, -1: none yet
    };
    struct Sums {                       // sums over a row's interval
        double bridge = 0, thread = 0;  // [N s]
        WindowEnergies::Sums energies = {};
    };
    std::vector<double> z;  // present state of the series compliance (in_series.hpp)

    // Flies for one window, at most `left`. `leaving`: the barrier whose surface the string has
    // just left, -1: none. Energies are computed if `probe`.
    Landing fly(double left, bool plucked, double since_pluck, int leaving, double* y, double* u,
                Sums& sums, bool probe) noexcept {
        MacroWindow& w = window;
        const double longest = (plucked ? longest_plucked_ : 1) * w.length;
        const bool whole = left <= longest;
        const double full = whole ? left : left / std::ceil(left / longest),
                     end = std::min(1.0, full / w.length);
        for (int i = 0; i < w.osc.padded; ++i) u[i] *= w.length;
        w.open(y, u, plucked, since_pluck, z.data());
        Landing landing{end, -1};
        for (int a = 0; a < w.contacts; ++a) {
            double* r = r_.data() + static_cast<long>(a) * w.stride;
            std::copy_n(w.free_motion(a), w.size, r);
            if (a == leaving) r[0] = 0;
            const double* leading = std::find_if(r, r + w.size, [](double c) { return c != 0; });
            if (leading != r + w.size && !(*leading > 0)) {  // the point touches already, or is NaN
                for (int i = 0; i < w.osc.padded; ++i) u[i] /= w.length;
                return *leading < 0 ? Landing{0, a} : Landing{-1, -1};
            }
            const double contact = first_crossing({1, r, w.size, w.reach, nullptr, nullptr, 0},
                                                  landing.length, w.rounding());
            if (contact <= landing.length) landing = {contact, a};
        }
        tolerance_ = std::max(tolerance_, 2 * (w.truncation() + w.rounding()));
        const auto no_forces = [&](double, double* M, double* F) {
            std::fill_n(M, none_.size() - w.stride, 0.0);
            std::fill_n(F, w.contacts, 0.0);
        };
        if (probe) energies_.spend({0, landing.length, y, u}, no_forces, sums.energies);
        w.state_at(landing.length, none_.data(), y, u, y, u);
        sums.thread += w.thread_impulse();
        if (w.series()) std::copy_n(w.series_state(), z.size(), z.begin());
        for (int i = 0; i < w.osc.padded; ++i) u[i] /= w.length;
        landing.length = landing.contact < 0 ? full : landing.length * w.length;
        return landing;
    }

    double tolerance() const { return tolerance_; }  // no contact deeper than this was missed [m]
    void reset() {
        tolerance_ = 0;
        std::fill(z.begin(), z.end(), 0.0);
    }

private:
    // relative: the window's truncation is below rounding
    static constexpr double of_window = 1e-15;

    double longest_plucked_ = 1, tolerance_ = 0;  // for a window under the pluck [window]
    std::vector<double> r_, none_;
    WindowEnergies energies_;
};

}  // namespace jvari

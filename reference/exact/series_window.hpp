// State in series with a string's points (in_series.hpp) over one macro window, in the window's
// time unit: z' = A z + B F is linear. The free motion therefore has derivatives like the modes',
// and forces act by their moments:
//
//     D_a^(n) = (A^n z)_a,      z(t) = e^(A t) z(0) + sum_i A^i B M_i
#pragma once

#include <vector>

#include "reference/in_series.hpp"

namespace jvari {

class SeriesWindow {
public:
    // seconds: length of a window
    SeriesWindow(const InSeries&, double seconds, int derivatives, int moments);

    // derivatives of its D
    void add_free(int point, const double* z, double* derivatives) const noexcept;
    // moments[point]: for each point's force, or nullptr; from, to: z, may be the same array
    void move(double at, const double* from, const double* const* moments,
              double* to) const noexcept;
    void speed(const double* z, const double* F, double* out) const noexcept;  // z' [per window]

private:
    int states_, points_, derivatives_, moments_;
    std::vector<double> A_, B_;  // in window units
    std::vector<double> free_;   // A^n [point][n][state]
    std::vector<double> push_;   // A^i B [state][point][i]
};

// h^(n) for the points' D, [m/N] x rate^(n+1): response of `point` to a unit impulse at `force`, in
// time units of 1/rate.
std::vector<double> series_kernel(const InSeries&, double rate, int point, int force, int count);

}  // namespace jvari

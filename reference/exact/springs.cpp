#include "reference/exact/springs.hpp"

#include <algorithm>
#include <cmath>

#include "reference/exact/series_window.hpp"
#include "reference/masses.hpp"

namespace jvari {

Springs::Springs(const Modes& modes, const Oscillators& osc, const String& s,
                 const std::optional<InSeries>& in_series) {
    const double gain = 1 / (modes.mass * osc.rate * osc.rate);
    const auto add = [&](std::vector<double> g) {
        const auto w = osc.pad(g), d = osc.pad(g, gain);
        weights.insert(weights.end(), w.begin(), w.end());
        gains.insert(gains.end(), d.begin(), d.end());
    };
    for (const auto& [law, g] : touched_by(modes, s)) {
        add(g);
        k.push_back(law.stiffness.k);
        r.push_back(0);
        height.push_back(law.height);
    }
    contacts = static_cast<int>(k.size());
    if (s.thread) {
        add(footprint_weights(modes, s.thread->position, s.thread->width));
        k.push_back(s.thread->stiffness);
        r.push_back(s.thread->damping * osc.rate);
        height.push_back(s.thread->height);
    }
    points = static_cast<int>(k.size());
    forces = points + (s.pluck ? 1 : 0);
    if (s.pluck) {
        const auto g = footprint_weights(modes, s.pluck->position, s.pluck->width);
        const auto d = osc.pad(g, gain);
        gains.insert(gains.end(), d.begin(), d.end());
    }

    // h_ab is the motion of point a after the unit impulse at b: y = 0, u = gain_b.
    kernel.assign(static_cast<long>(points) * forces * longest_series, 0.0);
    const std::vector<double> rest(osc.padded, 0.0);
    std::vector<double> bound(points),
        scratch(static_cast<long>(points) * (longest_series + 1) * lanes);
    for (int b = 0; b < forces; ++b) {
        series(osc, rest.data(), gains.data() + static_cast<long>(b) * osc.padded, weights.data(),
               points, longest_series, kernel.data() + static_cast<long>(b) * longest_series,
               forces * longest_series, bound.data(), scratch.data());
        if (b == points)
            for (double reach : bound)
                pluck_reach = std::max(pluck_reach, reach * std::abs(s.pluck->amplitude));
    }
    for (int a = 0; in_series && a < points; ++a)
        for (int b = 0; b < points; ++b) {
            const auto more = series_kernel(*in_series, osc.rate, a, b, longest_series);
            double* hab = kernel.data() + (static_cast<long>(a) * forces + b) * longest_series;
            for (int n = 0; n < longest_series; ++n) hab[n] += more[n];
        }
    set_floor(std::max(2.0, in_series ? 2 * series_rate(*in_series) / osc.rate : 0));
}

void Springs::set_floor(double least) {
    sized_.assign(static_cast<long>(points) * forces, 0.0);
    // |h^(i)| <= i |h^(1)| bound: beyond the series kept, i 2^-i is nothing
    for (floor_ = least;;) {
        for (int a = 0; a < points; ++a)
            for (int b = 0; b < forces; ++b) {
                double power = 1, sum = 0;
                for (int i = 1; i < longest_series; ++i, power /= floor_)
                    sum += std::abs(h(a, b)[i]) * power;
                sized_[a * forces + b] = sum;
            }
        const double rho = growth(std::vector<char>(contacts + 1, 0).data());
        if (rho <= 1.05 * floor_) break;
        floor_ = rho;  // a faster thread: the sums shrink with it, and the next rho is no larger
    }
}

double Springs::growth(const char* touching) const {
    double rho = floor_;
    for (int a = 0; a < points; ++a) {  // K/rho^2 + R/rho = 0.9
        double K = 0, R = 0;
        for (int b = 0; b < points; ++b) {
            if (b < contacts && !touching[b]) continue;
            const double own = 1 + r[b] * h(b, b)[0];
            K += sized_[a * forces + b] * k[b] / own;
            R += (sized_[a * forces + b] * r[b] + std::abs(h(a, b)[0]) * k[b]) / own;
        }
        rho = std::max(rho, (R + std::sqrt(R * R + 3.6 * K)) / 1.8);
    }
    return rho;
}

void Springs::solve(const char* touching, double z, const double* p, int p_terms, int terms,
                    double* y, double* F) const {
    double power[longest_series];  // z^(i+1)
    power[0] = z;
    for (int i = 1; i < p_terms; ++i) power[i] = power[i - 1] * z;
    const auto pass_on = [&](int b, int m) {  // adds the effect of F_b^(m) to every later y
        const double f = F[b * longest_series + m];
        // h^(i) z^(i+1) no longer counts beyond p_terms, like p
        const int last = std::min(p_terms, terms - 1 - m);
        for (int a = 0; a < points; ++a) {
            double* const later = y + a * longest_series + m + 1;
            const double* const hab = h(a, b);
            for (int i = 1; i < last; ++i) later[i] += hab[i] * power[i] * f;
        }
    };
    for (int a = 0; a < points; ++a) {
        std::copy_n(p + a * longest_series, std::min(p_terms, terms), y + a * longest_series);
        std::fill(y + a * longest_series + std::min(p_terms, terms), y + a * longest_series + terms,
                  0.0);
    }
    for (int n = 0; n < terms; ++n) {
        for (int b = 0; b < contacts; ++b) {
            F[b * longest_series + n] =
                touching[b] ? k[b] * ((n == 0 ? height[b] : 0) - y[b * longest_series + n]) : 0;
            if (touching[b]) pass_on(b, n);
        }
        // the damper needs one derivative more: F is one term behind
        if (points > contacts && n > 0) {
            const int c = contacts;
            const double* yc = y + c * longest_series;
            F[c * longest_series + n] = 0;
            F[c * longest_series + n - 1] =
                k[c] * ((n == 1 ? height[c] : 0) - yc[n - 1]) - r[c] / z * yc[n];
            pass_on(c, n - 1);
        }
        if (forces > points) pass_on(points, n);
    }
}

}  // namespace jvari

#include "schemes/sitar/sitar_peg.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace jvari {

using std::numbers::pi;

namespace {
double phase_lag(double a, double w) {
    return w - 2 * std::atan2(a * std::sin(w), 1 + a * std::cos(w));
}  // [rad]
double allpass_for(double delay, double w) {
    return std::sin(0.5 * (1 - delay) * w) / std::sin(0.5 * (1 + delay) * w);
}  // exact at w
}  // namespace

PegTuning tune(double loop, double w, std::vector<double> sections) {
    PegTuning t;
    double delay = 0;
    for (double a : sections) delay += phase_lag(a, w) / w;
    t.half = static_cast<int>(sections.size() / 2);
    t.cells = static_cast<int>(std::floor(0.5 * (loop - delay - 0.5)));
    double rest = loop - delay - 2 * t.cells;  // 0.5 ... 2.5
    t.delay = loop - 2 * t.cells;
    if (rest >= 1.5) {
        sections.push_back(0);
        rest -= 1;
    }
    sections.push_back(allpass_for(rest, w));
    t.a = std::move(sections);
    return t;
}

double worst_cents(const PegTuning& t, const std::vector<double>& omega, double dt) {
    double worst = 0;
    for (std::size_t n = 0; n < omega.size(); ++n) {
        double w = omega[n] * dt;  // Newton: the loop's own partial n + 1 has lag(w) = 2 pi (n + 1)
        for (int i = 0; i < 3; ++i) {
            double lag = 2 * t.cells * w, slope = 2 * t.cells;
            for (double a : t.a) {
                lag += phase_lag(a, w);
                slope += (1 - a * a) / (1 + 2 * a * std::cos(w) + a * a);
            }
            w += (2 * pi * (static_cast<double>(n) + 1) - lag) / slope;
        }
        const double cents = 1200 * std::log2(w / (omega[n] * dt));
        if (std::abs(cents) > std::abs(worst)) worst = cents;
    }
    return worst;
}

// Stiff string: equal allpasses whose delay falls with frequency as the string's does;
// the number and coefficient with the least worst partial.
PegTuning tune_stiff(double loop, const std::vector<double>& omega, double dt) {
    PegTuning best = tune(loop, omega[0] * dt, {});
    double least = std::abs(worst_cents(best, omega, dt));
    for (int count = 1; count <= 16; ++count)
        for (double a = -0.02; a > -0.9; a -= 0.01) {
            const std::vector<double> sections(count, a);
            if (count * phase_lag(a, omega[0] * dt) / (omega[0] * dt) > loop - 8) break;
            const PegTuning t = tune(loop, omega[0] * dt, sections);
            const double worst = std::abs(worst_cents(t, omega, dt));
            if (worst < least) best = t, least = worst;
        }
    return best;
}

}  // namespace jvari

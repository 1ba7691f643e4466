// Models the waveguide's peg if a period is no whole number of samples, or if the string is stiff:
// allpasses between the two rails.
//
// Sources: fractional length, a first-order allpass with the exact delay at the first partial
// (Smith, "Physical audio signal processing"); dispersion, a cascade of equal allpasses (Van Duyne
// & Smith 1994). Lumped at the peg: the partials are right, the shapes near the peg are not.
#pragma once

#include <vector>

namespace jvari {

// Loop delay at the first partial, in samples, and its division between rails and filter.
struct PegTuning {
    int cells = 0;          // cells in a rail
    std::vector<double> a;  // allpass coefficients; none: a plain inversion
    int half = 0;           // allpasses before the middle of the filter, the position of the peg
    double delay = 0;       // filter delay at the first partial
};

// w: first partial [rad/sample]
PegTuning tune(double loop, double w, std::vector<double> sections);
PegTuning tune_stiff(double loop, const std::vector<double>& omega, double dt);

// Deviation of the worst partial from omega [rad/s], in cents.
double worst_cents(const PegTuning&, const std::vector<double>& omega, double dt);

// A sample and its two predecessors, for the energy: a wave's power follows from its difference
// over two steps (sitar.hpp).
struct History {
    double now = 0, before = 0, earlier = 0;

    void push(double x) noexcept {
        earlier = before;
        before = now;
        now = x;
    }
    // with the loss on the way taken out
    double slope(double loss) const { return now - loss * loss * earlier; }
};

// First-order allpass (a + 1/z)/(1 + a/z); a = 0 is a delay by one sample. Its state s holds the
// energy s^2/(1 - a^2) of the passing wave.
struct Allpass {
    double a = 0;
    History s;

    double pass(double x) noexcept {
        const double y = a * x + s.now;
        s.push(x - a * y);
        return y;
    }
    double slopes(double loss) const { return s.slope(loss) * s.slope(loss) / (1 - a * a); }
};

// Filter at the peg between the two rails in one plane, for a length that is not a whole number of
// samples.
struct PegFilter {
    std::vector<Allpass> sections;
    int half;
    double gain;  // loss over the filter's delay
    // right-going wave: arriving, at the peg, and leaving, before the gain
    History in, peg, out;

    PegFilter(const PegTuning& tuning, double loss_on_the_way)
        : half(tuning.half), gain(loss_on_the_way) {
        for (double a : tuning.a) sections.push_back({a, {}});
    }
    void clear() noexcept {
        in = peg = out = {};
        for (Allpass& section : sections) section.s = {};
    }
    double pass(double x) noexcept {
        in.push(x);
        const int count = static_cast<int>(sections.size());
        for (int i = 0; i < half; ++i) x = sections[i].pass(x);
        peg.push(x);
        for (int i = half; i < count; ++i) x = sections[i].pass(x);
        out.push(x);
        return gain * x;
    }
    double slopes(double loss) const {
        double sum = 0;
        for (const Allpass& section : sections) sum += section.slopes(loss);
        return sum;
    }
};

}  // namespace jvari

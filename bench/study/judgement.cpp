#include "bench/study/judgement.hpp"

#include <fmt/core.h>
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "analysis/dispersion.hpp"
#include "scenes/modes.hpp"

namespace jvari::bench::study {

std::vector<Flag> flags_of(const Summary& s) {
    const Flags raised = raised_by(s);
    std::vector<Flag> flags;
    if (raised.adhesion)
        flags.push_back(
            {"adhesion",
             fmt::format(
                 "the contact pulls with {:.2g} N{}: only a contact with loss may pull",
                 -s.smallest_contact_force,
                 s.largest_contact_force > 0
                     ? fmt::format(", and pushes with {:.2g} N at most", s.largest_contact_force)
                     : "")});
    if (raised.psi_gap)
        flags.push_back({facts::psi_gap.name,
                         fmt::format("the quadratised contact stores energy while the string is "
                                     "clear of it: psi is {:.2g} of its largest value",
                                     fact_of(s.facts, facts::psi_out_of_contact))});
    if (raised.energy)
        flags.push_back(
            {"energy",
             fmt::format("the energy ledger is open by {:.2g} of the largest stored energy",
                         s.energy_residual_accumulated)});
    if (raised.modes_above_nyquist)
        flags.push_back({facts::modes_above_nyquist.name,
                         fmt::format("{:.0f} modes lie at or above half the sample rate and alias",
                                     fact_of(s.facts, facts::modes_above_nyquist))});
    return flags;
}

std::string names_of(const std::vector<Flag>& flags) {
    std::string names;
    for (const Flag& f : flags) names += (names.empty() ? "" : " ") + f.name;
    return names;
}

Judgement judge(const Cell& cell, double error) {
    if (!cell.ran())
        return {cell.failure == "refused" ? Verdict::refused : Verdict::error, cell.reason, 0};
    const Summary& s = cell.summary;
    const Verdict v = verdict_of(s, cell.scheme->balance, error);
    switch (v) {
        case Verdict::diverged:
        case Verdict::not_converged:
            return {v, fmt::format("at step {}", s.status.step), s.status.step};
        case Verdict::energy_gaining:
            return {v, fmt::format("{:.3g} of its energy gained", s.energy_gain), 0};
        case Verdict::adhesive:
            return {v,
                    fmt::format("pulls by {:.3g} of the largest contact force",
                                pull_of(s.smallest_contact_force, s.largest_contact_force)),
                    0};
        case Verdict::flagged: return {v, flags_of(s).front().sentence, 0};
        case Verdict::unjudged:
            return {v, "no energy, no smallest contact force and no reference to judge it by", 0};
        // sound, inaccurate
        default: return {v, std::isnan(error) ? "" : fmt::format("error {:.3g}", error), 0};
    }
}

// ---- The true modes are those of van Walstijn et al. 2016, eqs 17-18 (scenes/modes.hpp). Leaves
// out: strings against an obstacle, whose partials do not stay as they are.

namespace {
using Signal = std::span<const double>;
constexpr double pi = std::numbers::pi;
constexpr double negligible = 1e-2, most_of_it = 0.5, nearly_all = 0.1;
constexpr int most_partials = 12;
constexpr double periods = 60;  // of the first mode, that partials are sought in
constexpr long furthest = 64;   // rows early or late

double norm(Signal x) {
    double sum = 0;
    for (const double v : x) sum += v * v;
    return std::sqrt(sum);
}
// || x[n + late] - factor r[n] || over the rows but `margin` at both ends
double miss(Signal x, Signal r, long late, double factor, long margin = 0) {
    double sum = 0;
    const long rows = static_cast<long>(r.size());
    for (long n = margin; n < rows - margin; ++n) sum += std::pow(x[n + late] - factor * r[n], 2);
    return std::sqrt(sum);
}

struct MatchedPartial {  // of a partial
    Partial run, reference;
};
std::vector<MatchedPartial> partials(const String& s, Signal run, Signal reference, double rate) {
    std::vector<MatchedPartial> all;
    const int count = std::min(most_partials, modes_below(s, 0.25 * rate));
    if (count == 0) return all;
    const Modes modes = modes_of(s, count);
    const auto heard = static_cast<std::size_t>(periods * rate * 2 * pi / modes.omega0[0]);
    run = run.first(std::min(run.size(), heard));
    reference = reference.first(run.size());
    for (int i = 0; i < count; ++i) {
        const double square = omega_squared_damped(modes.omega0[i], modes.sigma[i]);
        if (!(square > 0)) continue;
        const double near = std::sqrt(square) / (2 * pi), apart = modes.omega0[0] / (2 * pi);
        const MatchedPartial p{strongest_near(run, rate, near, 0.4 * apart),
                               strongest_near(reference, rate, near, 0.4 * apart)};
        if (p.run.amplitude > 0 && p.reference.amplitude > 0) all.push_back(p);
    }
    return all;
}

// What the reference errs by where its partials have the run's frequencies, or its decays.
double err_by(const std::vector<MatchedPartial>& all, double rate, std::size_t rows, bool tune,
              bool decay) {
    double sum = 0;
    for (std::size_t n = 0; n < rows; ++n) {
        const double t = static_cast<double>(n) / rate;
        const auto part = [t](const Partial& p, double hertz, double decays) {
            return p.amplitude * std::exp(-decays * t) * std::cos(2 * pi * hertz * t + p.phase);
        };
        double off = 0;
        for (const auto& [run, r] : all)
            off += part(r, tune ? run.frequency : r.frequency, decay ? run.decay : r.decay) -
                   part(r, r.frequency, r.decay);
        sum += off * off;
    }
    return std::sqrt(sum);
}

std::string out_of_tune(const std::vector<MatchedPartial>& all, bool by_tune) {
    std::vector<double> off;
    std::string tunes, decays;
    for (const auto& [run, r] : all) {
        const double tune = cents(run.frequency, r.frequency), decay = run.decay - r.decay;
        off.push_back(by_tune ? tune : decay);
        tunes += fmt::format(" {:+.1f}", tune);
        decays += fmt::format(" {:+.2g}", decay);
    }
    const auto middle = off.begin() + static_cast<long>(off.size() / 2);
    std::ranges::nth_element(off, middle);
    return (by_tune ? fmt::format("is out of tune, {:.1f} cents {}", std::abs(*middle),
                                  *middle < 0 ? "flat" : "sharp")
                    : fmt::format("decays too {} by {:.2g} 1/s", *middle < 0 ? "slowly" : "fast",
                                  std::abs(*middle))) +
           fmt::format(": its first {} partials are off by{} cents and{} 1/s", all.size(), tunes,
                       decays);
}

// How many rows the run comes late; the fraction by the slope of the reference.
double lateness(Signal x, Signal r) {
    double least = HUGE_VAL;
    long late = 0;
    const long far = std::min(furthest, static_cast<long>(r.size()) / 8);
    for (long k = -far; k <= far; ++k)
        if (const double now = miss(x, r, k, 1, far + 1); now < least) least = now, late = k;
    double along = 0, square = 0;
    for (long n = far + 1; n + far + 1 < static_cast<long>(r.size()); ++n) {
        const double slope = 0.5 * (r[n + 1] - r[n - 1]);
        along += (r[n] - x[n + late]) * slope;
        square += slope * slope;
    }
    return static_cast<double>(late) + std::clamp(square > 0 ? along / square : 0, -0.5, 0.5);
}

bool hears_partials(const Scene& scene, Quantity q) {  // of the string's own modes
    const String& s = scene.strings.front();
    return (q == Quantity::displacement || q == Quantity::velocity || q == Quantity::nut_force) &&
           scene.strings.size() == 1 && !s.has_contacts() && !s.thread && !s.polarisation;
}
}  // namespace

std::string cause_of(const Scene& scene, const Trace& run, const Trace& reference, int tap,
                     double from) {
    const double rate = run.tap_rate;
    const auto first = static_cast<std::size_t>(std::ceil(from * rate - 1e-9));
    if (run.rows != reference.rows || reference.rows < static_cast<long>(first) + 16) return "";
    const Signal x = run.column(tap).subspan(first), r = reference.column(tap).subspan(first);
    const double error = miss(x, r, 0, 1);
    if (!(error > negligible * norm(r)) || !std::isfinite(error)) return "";
    if (hears_partials(scene, scene.taps[tap].quantity))
        if (const std::vector<MatchedPartial> all = partials(scene.strings.front(), x, r, rate);
            !all.empty() && err_by(all, rate, r.size(), true, true) > most_of_it * error)
            return out_of_tune(all, err_by(all, rate, r.size(), true, false) >
                                        err_by(all, rate, r.size(), false, true));
    const double late = lateness(x, r), whole = std::round(late);
    double left = 0, all = 0;  // of the error once the run is moved back
    for (long n = 1; n + 1 < static_cast<long>(r.size()); ++n) {
        const long at = n + static_cast<long>(whole);
        if (at < 0 || at >= static_cast<long>(x.size())) continue;
        left += std::pow(x[at] - r[n] + (late - whole) * 0.5 * (r[n + 1] - r[n - 1]), 2);
        all += std::pow(x[n] - r[n], 2);
    }
    if (left < nearly_all * nearly_all * all)
        return fmt::format("comes {:.2f} rows {}, {:.3g} us", std::abs(late),
                           late > 0 ? "late" : "early", 1e6 * std::abs(late) / rate);
    double product = 0;
    for (std::size_t n = 0; n < r.size(); ++n) product += x[n] * r[n];
    const double factor = product / std::pow(norm(r), 2), size = std::abs(factor);
    if (miss(x, r, 0, factor) >= nearly_all * error) return "";
    if (size == 0) return "is 0 throughout";
    const std::string by = size > 1 ? fmt::format("is {:.3g} times too large", size)
                                    : fmt::format("is {:.3g} times too small", 1 / size);
    if (factor > 0) return by;
    return std::abs(size - 1) < 1e-3 ? "has the wrong sign" : "has the wrong sign and " + by;
}

}  // namespace jvari::bench::study

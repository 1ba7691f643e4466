// True modes are those of van Walstijn et al. 2016, eqs 17-18 (scenes/modes.hpp). Only free strings
// get a text about partials, because a string against an obstacle does not keep its partials.
#include "bench/study/cause.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "analysis/alignment.hpp"
#include "analysis/dispersion.hpp"
#include "analysis/spectrum.hpp"
#include "analysis/statistics.hpp"
#include "scenes/modes.hpp"

namespace jvari::bench::study {

namespace {
using Signal = std::span<const double>;
constexpr double pi = std::numbers::pi;
constexpr double negligible = 1e-2, most_of_it = 0.5, nearly_all = 0.1;
// share of the error left by a delay, because modes above half the rate alias
constexpr double of_a_delay = 0.2;
constexpr int most_partials = 12;
// length of signal for the search for partials, in periods of the first mode
constexpr double periods = 60;
constexpr double inaudible =
    // Relative to the strongest partial: weaker partials have a node at the tap or the start.
    1e-3;
constexpr double half_a_semitone = 50;  // [cents]
constexpr long furthest = 1024;         // rows early or late
constexpr double first_part = 50e-3;    // duration over which a string in contact is followed [s]

struct Compared {  // tap in the run and in the reference, from row `first` on
    const Scene& scene;
    const Tap& tap;
    double rate;
    std::size_t first;
    Signal whole_run, whole_reference;
    Signal run = whole_run.subspan(first), reference = whole_reference.subspan(first);
    const char* unit() const { return unit_of(tap.quantity); }
};

double norm(Signal x) {
    double sum = 0;
    for (const double v : x) sum += v * v;
    return std::sqrt(sum);
}
// || x - factor r - offset ||
double miss(Signal x, Signal r, double factor = 1, double offset = 0) {
    double sum = 0;
    for (std::size_t n = 0; n < r.size(); ++n) sum += std::pow(x[n] - factor * r[n] - offset, 2);
    return std::sqrt(sum);
}

// ---- Any tap

std::string still(const Compared& c, double error) {
    const Signal x = c.run;
    std::size_t from = x.size() - 1;
    while (from > 0 && x[from - 1] == x.back()) --from;
    if (miss(x.subspan(from), c.reference.subspan(from)) < most_of_it * error ||
        x.size() - from < 16)
        return "";
    if (from == 0) return x.back() == 0 ? "is 0 throughout" : "stands still throughout";
    return fmt::format("stands still from row {} on, {:.4g} s", c.first + from,
                       static_cast<double>(c.first + from) / c.rate);
}

std::string factor(const Compared& c, double error) {
    const Signal x = c.run, r = c.reference;
    double product = 0;
    for (std::size_t n = 0; n < r.size(); ++n) product += x[n] * r[n];
    const double factor = product / std::pow(norm(r), 2), size = std::abs(factor);
    if (size == 0 || miss(x, r, factor) >= nearly_all * std::min(error, size * norm(r))) return "";
    const double ratio = std::max(size, 1 / size);
    std::string by = fmt::format("is {:.4g} times too {}", ratio, size > 1 ? "large" : "small");
    if (std::abs(ratio / 1000 - 1) < 1e-2)
        by += size > 1 ? fmt::format(", as m{0} in place of {0} are", c.unit())
                       : fmt::format(", as {0} in place of m{0} are", c.unit());
    if (factor > 0) return by;
    return std::abs(size - 1) < 1e-3 ? "has the wrong sign" : "has the wrong sign and " + by;
}

std::string offset(const Compared& c, double error) {
    double sum = 0;
    for (std::size_t n = 0; n < c.run.size(); ++n) sum += c.run[n] - c.reference[n];
    const double by = sum / static_cast<double>(c.run.size());
    if (miss(c.run, c.reference, 1, by) >= nearly_all * error) return "";
    return fmt::format("is off by {:+.3g} {} throughout, an offset", by, c.unit());
}

std::string delay(const Compared& c) {
    const Alignment a = delayed(c.run, c.reference, furthest);
    if (a.left >= of_a_delay) return "";
    return fmt::format("comes {:.2f} rows {}, {:.3g} us", std::abs(a.late),
                       a.late > 0 ? "late" : "early", 1e6 * std::abs(a.late) / c.rate);
}

std::string tuning_text(double off_cents) {
    return fmt::format("is out of tune, {:.1f} cents {}", std::abs(off_cents),
                       off_cents < 0 ? "flat" : "sharp");
}
std::string decay_text(double off) {
    return fmt::format("{} by {:.2g} 1/s", off < 0 ? too_slowly : "decays too fast", std::abs(off));
}

std::string other_clock(const Compared& c) {
    const std::size_t rows =
        std::min(c.whole_run.size(), c.first + static_cast<std::size_t>(first_part * c.rate) + 1);
    const Signal x = c.whole_run.first(rows), r = c.whole_reference.first(rows);
    const Alignment a = stretched(x, r, c.first);
    if (a.left >= most_of_it) return "";
    const bool by_tune = left_by(x, r, c.first, a.stretch, 0) < left_by(x, r, c.first, 0, a.decay);
    return (by_tune ? tuning_text(1200 * std::log2(1 + a.stretch)) : decay_text(a.decay * c.rate)) +
           fmt::format(" over its first {:.0f} ms",
                       1e3 * static_cast<double>(rows - c.first - 1) / c.rate);
}

// ---- A free string

struct MatchedPartial {
    int number;
    Partial run, reference;
};
Signal for_partials(Signal x, double rate, double lowest) {  // lowest [Hz]
    return x.first(std::min(x.size(), static_cast<std::size_t>(periods * rate / lowest)));
}
double first_frequency(const String& s) {  // [Hz]
    return modes_of(s, 1).omega0[0] / (2 * pi);
}

// Partials that sound at the tap in both traces. The search in the run starts from the frequency
// ratio found for the preceding partial, because at another rate a partial may lie beyond its
// neighbours.
std::vector<MatchedPartial> partials(const Compared& c) {
    const String& s = c.scene.strings.front();
    std::vector<MatchedPartial> all;
    const int count = std::min(most_partials, modes_below(s, 0.25 * c.rate));
    if (count == 0) return all;
    const Modes modes = modes_of(s, count);
    const double apart = first_frequency(s);
    const Signal x = for_partials(c.run, c.rate, apart),
                 r = for_partials(c.reference, c.rate, apart);
    double strongest = 0;
    for (int i = 0; i < count; ++i) {
        const double square = omega_squared_damped(modes.omega0[i], modes.sigma[i]);
        if (!(square > 0)) continue;
        all.push_back(
            {i + 1, {}, strongest_near(r, c.rate, std::sqrt(square) / (2 * pi), 0.4 * apart)});
        if (all.back().reference.amplitude > strongest) strongest = all.back().reference.amplitude;
    }
    const auto silent = [strongest](const Partial& p) {
        return !(p.amplitude > inaudible * strongest);
    };
    std::erase_if(all, [&](const MatchedPartial& p) { return silent(p.reference); });
    double ratio = 1;
    for (MatchedPartial& p : all) {
        p.run = strongest_near(x, c.rate, ratio * p.reference.frequency, 0.4 * apart);
        if (!silent(p.run)) ratio = p.run.frequency / p.reference.frequency;
    }
    std::erase_if(all, [&](const MatchedPartial& p) { return silent(p.run); });
    return all;
}

// Error of the reference after giving its partials the run's frequencies, or the run's decays.
double err_by(const std::vector<MatchedPartial>& all, double rate, std::size_t rows, bool tune,
              bool decay) {
    double sum = 0;
    for (std::size_t n = 0; n < rows; ++n) {
        const double t = static_cast<double>(n) / rate;
        const auto part = [t](const Partial& p, double hertz, double decays) {
            return p.amplitude * std::exp(-decays * t) * std::cos(2 * pi * hertz * t + p.phase);
        };
        double off = 0;
        for (const auto& [number, run, r] : all)
            off += part(r, tune ? run.frequency : r.frequency, decay ? run.decay : r.decay) -
                   part(r, r.frequency, r.decay);
        sum += off * off;
    }
    return std::sqrt(sum);
}

// Text about tuning or decay. If a partial deviates from the median by more than half a semitone,
// there is no common tuning, and the text says so.
std::string partials_text(const std::vector<MatchedPartial>& all, bool by_tune) {
    std::vector<double> tune, decay;
    std::vector<int> numbers;
    std::string tunes, decays;
    for (const auto& [number, run, r] : all) {
        tune.push_back(cents(run.frequency, r.frequency));
        decay.push_back(run.decay - r.decay);
        numbers.push_back(number);
        tunes += fmt::format(" {:+.1f}", tune.back());
        decays += fmt::format(" {:+.2g}", decay.back());
    }
    const double middle = spread_of(tune).median;
    const bool alike = std::ranges::all_of(
        tune, [&](double one) { return std::abs(one - middle) <= half_a_semitone; });
    const std::string which = numbers.back() == static_cast<int>(numbers.size())
                                  ? fmt::format("its first {} partials", numbers.size())
                                  : fmt::format("its partials {}", fmt::join(numbers, ", "));
    return (!by_tune ? decay_text(spread_of(decay).median)
            : alike  ? tuning_text(middle)
                     : "is out of tune, each partial by another interval") +
           fmt::format(": {} are off by{} cents and{} 1/s", which, tunes, decays);
}

std::string tuning(const Compared& c, double error) {
    const std::vector<MatchedPartial> all = partials(c);
    const auto by = [&](bool tune, bool decay) {
        return err_by(all, c.rate, c.run.size(), tune, decay);
    };
    if (all.empty() || !(by(true, true) > most_of_it * error)) return "";
    return partials_text(all, by(true, false) > by(false, true));
}

// Power near the odd partials and near the even ones (within a quarter of the distance), and
// between them.
struct Shares {
    double odd = 0, even = 0, all = 0;
    double between() const { return all - odd - even; }
};
Shares shares_of(Signal x, const Compared& c) {
    const String& s = c.scene.strings.front();
    const int count = modes_below(s, 0.5 * c.rate);
    if (count < 2) return {};
    const Modes modes = modes_of(s, count);
    const auto hertz = [&](int i) { return i == 0 ? 0 : modes.omega0[i - 1] / (2 * pi); };
    const PowerSpectrum p = power_spectrum(x, c.rate);
    Shares shares{0, 0, power_between(p, 0.25 * hertz(1), hertz(count))};
    for (int i = 1; i < count; ++i)
        (i % 2 == 1 ? shares.odd : shares.even) += power_between(
            p, 0.75 * hertz(i) + 0.25 * hertz(i - 1), 0.75 * hertz(i) + 0.25 * hertz(i + 1));
    return shares;
}

// Partials halfway between the string's belong to a string an octave lower, or to a string with a
// free end. A run without the odd partials sounds an octave high.
std::string octave(const Compared& c) {
    const Shares x = shares_of(c.run, c), r = shares_of(c.reference, c);
    if (x.between() > most_of_it * x.all && r.between() < nearly_all * r.all)
        return std::string("sounds an octave low: its partials lie halfway between the string's") +
               (x.odd + x.even < nearly_all * x.between()
                    ? ", at odd multiples of half the first alone, as of a string with a free end"
                    : "");
    return x.odd < negligible * x.even && r.odd > nearly_all * r.all
               ? "sounds an octave high: it has every second partial alone"
               : "";
}

// Text if the run's first partials match the reference and the partials above are missing.
std::string few_partials(const Compared& c) {
    const String& s = c.scene.strings.front();
    std::vector<double> apart;
    for (std::size_t n = 0; n < c.run.size(); ++n) apart.push_back(c.run[n] - c.reference[n]);
    const PowerSpectrum off = power_spectrum(apart, c.rate), x = power_spectrum(c.run, c.rate),
                        r = power_spectrum(c.reference, c.rate);
    const int count = modes_below(s, 0.5 * c.rate);
    if (count < 2) return "";
    const Modes modes = modes_of(s, count);
    const double all = power_between(off, 0, HUGE_VAL), few = nearly_all * nearly_all;
    double below = 0, from = 0, edge = 0;
    int has = 0;
    for (int i = 0; i + 1 < count; ++i) {
        const double to = 0.25 / pi * (modes.omega0[i] + modes.omega0[i + 1]);
        below += power_between(off, from, to);
        if (below > few * all) break;
        has = i + 1, edge = from = to;
    }
    if (has == 0 || !(power_between(x, edge, HUGE_VAL) < few * power_between(r, edge, HUGE_VAL)))
        return "";
    return fmt::format("has {} partials: it lacks those above {:.3g} kHz, which the reference has",
                       has, edge / 1000);
}

bool hears_partials(const Scene& scene, Quantity q) {  // partials of the string's own modes
    const String& s = scene.strings.front();
    return (q == Quantity::displacement || q == Quantity::velocity || q == Quantity::nut_force) &&
           scene.strings.size() == 1 && !s.has_contacts() && !s.thread && !s.polarisation;
}
}  // namespace

std::string cause_of(const Scene& scene, const Trace& run, const Trace& reference, int tap,
                     double from) {
    const auto first = static_cast<std::size_t>(std::ceil(from * run.tap_rate - 1e-9));
    if (run.rows != reference.rows || reference.rows < static_cast<long>(first) + 16) return "";
    const Compared c{scene,           scene.taps[static_cast<std::size_t>(tap)],
                     run.tap_rate,    first,
                     run.column(tap), reference.column(tap)};
    const double error = miss(c.run, c.reference);
    if (!(error > negligible * norm(c.reference)) || !std::isfinite(error)) return "";
    for (const auto cause : {still, factor, offset})
        if (std::string text = cause(c, error); !text.empty()) return text;
    if (std::string text = delay(c); !text.empty()) return text;
    if (!hears_partials(scene, c.tap.quantity)) return other_clock(c);
    if (std::string text = octave(c); !text.empty()) return text;
    if (std::string text = tuning(c, error); !text.empty()) return text;
    return few_partials(c);
}

}  // namespace jvari::bench::study

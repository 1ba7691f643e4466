#include "analysis/ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/spectrum.hpp"
#include "analysis/statistics.hpp"

namespace jvari {

namespace {
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double range = 100;                                            // of bands below the strongest [dB]
constexpr double least_level = 0.1, least_decay = 1, least_tone = 0.01;  // [dB], [dB/s], of the centroid
constexpr int quarters = 4, window = 2048, hop = 512;

double power_of(std::span<const double> bins) {
    return std::accumulate(bins.begin(), bins.end(), 0.0);
}

double median_of(const std::vector<double>& values) {
    return spread_of(values).median;
}
}  // namespace

std::vector<Trait> traits_of(std::span<const double> signal, double rate) {
    std::vector<Trait> all;
    const Bands whole = third_octaves(signal, rate);
    const auto half = signal.size() / 2;
    const Bands first = third_octaves(signal.first(half), rate), last = third_octaves(signal.subspan(half), rate);
    const double between = 0.5 * signal.size() / rate;  // of the middles of the two halves [s]
    double strongest = -std::numeric_limits<double>::infinity();
    for (const double level : whole.level) strongest = std::max(strongest, level);
    const auto level_at = [](const Bands& b, double centre) {
        for (std::size_t k = 0; k < b.centre.size(); ++k)
            if (std::abs(b.centre[k] / centre - 1) < 1e-6) return b.level[k];
        return nan;
    };
    for (std::size_t k = 0; k < whole.centre.size(); ++k) {
        const bool sounds = whole.level[k] > strongest - range;
        all.push_back({"third_octave_db", whole.centre[k], sounds ? whole.level[k] : nan, least_level});
        const double fall = (level_at(first, whole.centre[k]) - level_at(last, whole.centre[k])) / between;
        all.push_back({"decay_db_per_s", whole.centre[k], sounds && std::isfinite(fall) ? fall : nan, least_decay});
    }
    const Spectrogram s = spectrogram(signal, rate, window, hop);
    const auto track = centroid_track(s);
    for (int q = 0; q < quarters; ++q) {
        double sum = 0, weight = 0;
        for (int m = q * s.frames / quarters; m < (q + 1) * s.frames / quarters; ++m) {
            const double power = power_of(s.frame(m));
            if (std::isfinite(track[m])) sum += power * track[m], weight += power;
        }
        const double centroid = weight > 0 ? sum / weight : nan;
        all.push_back({"centroid_hz", (q + 0.5) / quarters * signal.size() / rate, centroid, least_tone * std::abs(centroid)});
    }
    return all;
}

double two_sample_p(std::vector<double> a, std::vector<double> b) {
    if (a.empty() || b.empty()) return 1;
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    const double n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
    double distance = 0;
    for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
        const double x = std::min(a[i], b[k]);
        while (i < a.size() && a[i] <= x) ++i;
        while (k < b.size() && b[k] <= x) ++k;
        distance = std::max(distance, std::abs(i / n - k / m));
    }
    const double root = std::sqrt(n * m / (n + m)), lambda = (root + 0.12 + 0.11 / root) * distance;
    if (lambda < 0.2) return 1;  // the series is 1 to 1e-12 there, and slow
    double p = 0;
    for (int j = 1; j <= 100; ++j) p += (j % 2 ? 2 : -2) * std::exp(-2.0 * j * j * lambda * lambda);
    return std::clamp(p, 0.0, 1.0);
}

std::vector<bool> discoveries(const std::vector<double>& p, double rate) {
    std::vector<double> sorted = p;
    std::sort(sorted.begin(), sorted.end());
    double bound = -1;
    for (std::size_t k = 0; k < sorted.size(); ++k)
        if (sorted[k] <= rate * static_cast<double>(k + 1) / static_cast<double>(sorted.size())) bound = sorted[k];
    std::vector<bool> found;
    for (const double one : p) found.push_back(one <= bound);
    return found;
}

std::vector<Told> told_apart(const std::vector<std::vector<Trait>>& candidates, const std::vector<std::vector<Trait>>& references) {
    std::vector<Told> all;
    if (candidates.empty() || references.empty()) return all;
    const auto column = [](const std::vector<std::vector<Trait>>& runs, std::size_t f) {
        std::vector<double> values;
        for (const auto& run : runs)
            if (f < run.size() && std::isfinite(run[f].value)) values.push_back(run[f].value);
        return values;
    };
    std::vector<double> probabilities;
    for (std::size_t f = 0; f < references[0].size(); ++f) {
        const auto mine = column(candidates, f), theirs = column(references, f);
        if (2 * theirs.size() <= references.size()) continue;  // a band that does not sound
        Told t{references[0][f], median_of(mine), 0, false};
        t.reference.value = median_of(theirs);
        if (!(std::abs(t.candidate - t.reference.value) <= t.reference.least)) t.p = two_sample_p(mine, theirs);
        else t.p = 1;
        if (mine.size() * 2 <= candidates.size()) t.p = 0;  // it sounds there alone
        all.push_back(t);
        probabilities.push_back(t.p);
    }
    const auto found = discoveries(probabilities, false_alarms);
    for (std::size_t k = 0; k < all.size(); ++k) all[k].apart = found[k];
    return all;
}

}  // namespace jvari

#include "analysis/alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace jvari {

namespace {
using Signal = std::span<const double>;
constexpr long reach = 16;        // rows on either side for interpolation between rows
constexpr long seek_rows = 8192;  // number of rows for the search of a whole delay
constexpr std::size_t most_delays = 8;
constexpr double much_better = 0.25;  // ratio to the remaining square at a smaller delay
constexpr double furthest_stretch = 0.125;

// Weights for rows -15 ... 16 that give the value at row fraction `part`, 0 <= part < 1.
std::array<double, 2 * reach> weights_at(double part) {
    std::array<double, 2 * reach> w{};
    if (part == 0) {
        w[reach - 1] = 1;
        return w;
    }
    const double s = std::sin(std::numbers::pi * part) / std::numbers::pi;
    for (long j = 1 - reach; j <= reach; ++j) {
        const double d = static_cast<double>(j) - part,
                     taper = std::cos(0.5 * std::numbers::pi * d / reach);
        w[static_cast<std::size_t>(j + reach - 1)] = (j % 2 == 0 ? -s : s) / d * taper * taper;
    }
    return w;
}

double sum_at(Signal r, long row, const std::array<double, 2 * reach>& w) {
    double sum = 0;
    for (long j = 1 - reach; j <= reach; ++j)
        sum += w[static_cast<std::size_t>(j + reach - 1)] * r[static_cast<std::size_t>(row + j)];
    return sum;
}

double squared(double x) { return x * x; }

// || x - r moved by `late` ||^2 over the rows from ... to - 1
double moved_miss(Signal x, Signal r, double late, long from, long to) {
    const double whole = std::floor(-late);
    const auto w = weights_at(-late - whole);
    double sum = 0;
    for (long n = from; n < to; ++n)
        sum += squared(x[static_cast<std::size_t>(n)] - sum_at(r, n + static_cast<long>(whole), w));
    return sum;
}

// Minimum of a function about `x` by a parabola through x - h, x and x + h.
template <class Of>
double vertex(double x, double h, Of of) {
    const double a = of(x - h), b = of(x), c = of(x + h), curve = a - 2 * b + c;
    return curve > 0 ? x + std::clamp(0.5 * h * (a - c) / curve, -h, h) : a < c ? x - h : x + h;
}

// Value between rows, by the cubic of Catmull and Rom: for the search alone.
double cubic(Signal r, double at) {
    const long k = static_cast<long>(at);
    const double f = at - static_cast<double>(k);
    const double* p = r.data() + k;
    return p[0] + 0.5 * f *
                      (p[1] - p[-1] +
                       f * (2 * p[-1] - 5 * p[0] + 4 * p[1] - p[2] +
                            f * (3 * (p[0] - p[1]) + p[2] - p[-1])));
}

// Rows on which a stretch is judged: rows whose place in the reference has all neighbours.
struct Judged {
    long from, to;
};
Judged rows_of(Signal r, std::size_t first, long rows, double stretch) {
    const double last = static_cast<double>(r.size()) - 1 - reach;
    return {std::max(static_cast<long>(first), reach + reach / 4),
            std::min(rows, static_cast<long>(last / (1 + std::max(0.0, stretch))))};
}

template <class Value>
double stretched_miss(Signal x, Judged rows, double stretch, double decay, Value value) {
    double sum = 0;
    const double each = std::exp(-decay);
    double level = std::exp(-decay * static_cast<double>(rows.from));
    for (long n = rows.from; n < rows.to; ++n, level *= each)
        sum += squared(x[static_cast<std::size_t>(n)] -
                       level * value(static_cast<double>(n) * (1 + stretch)));
    return sum;
}

// Gauss-Newton for the decay at a given stretch.
double decay_at(Signal x, Signal r, Judged rows, double stretch, double decay) {
    const double most = 3 / static_cast<double>(std::max(1L, rows.to));
    for (int step = 0; step < 3; ++step) {
        double along = 0, square = 0;
        for (long n = rows.from; n < rows.to; ++n) {
            const double t = static_cast<double>(n),
                         z = std::exp(-decay * t) * cubic(r, t * (1 + stretch));
            along += (z - x[static_cast<std::size_t>(n)]) * t * z;
            square += squared(t * z);
        }
        if (square > 0) decay = std::clamp(decay + along / square, -most, most);
    }
    return decay;
}
}  // namespace

namespace {
// Whole delays with a better fit than their neighbours and than no delay: the smallest ones, and
// the best.
std::vector<long> fitting_delays(Signal run, Signal reference, long far, long from, long to) {
    std::vector<double> miss;
    for (long k = -far; k <= far; ++k) {
        double sum = 0;
        for (long n = from; n < to; ++n)
            sum += squared(run[static_cast<std::size_t>(n + k)] -
                           reference[static_cast<std::size_t>(n)]);
        miss.push_back(sum);
    }
    const auto at = [&](long k) { return miss[static_cast<std::size_t>(k + far)]; };
    std::vector<long> all;
    for (long k = 0; k <= far && all.size() < most_delays; ++k)
        for (const long one : {k, -k}) {
            const bool least =
                (one == far || at(one) <= at(one + 1)) && (one == -far || at(one) <= at(one - 1));
            if (least && at(one) <= at(0)) all.push_back(one);
            if (k == 0) break;
        }
    all.push_back(std::min_element(miss.begin(), miss.end()) - miss.begin() - far);
    return all;
}
}  // namespace

Alignment delayed(Signal run, Signal reference, long furthest) {
    const long rows = static_cast<long>(std::min(run.size(), reference.size())),
               far = std::min(furthest, rows / 8), margin = far + reach + 2;
    Alignment found;
    if (rows < 2 * margin + 16) return found;
    const long end = std::min(rows - margin, margin + seek_rows);
    const auto miss = [&](double by) { return moved_miss(run, reference, by, margin, end); };
    double least = HUGE_VAL;
    for (const long whole : fitting_delays(run, reference, far, margin, end)) {
        double late = static_cast<double>(whole);
        for (const double h : {0.5, 0.2, 0.05, 0.01}) late = vertex(late, h, miss);
        if (const double now = miss(late); now < much_better * least)
            least = now, found.late = late;
    }
    const long own = static_cast<long>(std::abs(found.late)) + reach + 2;
    const double whole = moved_miss(run, reference, 0, own, rows - own);
    if (whole > 0)
        found.left = std::sqrt(moved_miss(run, reference, found.late, own, rows - own) / whole);
    return found;
}

double left_by(Signal run, Signal reference, std::size_t first, double stretch, double decay) {
    const long size = static_cast<long>(std::min(run.size(), reference.size()));
    const Judged rows = rows_of(reference, first, size, stretch);
    const auto between = [reference](double at) {
        const double whole = std::floor(at);
        return sum_at(reference, static_cast<long>(whole), weights_at(at - whole));
    };
    const double all = stretched_miss(run, rows, 0, 0, between);
    return all > 0 ? std::sqrt(stretched_miss(run, rows, stretch, decay, between) / all) : 1;
}

Alignment stretched(Signal run, Signal reference, std::size_t first) {
    const long size = static_cast<long>(std::min(run.size(), reference.size()));
    const auto value = [reference](double at) { return cubic(reference, at); };
    Alignment found;
    double range = furthest_stretch;
    for (long rows = static_cast<long>(first) + 64;; rows *= 2) {
        const long most = std::min(rows, size);
        const double h = 0.5 / static_cast<double>(most);
        const Judged judged = rows_of(reference, first, most, furthest_stretch);
        if (judged.to - judged.from < 16) return {};
        double least = HUGE_VAL, best = found.stretch;
        const long steps = static_cast<long>(std::ceil(range / h));
        for (long k = -steps; k <= steps; ++k) {
            const double at = found.stretch + h * static_cast<double>(k);
            if (std::abs(at) > furthest_stretch) continue;
            const double miss = stretched_miss(run, judged, at, found.decay, value);
            if (miss < least) least = miss, best = at;
        }
        found.stretch = vertex(best, 0.5 * h, [&](double at) {
            return stretched_miss(run, judged, at, found.decay, value);
        });
        found.decay = decay_at(run, reference, judged, found.stretch, found.decay);
        range = 2 * h;
        if (rows >= size) break;
    }
    found.left = left_by(run, reference, first, found.stretch, found.decay);
    return found;
}

}  // namespace jvari

#include "tests/reference/bernstein.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

double value(const double* c, int count, double x) {
    double v = 0;
    for (int n = count - 1; n >= 0; --n) v = v * x + c[n];
    return v;
}

double slope(const double* c, int count, double x) {
    double v = 0;
    for (int n = count - 1; n >= 1; --n) v = v * x + n * c[n];
    return v;
}

namespace {
struct Piece {
    double from, width;
    double c[longest_series];
};

// Bernstein coefficients on [0, 1]: b_i = sum_k binomial(i, k)/binomial(degree, k) c_k, all weights in [0, 1].
void to_bernstein(const double* c, int count, double* b) {
    const int degree = count - 1;
    double binomial = 1;
    for (int k = 0; k <= degree; ++k) {
        b[k] = c[k] / binomial;
        binomial *= static_cast<double>(degree - k) / (k + 1);
    }
    for (int k = 1; k <= degree; ++k)
        for (int i = degree; i >= k; --i) b[i] += b[i - 1];
}

void split(Piece& left, Piece& right, int count) {  // de Casteljau at the middle; `left` holds the whole
    right.width = left.width *= 0.5;
    right.from = left.from + left.width;
    for (int k = 0; k < count; ++k) {
        right.c[count - 1 - k] = left.c[count - 1];
        for (int i = count - 1; i > k; --i) left.c[i] = 0.5 * (left.c[i] + left.c[i - 1]);
    }
}

// Newton kept inside [low, high], value >= 0 at low and < 0 at high.
double root_between(const double* c, int count, double low, double high) {
    double x = 0.5 * (low + high);
    for (int i = 0; i < 100; ++i) {
        const double v = value(c, count, x), step = v / slope(c, count, x);
        if (v == 0 || std::abs(step) <= 1e-16 * x) break;
        (v < 0 ? high : low) = x;
        const double next = x - step, middle = 0.5 * (low + high);
        if (middle == low || middle == high) break;
        x = next > low && next < high ? next : middle;
    }
    return x;
}
}  // namespace

double first_negative(const double* c, int count, double bound) {
    while (count > 0 && *c == 0) ++c, --count;
    if (count == 0) return 2;
    if (c[0] < 0) return 0;
    double lowest = c[0];
    for (int n = 1; n < count; ++n) lowest -= std::max(0.0, -c[n]);
    if (lowest >= -bound) return 2;

    constexpr double narrowest = 0x1p-54;  // below the rounding of x
    Piece stack[56];
    int top = 0;
    stack[0].from = 0;
    stack[0].width = 1;
    to_bernstein(c, count, stack[0].c);
    while (top >= 0) {
        Piece& piece = stack[top];
        if (*std::min_element(piece.c, piece.c + count) >= -bound) {
            --top;
            continue;
        }
        int changes = 0, sign = 0;
        bool negative_first = false;
        for (int i = 0; i < count; ++i) {
            const int s = (piece.c[i] > 0) - (piece.c[i] < 0);
            if (s == 0) continue;
            if (sign == 0) negative_first = s < 0;
            else if (s != sign) ++changes;
            sign = s;
        }
        if (negative_first || piece.width < narrowest) return piece.from;
        if (changes == 1) return root_between(c, count, piece.from, piece.from + piece.width);
        const Piece whole = piece;
        stack[top + 1] = whole;
        split(stack[top + 1], stack[top], count);  // left piece on top, right one below it
        ++top;
    }
    return 2;
}

}  // namespace jvari

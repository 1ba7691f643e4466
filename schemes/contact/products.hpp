// Products with small matrices stored by columns. They use vectors of rows, because compilers would
// otherwise use scalars in case the arrays overlap. The summation order in a row is the same
// whatever the compiler knows.
#pragma once

namespace jvari {

// `lanes` rows in to = M x, or in to = from + M x. stride: from one column of M to the next
template <int lanes, bool add>
[[gnu::always_inline]] inline void product_of_lanes(const double* M, int stride, const double* x,
                                                    int columns, const double* from,
                                                    double* to) noexcept {
    using Lanes [[gnu::vector_size(8 * lanes), gnu::aligned(8), gnu::may_alias]] = double;
    Lanes even = {}, odd = {};  // two sums hide the latency of adding
    if constexpr (add) even = *reinterpret_cast<const Lanes*>(from);
    int c = 0;
    for (; c + 1 < columns; c += 2) {
        even += *reinterpret_cast<const Lanes*>(M + c * stride) * x[c];
        odd += *reinterpret_cast<const Lanes*>(M + (c + 1) * stride) * x[c + 1];
    }
    if (c < columns) even += *reinterpret_cast<const Lanes*>(M + c * stride) * x[c];
    *reinterpret_cast<Lanes*>(to) = even + odd;
}

// rows: known to the compiler, or 0 and given at the end
template <int rows, bool add = false>
[[gnu::always_inline]] inline void product(const double* M, const double* x, int columns,
                                           double* to, int some_rows = rows,
                                           const double* from = nullptr) noexcept {
    const int n = rows > 0 ? rows : some_rows;
    const double* base = add ? from : to;
    int r = 0;
    for (; r + 8 <= n; r += 8) product_of_lanes<8, add>(M + r, n, x, columns, base + r, to + r);
    if (n & 4) product_of_lanes<4, add>(M + r, n, x, columns, base + r, to + r), r += 4;
    if (n & 2) product_of_lanes<2, add>(M + r, n, x, columns, base + r, to + r), r += 2;
    if (n & 1) product_of_lanes<1, add>(M + r, n, x, columns, base + r, to + r);
}
template <int rows>
[[gnu::always_inline]] inline void add_product(const double* M, const double* x, int columns,
                                               double* to, int some_rows = rows) noexcept {
    product<rows, true>(M, x, columns, to, some_rows, to);
}

}  // namespace jvari

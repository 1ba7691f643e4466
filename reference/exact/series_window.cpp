#include "reference/exact/series_window.hpp"

#include <algorithm>
#include <cmath>

namespace jvari {

namespace {
// out = m x, m [n][n]
void times(const std::vector<double>& m, int n, const double* x, double* out) {
    for (int i = 0; i < n; ++i) {
        out[i] = 0;
        for (int j = 0; j < n; ++j) out[i] += m[i * n + j] * x[j];
    }
}
constexpr int most_states = 16, most_terms_of_exponential = 200;
}  // namespace

SeriesWindow::SeriesWindow(const InSeries& s, double seconds, int derivatives, int moments)
    : states_(s.states),
      points_(s.points),
      derivatives_(derivatives),
      moments_(moments),
      A_(s.A),
      B_(s.B) {
    for (auto* m : {&A_, &B_})
        for (double& x : *m) x *= seconds;
    free_.assign(static_cast<std::size_t>(points_) * derivatives * states_, 0.0);
    push_.assign(static_cast<std::size_t>(states_) * points_ * moments, 0.0);
    std::vector<double> column(states_), next(states_);
    for (int j = 0; j < states_; ++j) {  // A^n for a unit state
        std::fill(column.begin(), column.end(), 0.0);
        column[j] = 1;
        for (int n = 0; n < derivatives; ++n, column.swap(next)) {
            for (int a = 0; a < points_; ++a)
                free_[(static_cast<std::size_t>(a) * derivatives + n) * states_ + j] = column[a];
            times(A_, states_, column.data(), next.data());
        }
    }
    for (int a = 0; a < points_; ++a) {
        for (int j = 0; j < states_; ++j) column[j] = B_[j * points_ + a];
        for (int n = 0; n < moments; ++n, column.swap(next)) {
            for (int j = 0; j < states_; ++j)
                push_[(static_cast<std::size_t>(j) * points_ + a) * moments + n] = column[j];
            times(A_, states_, column.data(), next.data());
        }
    }
}

void SeriesWindow::add_free(int point, const double* z, double* derivatives) const noexcept {
    const double* row = free_.data() + static_cast<std::size_t>(point) * derivatives_ * states_;
    for (int n = 0; n < derivatives_; ++n)
        for (int j = 0; j < states_; ++j) derivatives[n] += *row++ * z[j];
}

void SeriesWindow::move(double at, const double* from, const double* const* moments,
                        double* to) const noexcept {
    double sum[most_states], term[most_states], next[most_states];
    std::copy_n(from, states_, sum);
    std::copy_n(from, states_, term);
    // e^(A at) by its series
    for (int n = 1; n < most_terms_of_exponential; ++n, std::copy_n(next, states_, term)) {
        times(A_, states_, term, next);
        double size = 0, all = 0;
        for (int j = 0; j < states_; ++j) {
            next[j] *= at / n;
            sum[j] += next[j];
            size += std::abs(next[j]);
            all += std::abs(sum[j]);
        }
        if (size <= 1e-18 * all) break;
    }
    for (int a = 0; a < points_; ++a) {
        if (!moments[a]) continue;
        for (int j = 0; j < states_; ++j) {
            const double* row =
                push_.data() + (static_cast<std::size_t>(j) * points_ + a) * moments_;
            for (int n = 0; n < moments_; ++n) sum[j] += row[n] * moments[a][n];
        }
    }
    std::copy_n(sum, states_, to);
}

void SeriesWindow::speed(const double* z, const double* F, double* out) const noexcept {
    times(A_, states_, z, out);
    for (int j = 0; j < states_; ++j)
        for (int a = 0; a < points_; ++a) out[j] += B_[j * points_ + a] * F[a];
}

std::vector<double> series_kernel(const InSeries& s, double rate, int point, int force, int count) {
    std::vector<double> h, column(s.states), next(s.states);
    for (int j = 0; j < s.states; ++j) column[j] = s.B[j * s.points + force] / rate;
    for (int n = 0; n < count; ++n, column.swap(next)) {
        h.push_back(column[point]);
        times(s.A, s.states, column.data(), next.data());
        for (double& x : next) x /= rate;
    }
    return h;
}

}  // namespace jvari

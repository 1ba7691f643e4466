#include "reference/exact/touching_set.hpp"

#include <algorithm>
#include <cmath>

#include "reference/exact/macro_window.hpp"

namespace jvari {

void TouchingSet::solve(const double* r, double* path, std::complex<double>* amplitude) noexcept {
    const MacroWindow& w = *window_;
    const int P = static_cast<int>(points_.size()), N = w.terms, stride = w.stride, size = w.size;
    const auto combine = w.sweep().combine;
    for (int a = 0; pairs_ == 0 && a < w.contacts; ++a) {
        double* out = path + a * stride;
        const bool touches = std::find(points_.begin(), points_.end(), a) != points_.end();
        if (!touches) std::copy_n(r + a * stride, size, out);
        for (int b = 0; b < P; ++b)
            (touches && b == 0 ? w.sweep().combined : combine)(
                out, size, r + points_[b] * stride, N,
                resolvent_.data() + (static_cast<std::size_t>(a) * P + b) * N * size, size);
    }
    if (pairs_ == 0) return;
    for (int a = 0; a < P; ++a) {
        double* out = path + points_[a] * stride;
        std::fill_n(out, size, 0.0);
        for (int b = 0; b < P; ++b)
            combine(out, size, r + points_[b] * stride + order_, N - order_,
                    inverse_.data() + (static_cast<std::size_t>(b) * P + a) * size,
                    static_cast<long>(P) * P * size);
    }
    for (int k = 0; k < 2 * pairs_; ++k) {
        double sum = 0;
        for (int b = 0; b < P; ++b) {
            const double *rb = r + points_[b] * stride, *pb = path + points_[b] * stride;
            sum += start_[k * 2 * P + b] * (rb[0] - pb[0]) +
                   start_[k * 2 * P + P + b] * (rb[1] - pushed_at_once_[b] * rb[0] - pb[1]);
        }
        beta_[k] = k % 2 == 0 ? sum : -sum;
    }
    const auto add_pairs = [&](int a) {
        combine(path + a * stride, size, beta_.data(), 2 * pairs_,
                slow_.data() + static_cast<std::size_t>(a) * pairs_ * 2 * size, size);
        for (int k = 0; k < pairs_; ++k)
            amplitude[a * pairs_ + k] =
                std::complex<double>(beta_[2 * k], -beta_[2 * k + 1]) * shape_[a * pairs_ + k];
    };
    for (int a : points_) add_pairs(a);
    if (P == w.contacts) return;
    for (int a = 0; a < w.contacts; ++a) {
        if (std::find(points_.begin(), points_.end(), a) != points_.end()) continue;
        double* out = path + a * stride;
        std::copy_n(r + a * stride, size, out);
        for (int b = 0; b < P; ++b) {
            double pushed[most_terms];
            for (int n = 0; n < N; ++n) pushed[n] = -k_[b] * path[points_[b] * stride + n];
            combine(out, size, pushed, N, w.kernel(a, points_[b]) - 1, -1);  // h^(n-1-m) F^(m)
        }
        add_pairs(a);
    }
}

double TouchingSet::force(int which, const double* path, const std::complex<double>* amplitude,
                          double u) const noexcept {
    const int a = points_[which];
    double now[3];
    window_->sweep().evaluate(path + a * window_->stride, window_->size, u, now);
    for (int k = 0; k < pairs_; ++k)
        now[0] += (amplitude[a * pairs_ + k] * std::exp(rate_[k] * u)).real();
    return -k_[which] * now[0];
}

void TouchingSet::moments(int which, const double* path, const std::complex<double>* amplitude,
                          double u, int count, double* m) const noexcept {
    const int a = points_[which], size = window_->size;
    double e[3 * most_terms];
    powers(u, 2 * size + 1, e);
    window_->sweep().combined(
        m, size, path + a * window_->stride,
        span_ == 1 && pairs_ > 0 ? std::min(window_->terms, count + 2) : window_->terms, e + 1, 1);
    // X_i = int (u - w)^i/i! e^(lambda w) dw = (X_(i-1) - u^i/i!)/lambda
    for (int k = 0; k < pairs_; ++k) {
        const std::complex<double> inverse = 1.0 / rate_[k], c = amplitude[a * pairs_ + k];
        const double size_now = std::exp(rate_[k].real() * u), phase = rate_[k].imag() * u;
        double re = size_now * std::cos(phase), im = size_now * std::sin(phase);
        for (int i = 0; i < count; ++i) {
            const double x = re - e[i], y = im;
            re = x * inverse.real() - y * inverse.imag();
            im = x * inverse.imag() + y * inverse.real();
            m[i] += c.real() * re - c.imag() * im;
        }
    }
    for (int i = 0; i < size; ++i) m[i] *= -k_[which];
}

}  // namespace jvari

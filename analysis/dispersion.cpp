// Source: Hua & Sarkar 1990, "Matrix pencil method for estimating parameters of exponentially
// damped/undamped sinusoids in noise"; Van Huffel, Chen, Decanniere & Van Hecke 1994 (HTLS); see
// dispersion.hpp for the zoom in front of it.
#include "analysis/dispersion.hpp"

#include <gsl/gsl_sf_bessel.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "schemes/trace.hpp"

namespace jvari {

namespace {
using Complex = std::complex<double>;
using std::numbers::pi;

// side lobes at -150 dB, first zero at 6.45/T for a window of T seconds
constexpr double kaiser_shape = 20;
constexpr double main_lobe = 6.45;  // sqrt(1 + (shape/pi)^2)
constexpr long most_rows = 320;     // of the thinned signal: the pencil costs their cube
// singular values below this share of the largest are rounding
constexpr double rounding_margin = 1e-13;
// and below this many medians noise: white noise takes the lobe's shape, 70 from the lobe's top to
// its median over the thinned band (5 half widths), times the scatter of the largest of them
constexpr double noise_margin = 350;
// a partial below this share of the signal's largest value may be what the side lobes let in
constexpr double leakage = 1e-7;

std::vector<double> kaiser(long n) {
    std::vector<double> w(n);
    for (long j = 0; j < n; ++j) {
        const double u = (2.0 * j + 1) / n - 1;
        w[j] = gsl_sf_bessel_I0_scaled(kaiser_shape * std::sqrt(1 - u * u)) *
               std::exp(kaiser_shape * (std::sqrt(1 - u * u) - 1));
    }
    return w;
}

// z[m] = sum_j w[j] x[m step + j] exp(-i centre (m step + j)): the band around `centre` [rad/row],
// moved to 0 and thinned out.
Eigen::VectorXcd zoom(std::span<const double> x, const std::vector<double>& w, double centre,
                      long step, long rows) {
    Eigen::VectorXcd z(rows);
    std::vector<double> real(w.size()), imaginary(w.size());  // w[j] exp(-i centre j)
    for (std::size_t j = 0; j < w.size(); ++j) {
        real[j] = w[j] * std::cos(centre * static_cast<double>(j));
        imaginary[j] = -w[j] * std::sin(centre * static_cast<double>(j));
    }
    for (long m = 0; m < rows; ++m) {
        double re = 0, im = 0;
        for (std::size_t j = 0; j < w.size(); ++j) {
            re += real[j] * x[m * step + j];
            im += imaginary[j] * x[m * step + j];
        }
        z[m] = Complex(re, im) * std::polar(1.0, -centre * static_cast<double>(m * step));
    }
    return z;
}

// Poles of z[m] = sum c_k p_k^m: the row space of the Hankel matrix, less its last and its first
// entry, differs by diag(p).
Eigen::VectorXcd poles_of(const Eigen::VectorXcd& z) {
    const long width = z.size() / 2, height = z.size() - width + 1;
    Eigen::MatrixXcd hankel(height, width);
    for (long c = 0; c < width; ++c) hankel.col(c) = z.segment(c, height);
    // BDCSVD compiles for 40 s; only in noise is it faster
    const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(hankel, Eigen::ComputeThinU);
    const auto& s = svd.singularValues();
    const double floor = std::max(rounding_margin * s[0], noise_margin * s[width / 2]);
    const long order = std::min<long>((s.array() > floor).count(), width / 2);
    if (!(s[0] > 0) || order == 0) return {};
    const Eigen::MatrixXcd u = svd.matrixU().leftCols(order);
    const Eigen::MatrixXcd shift =
        u.topRows(height - 1).colPivHouseholderQr().solve(u.bottomRows(height - 1));
    return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(shift, false).eigenvalues();
}

// least squares on the Vandermonde matrix
Eigen::VectorXcd amplitudes_of(const Eigen::VectorXcd& z, const Eigen::VectorXcd& poles) {
    Eigen::MatrixXcd powers(z.size(), poles.size());
    powers.row(0).setOnes();
    for (long m = 1; m < z.size(); ++m)
        powers.row(m) = powers.row(m - 1).cwiseProduct(poles.transpose());
    return powers.colPivHouseholderQr().solve(z);
}
}  // namespace

std::vector<Partial> partials_between(std::span<const double> signal, double rate, double from,
                                      double to) {
    if (!std::all_of(signal.begin(), signal.end(), [](double v) { return std::isfinite(v); }))
        return {};
    if (!(to > from) || !(rate > 0)) return {};
    // [rad/row], [Hz]
    const double centre = pi * (from + to) / rate, half_width = 0.5 * (to - from);
    // the window's zero at twice the half width
    const long taps = static_cast<long>(std::ceil(main_lobe * rate / (2 * half_width)));
    // the lobe is 4 half widths wide
    const long step = std::max(1L, static_cast<long>(rate / (5 * half_width)));
    const long rows = std::min(most_rows, (static_cast<long>(signal.size()) - taps) / step + 1);
    if (static_cast<long>(signal.size()) < taps || rows < 8) return {};

    const std::vector<double> w = kaiser(taps);
    const Eigen::VectorXcd z = zoom(signal, w, centre, step, rows);
    const Eigen::VectorXcd poles = poles_of(z);
    if (poles.size() == 0) return {};
    const Eigen::VectorXcd amplitudes = amplitudes_of(z, poles);

    double largest = 0;
    for (double v : signal) largest = std::max(largest, std::abs(v));
    std::vector<Partial> partials;
    for (long k = 0; k < poles.size(); ++k) {
        // per row, relative to the centre
        const Complex exponent = std::log(poles[k]) / static_cast<double>(step);
        // of the zoom for this pole
        Complex gain = 0;
        for (long j = 0; j < taps; ++j) gain += w[j] * std::exp(exponent * static_cast<double>(j));
        // a real partial shows one of its two exponentials
        const Complex amplitude = 2.0 * amplitudes[k] / gain;
        const double frequency = (centre + exponent.imag()) * rate / (2 * pi);
        if (frequency <= from || frequency >= to || std::abs(amplitude) < leakage * largest)
            continue;
        partials.push_back(
            {frequency, -exponent.real() * rate, std::abs(amplitude), std::arg(amplitude)});
    }
    std::sort(partials.begin(), partials.end(),
              [](const Partial& a, const Partial& b) { return a.frequency < b.frequency; });
    return partials;
}

Partial strongest_near(std::span<const double> signal, double rate, double guess,
                       double half_width) {
    Partial strongest{nan, nan, 0, nan};
    for (const Partial& p : partials_between(signal, rate, guess - half_width, guess + half_width))
        if (p.amplitude > strongest.amplitude) strongest = p;
    return strongest;
}

double cents(double frequency, double reference) { return 1200 * std::log2(frequency / reference); }

}  // namespace jvari

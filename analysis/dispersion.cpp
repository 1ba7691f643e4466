// Source: Hua & Sarkar 1990, "Matrix pencil method for estimating parameters of exponentially
// damped/undamped sinusoids in noise"; Van Huffel, Chen, Decanniere & Van Hecke 1994 (HTLS); see
// dispersion.hpp for the zoom in front of it.
#include "analysis/dispersion.hpp"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sf_bessel.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "schemes/trace.hpp"

namespace jvari {

namespace {
using Complex = std::complex<double>;
using std::numbers::pi;

// side lobes at -150 dB, first zero at 6.45/T for a window of T seconds
constexpr double kaiser_shape = 20;
constexpr double main_lobe = 6.45;  // sqrt(1 + (shape/pi)^2)
constexpr long most_rows = 640;     // in the thinned signal: the pencil costs their cube
// singular values below this share of the largest are rounding
constexpr double rounding_margin = 1e-13;
// noise if below this many medians: white noise takes the lobe's shape, 70 from the lobe's top to
// its median over half the thinned band (5 half widths), times the scatter of its largest value
constexpr double noise_margin = 350;
// a partial below this share of the signal's largest value may be leakage through the side lobes
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

// y[m] = Re sum_j w[j] x[m step + j] exp(i pi m/2 - i centre (m step + j)): the band around
// `centre` [rad/row], moved to a quarter of the thinned rate.
std::vector<double> zoom(std::span<const double> x, const std::vector<double>& w, double centre,
                         long step, long rows) {
    std::vector<double> y(rows);
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
        const double turned = pi / 2 * static_cast<double>(m % 4) - centre * (m * step);
        y[m] = re * std::cos(turned) - im * std::sin(turned);
    }
    return y;
}

// Poles of y[m] = sum Re c_k p_k^m above the real axis. The column space of the Hankel matrix
// without its first row equals the space without its last row times a matrix with the poles as
// eigenvalues.
std::vector<Complex> poles_of(std::span<const double> y) {
    const std::size_t width = y.size() / 2, height = y.size() - width + 1;
    std::vector<double> hankel(height * width), right(width * width), values(width), work(width);
    for (std::size_t r = 0; r < height; ++r)
        std::copy_n(y.begin() + r, width, hankel.begin() + r * width);
    gsl_matrix_view u = gsl_matrix_view_array(hankel.data(), height, width);
    gsl_matrix_view v = gsl_matrix_view_array(right.data(), width, width);
    gsl_vector_view s = gsl_vector_view_array(values.data(), width);
    gsl_vector_view scratch = gsl_vector_view_array(work.data(), width);
    if (gsl_linalg_SV_decomp(&u.matrix, &v.matrix, &s.vector, &scratch.vector) != GSL_SUCCESS)
        return {};
    const double floor = std::max(rounding_margin * values[0], noise_margin * values[width / 2]);
    const std::size_t order = std::ranges::count_if(values, [&](double x) { return x > floor; });
    if (!(values[0] > 0) || order == 0) return {};

    // (U'U)^-1 U' D, U without its last row r and D without the first: U'U = I - r r'
    const gsl_matrix_view U = gsl_matrix_submatrix(&u.matrix, 0, 0, height - 1, order);
    const gsl_matrix_view D = gsl_matrix_submatrix(&u.matrix, 1, 0, height - 1, order);
    const gsl_vector_view r = gsl_matrix_subrow(&u.matrix, height - 1, 0, order);
    std::vector<double> product(order * order), sums(order), found(2 * order);
    gsl_matrix_view shift = gsl_matrix_view_array(product.data(), order, order);
    gsl_vector_view sum = gsl_vector_view_array(sums.data(), order);
    double square = 0;
    gsl_blas_ddot(&r.vector, &r.vector, &square);
    gsl_blas_dgemm(CblasTrans, CblasNoTrans, 1, &U.matrix, &D.matrix, 0, &shift.matrix);
    gsl_blas_dgemv(CblasTrans, 1 / (1 - square), &shift.matrix, &r.vector, 0, &sum.vector);
    gsl_blas_dger(1, &r.vector, &sum.vector, &shift.matrix);

    gsl_vector_complex_view eigenvalues = gsl_vector_complex_view_array(found.data(), order);
    const std::unique_ptr<gsl_eigen_nonsymm_workspace, decltype(&gsl_eigen_nonsymm_free)> solver(
        gsl_eigen_nonsymm_alloc(order), gsl_eigen_nonsymm_free);
    if (gsl_eigen_nonsymm(&shift.matrix, &eigenvalues.vector, solver.get()) != GSL_SUCCESS)
        return {};
    std::vector<Complex> poles;
    for (std::size_t k = 0; k < order; ++k)
        if (found[2 * k + 1] > 0) poles.emplace_back(found[2 * k], found[2 * k + 1]);
    return poles;
}

// c_k by least squares
std::vector<Complex> amplitudes_of(std::span<const double> y, const std::vector<Complex>& poles) {
    const std::size_t rows = y.size(), columns = 2 * poles.size();
    std::vector<double> powers(rows * columns), tau(columns), c(columns), left(rows);
    for (std::size_t k = 0; k < poles.size(); ++k) {
        Complex power = 1;
        for (std::size_t m = 0; m < rows; ++m, power *= poles[k]) {
            powers[m * columns + 2 * k] = power.real();
            powers[m * columns + 2 * k + 1] = -power.imag();
        }
    }
    gsl_matrix_view qr = gsl_matrix_view_array(powers.data(), rows, columns);
    gsl_vector_view t = gsl_vector_view_array(tau.data(), columns);
    const gsl_vector_const_view b = gsl_vector_const_view_array(y.data(), rows);
    gsl_vector_view x = gsl_vector_view_array(c.data(), columns);
    gsl_vector_view residual = gsl_vector_view_array(left.data(), rows);
    gsl_linalg_QR_decomp(&qr.matrix, &t.vector);
    gsl_linalg_QR_lssolve(&qr.matrix, &t.vector, &b.vector, &x.vector, &residual.vector);
    std::vector<Complex> amplitudes;
    for (std::size_t k = 0; k < columns; k += 2) amplitudes.emplace_back(c[k], c[k + 1]);
    return amplitudes;
}
}  // namespace

std::vector<Partial> partials_between(std::span<const double> signal, double rate, double from,
                                      double to) {
    if (!std::all_of(signal.begin(), signal.end(), [](double v) { return std::isfinite(v); }))
        return {};
    if (!(to > from) || !(to - from <= rate / 5)) return {};
    // [rad/row], [Hz]
    const double centre = pi * (from + to) / rate, half_width = 0.5 * (to - from);
    // the window's zero at twice the half width
    const long taps = static_cast<long>(std::ceil(main_lobe * rate / (2 * half_width)));
    // the lobe is 4 half widths wide, and so is its image below 0 Hz
    const long step = std::max(1L, static_cast<long>(rate / (10 * half_width)));
    const long rows = std::min(most_rows, (static_cast<long>(signal.size()) - taps) / step + 1);
    if (static_cast<long>(signal.size()) < taps || rows < 16) return {};
    // the default handler would end the program if an iteration does not converge
    gsl_set_error_handler_off();

    const std::vector<double> w = kaiser(taps);
    const std::vector<double> y = zoom(signal, w, centre, step, rows);
    const std::vector<Complex> poles = poles_of(y);
    if (poles.empty()) return {};
    const std::vector<Complex> amplitudes = amplitudes_of(y, poles);

    double largest = 0;
    for (double v : signal) largest = std::max(largest, std::abs(v));
    std::vector<Partial> partials;
    for (std::size_t k = 0; k < poles.size(); ++k) {
        // per row, relative to the centre
        const Complex exponent = std::log(poles[k] / Complex(0, 1)) / static_cast<double>(step);
        // gain of the zoom for this pole
        Complex gain = 0;
        for (long j = 0; j < taps; ++j) gain += w[j] * std::exp(exponent * static_cast<double>(j));
        // a real partial shows one of its two exponentials
        const Complex amplitude = 2.0 * amplitudes[k] / gain;
        const double frequency = (centre + exponent.imag()) * rate / (2 * pi);
        if (frequency <= from || frequency >= to || !(std::abs(amplitude) >= leakage * largest))
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

#include "reference/exact/oscillators.hpp"

#include <algorithm>
#include <cmath>

#include "reference/partial_sums.hpp"

namespace jvari {

namespace {
double largest_eigenvalue(const Modes& m) {  // largest root of s^2 + 2 sigma s + omega0^2
    double rate = 0;
    for (int i = 0; i < m.count(); ++i) {
        const double over = -omega_squared_damped(m.omega0[i], m.sigma[i]);
        rate = std::max(rate, over > 0 ? m.sigma[i] + std::sqrt(over) : m.omega0[i]);
    }
    return rate;
}
}  // namespace

Oscillators::Oscillators(const Modes& m)
    : padded((m.count() + lanes - 1) / lanes * lanes), rate(largest_eigenvalue(m)) {
    for (int i = 0; i < m.count(); ++i) {
        a.push_back(2 * m.sigma[i] / rate);
        b.push_back((m.omega0[i] / rate) * (m.omega0[i] / rate));
    }
    a.resize(padded, 0.0);
    b.resize(padded, 0.0);
}

std::vector<double> Oscillators::pad(std::vector<double> row, double factor) const {
    for (double& x : row) x *= factor;
    row.resize(padded, 0.0);
    return row;
}

JVARI_CLONES
void series(const Oscillators& osc, const double* y, const double* u, const double* weights,
            int outputs, int terms, double* p, int stride, double* bound, double* scratch) {
    Lanes* sum = reinterpret_cast<Lanes*>(scratch);  // [output][term], the bound last
    std::fill_n(scratch, outputs * (terms + 1) * lanes, 0.0);
    const int n_modes = osc.padded;
    for (int o = 0; o < outputs; ++o, sum += terms + 1) {
        for (int i = 0; i < n_modes; i += lanes) {
            const Lanes a = *reinterpret_cast<const Lanes*>(&osc.a[i]),
                        b = *reinterpret_cast<const Lanes*>(&osc.b[i]);
            const Lanes g = *reinterpret_cast<const Lanes*>(weights + o * n_modes + i);
            Lanes d0 = g * *reinterpret_cast<const Lanes*>(y + i),
                  d1 = g * *reinterpret_cast<const Lanes*>(u + i);
            sum[terms] += (d0 < 0 ? -d0 : d0) + (d1 < 0 ? -d1 : d1);
            for (int n = 0; n < terms; ++n) {  // y^(n+2) = -a y^(n+1) - b y^(n)
                sum[n] += d0;
                const Lanes next = -(a * d1 + b * d0);
                d0 = d1;
                d1 = next;
            }
        }
        for (int n = 0; n <= terms; ++n) (n < terms ? p[o * stride + n] : bound[o]) = total(sum[n]);
    }
}

JVARI_CLONES
void fly(const Oscillators& osc, const double* y, const double* u, double t, int terms,
         const double* const* gains, const double* moments, int forces, int stride, double* y_out,
         double* u_out) {
    constexpr int longest = 64;
    double tau[longest];  // t^n/n!
    tau[0] = 1;
    for (int n = 1; n < terms; ++n) tau[n] = tau[n - 1] * t / n;
    const int n_modes = osc.padded;
    for (int i = 0; i < n_modes; i += lanes) {
        const Lanes a = *reinterpret_cast<const Lanes*>(&osc.a[i]),
                    b = *reinterpret_cast<const Lanes*>(&osc.b[i]);
        const Lanes y0 = *reinterpret_cast<const Lanes*>(y + i),
                    u0 = *reinterpret_cast<const Lanes*>(u + i);
        Lanes Y = {}, U = {};
        for (int n = terms - 1; n >= 0; --n) {
            Lanes f = {};
            for (int j = 0; j < forces; ++j)
                f += *reinterpret_cast<const Lanes*>(gains[j] + i) * moments[j * stride + n];
            const Lanes pull = a * U + b * Y;
            Y = U + y0 * tau[n];
            U = (u0 * tau[n] + f) - pull;
        }
        *reinterpret_cast<Lanes*>(y_out + i) = Y;
        *reinterpret_cast<Lanes*>(u_out + i) = U;
    }
}

JVARI_CLONES
double dot(const Oscillators& osc, const double* x, const double* y) {
    Lanes sum = {};
    for (int i = 0; i < osc.padded; i += lanes)
        sum += *reinterpret_cast<const Lanes*>(x + i) * *reinterpret_cast<const Lanes*>(y + i);
    return total(sum);
}

int terms_for(double z, double tolerance, int limit) {
    int n = 2;
    double term = z * z;
    while (n < limit && !(z < n && term < tolerance * (1 - z / n))) term *= z / n++;
    return n;
}

}  // namespace jvari

// The modal two-point scheme of van Walstijn et al. 2016 (eqs 33, 38-52), in plain C++.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "jvari_scheme.hpp"

struct PlainTwoPoint {
    explicit PlainTwoPoint(const jvari_problem& problem) : p(problem) {
        for (int64_t i = 0; i < p.modes; ++i) {
            const double R = std::exp(-p.sigma[i] * dt),
                         square = p.omega0[i] * p.omega0[i] - p.sigma[i] * p.sigma[i];
            const double twice = 2 * R *
                                 (square > 0 ? std::cos(std::sqrt(square) * dt)
                                             : std::cosh(std::sqrt(-square) * dt));
            a.push_back((1 - twice + R * R) / (1 + twice + R * R));
            b.push_back(2 * (1 - R * R) / (1 + twice + R * R));  // (33)
            J.push_back(1 + a[i] + b[i]);
            e_b.push_back(xi / J[i] * g_b[i]), e_c.push_back(xi / J[i] * g_c[i]);
        }
        theta_bc = dot(g_b, e_c), inverse = 1 / (1 + phi_c * dot(g_c, e_c)),
        beta_c = phi_c * theta_bc * inverse;
        theta = dot(g_b, e_b) - beta_c * theta_bc;  // (47), (48)
    }
    void reset() {
        y.assign(p.start, p.start + p.modes), q = u = none, n = 0;
        mean_b = mean_c = supplied = lost = 0;
    }
    int64_t dofs() const { return 2 * p.modes; }
    int advance(const jvari_rows& out) {
        for (int64_t row = 0; row < out.rows; ++row) {
            for (int64_t k = 0; k < out.taps; ++k)
                out.tap[k * out.stride + row] =
                    tap(p.tap_quantities[k], p.tap_weights + k * p.modes);
            if (double* energy = out.energy ? out.energy + row : nullptr)
                energy[0] = stored(), energy[out.stride] = supplied, energy[2 * out.stride] = lost;
            mean_b = mean_c = supplied = lost = 0;
            for (int64_t step = 0; step < p.steps_per_row; ++step, ++n) advance_a_step();
        }
        return JVARI_OK;
    }
    // bridge, thread and driving force; velocity; displacement, nut force
    double tap(const char* of, const double* w) const {
        const bool driving = of[0] == 'd' && of[1] == 'r';
        return driving      ? -mean_b - mean_c
               : *of == 'b' ? mean_b
               : *of == 't' ? mean_c
               : *of == 'v' ? 2 / dt * dot(w, q)
                            : dot(w, y);
    }
    void advance_a_step() {
        const double F_e = (pluck(n) + pluck(n + 1)) / 2;
        // (42)
        for (int64_t i = 0; i < p.modes; ++i)
            u[i] = (2 * (q[i] - a[i] * y[i]) + xi * g_e[i] * F_e) / J[i];
        const double v =
            (p.thread_stiffness * (p.thread_height - dot(g_c, y)) - phi_c * dot(g_c, u)) * inverse;
        const double F_b = contact(dot(g_b, y), -dot(g_b, u) - theta_bc * v),
                     F_c = v - beta_c * F_b;
        // (40), (41)
        for (int64_t i = 0; i < p.modes; ++i)
            u[i] += e_b[i] * F_b + e_c[i] * F_c, y[i] += u[i], q[i] = u[i] - q[i],
                                                               lost += b[i] * u[i] * u[i] / xi;
        lost += p.thread_damping / dt * dot(g_c, u) * dot(g_c, u);  // (51), (52)
        supplied += F_e * dot(g_e, u);
        mean_b += F_b / double(p.steps_per_row), mean_c += F_c / double(p.steps_per_row);
    }
    double stored() const {  // (49)
        const double d_b = p.contacts ? std::max(0.0, *p.contact_height - dot(g_b, y)) : 0,
                     d_c = p.threads ? p.thread_height - dot(g_c, y) : 0;
        double sum = p.thread_stiffness * d_c * d_c / 2;
        if (p.contacts) sum += *p.contact_stiffness * d_b * d_b / 2;
        for (int64_t i = 0; i < p.modes; ++i) sum += (q[i] * q[i] + a[i] * y[i] * y[i]) / xi;
        return sum;
    }
    double contact(double y_b, double b) const {  // r + b = theta F (48), the four cases of fig 4
        const double d = p.contacts ? *p.contact_height - y_b : 0,
                     phi = p.contacts ? theta * *p.contact_stiffness / 2 : 0;
        if (phi == 0 || (d <= 0 && d + b <= 0)) return 0;
        if (d > 0 && d * (1 - phi) + b > 0) return (2 * phi * d + phi * b) / (1 + phi) / theta;
        if (d > 0) return (b + std::sqrt(b * b + 4 * phi * d * d)) / 2 / theta;
        return (b -
                (b - 2 * phi * d + std::sqrt(b * b - 4 * phi * d * (b + d))) / (2 * (1 + phi))) /
               theta;
    }
    static double dot(const double* g, const std::vector<double>& y) {
        return std::inner_product(y.begin(), y.end(), g, 0.0);
    }
    double pluck(int64_t at) const { return at < p.pluck_samples ? p.pluck_force[at] : 0; }
    const jvari_problem& p;
    double dt = 1 / p.sample_rate, xi = dt * dt / (2 * p.modal_mass),
           phi_c = p.thread_stiffness / 2 + p.thread_damping / dt;
    double theta_bc = 0, inverse = 1, beta_c = 0, theta = 0, mean_b = 0, mean_c = 0, supplied = 0,
           lost = 0;
    std::vector<double> a{}, b{}, J{}, e_b{}, e_c{}, y{}, q{}, u{},
        none = std::vector<double>(std::size_t(p.modes));
    const double *g_b = p.contacts ? p.contact_weights : none.data(),
                 *g_c = p.threads ? p.thread_weights : none.data();
    const double* g_e = p.plucks ? p.pluck_weights : none.data();
    int64_t n = 0;
};
JVARI_SCHEME(PlainTwoPoint, "plain_two_point", "van Walstijn et al. 2016, eqs 38-52, as printed",
             "bending stiffness, damping, frequency-dependent damping, lumped barrier, thread, "
             "initial shape, pluck",
             "exact")

// First-order equations for all strings of a scene on a moving body, for an integrator. They
// combine string_equations.hpp for every string with the body's equations, coupled by the inertia
// that schemes/body/body_step.hpp derives. Per mode, on strings and body,
//
//     p_i' = omega_i v_i,   m_i v_i' = -m_i (omega_i p_i + 2 sigma_i v_i) + G_i - mu_i a,
//     sum over strings of (mu L/3 a + sum mu_i v_i') in G
//
// with a = w''. The mass matrix is diagonal except for the body's rank. With A_i the accelerations
// for a fixed body and A_k the body's accelerations for fixed strings, b = sum 1/M_k and S = sum
// mu_i^2/m_i,
//
//     f = g - sum mu_i A_i - (sum mu L/3 - S) a,   a = sum A_k + b f,
//     g = -(sum T/L) w + sum e_p F_p + sum psi(x_e) F_e,
//
// one equation for a; then v_k' = A_k + f/M_k and v_i' = A_i - mu_i a/m_i.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "reference/integrator.hpp"
#include "reference/readout.hpp"
#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/pitch.hpp"
#include "schemes/contact/contact.hpp"

namespace jvari {

struct InstrumentEquations final : Equations {
    // Takes strings without profiles, and the modes of each.
    InstrumentEquations(const std::vector<String>& all, const std::vector<Modes>& modes,
                        const std::vector<BodyMode>& body_modes) {
        std::vector<Point> threads;
        for (int k = 0; k < static_cast<int>(all.size()); ++k) {
            const String& s = all[k];
            OfString own{static_cast<int>(omega_.size()), modes[k].count(), modes[k].mass,
                         end_inertia(modes[k], s), s.pluck};
            own.bridge = 2 * k;
            own.thread = 2 * k + 1;
            for (int i = 0; i < own.count; ++i) {
                omega_.push_back(modes[k].omega0[i]);
                damping_.push_back(2 * modes[k].sigma[i]);
                mass_.push_back(own.mass);
                rest_ -= own.mu[i] * own.mu[i] / own.mass;
            }
            inertia_ += s.linear_density * s.length / 3;
            tension_ += s.tension / s.length;
            for (const Barrier& barrier : s.barriers) {
                const auto& b = std::get<LumpedBarrier>(barrier);
                points.push_back({k,
                                  footprint_weights(modes[k], b.position, b.width),
                                  -b.position / s.length,
                                  {b.stiffness.k, b.exponent},
                                  b.contact_loss,
                                  0,
                                  b.height,
                                  b.loss_law == LossLaw::clipped});
            }
            if (const auto& c = s.thread)
                threads.push_back({k,
                                   footprint_weights(modes[k], c->position, c->width),
                                   -c->position / s.length,
                                   {c->stiffness, 1},
                                   0,
                                   c->damping,
                                   c->height});
            if (s.pluck) {
                own.g_e = footprint_weights(modes[k], s.pluck->position, s.pluck->width);
                own.finger = 1 - s.pluck->position / s.length;
                least_scale_ += 1e-3 * std::abs(s.pluck->amplitude) / wave_impedance(s);
            }
            strings.push_back(std::move(own));
        }
        rest_ += inertia_;
        contacts = static_cast<int>(points.size());
        points.insert(points.end(), threads.begin(), threads.end());
        add_body(body_modes);
        padded = static_cast<int>(omega_.size());
        sums = 2 * static_cast<int>(strings.size()) + 2;
        touched.assign(contacts, 0);
        for (const Point& p : points) {
            double sum = p.e * p.e * give_;
            for (const double g : p.g) sum += g * g / strings[p.string].mass;
            compliance_.push_back(sum);
        }
    }

    struct OfString {
        int first = 0, count = 0;  // range of its modes
        double mass = 0;           // modal mass [kg]
        std::vector<double> mu;    // [kg]
        std::optional<Pluck> pluck = {};
        std::vector<double> g_e = {};
        double finger = 0;  // psi at the pluck
        bool plucked = false;
        int bridge = 0, thread = 0;  // indices of its impulses, among the sums
    };
    struct Point {
        int string;
        std::vector<double> g;
        double e;  // -x/L
        ContactLaw law;
        double beta, damping, height;
        bool clipped = false;
    };
    std::vector<OfString> strings;
    std::vector<Point> points;  // the contacts on all strings in turn, then the threads
    int body = 0;               // first body mode
    int sums = 0;               // 2 per string [N s], then supplied and dissipated [J]
    double time = 0;            // at t = 0 in the integrator's time [s]

    int size() const override { return 2 * padded + sums; }
    void slope(double t, const double* z, double* dz) const noexcept override {
        const double *p = z, *v = z + padded;
        double *dp = dz, *dv = dz + padded, *sum = dz + 2 * padded;
        std::fill_n(sum, sums, 0.0);
        double &supplied = sum[sums - 2], &dissipated = sum[sums - 1];
        for (int i = 0; i < padded; ++i) {
            dp[i] = omega_[i] * v[i];
            dv[i] = -(omega_[i] * p[i] + damping_[i] * v[i]);
            dissipated += mass_[i] * damping_[i] * v[i] * v[i];
        }
        double g = -tension_ * w(z);
        for (int a = 0; a < static_cast<int>(points.size()); ++a) {
            if (!acts(a)) continue;
            const Point& point = points[a];
            const OfString& s = strings[point.string];
            const Pull f = pull(a, motion(point, z));
            for (int i = 0; i < s.count; ++i) dv[s.first + i] += f.F / s.mass * point.g[i];
            g += point.e * f.F;
            sum[a < contacts ? s.bridge : s.thread] += f.F;
            dissipated += f.lost;
        }
        for (const OfString& s : strings) {
            if (s.plucked) {
                const double F = jvari::force(
                    *s.pluck,
                    s.pluck->start + std::clamp(time + t - s.pluck->start, 0.0, s.pluck->duration));
                for (int i = 0; i < s.count; ++i) dv[s.first + i] += F / s.mass * s.g_e[i];
                g += s.finger * F;
                supplied +=
                    F * (weighted_sum(s.g_e.data(), v + s.first, s.count) + s.finger * w_speed(z));
            }
            g -= weighted_sum(s.mu.data(), dv + s.first, s.count);
        }
        double sum_A = 0;
        for (int k = body; k < padded; ++k) sum_A += dv[k];
        const double a = (sum_A + give_ * g) / (1 + give_ * rest_), f = g - rest_ * a;
        for (int k = body; k < padded; ++k) dv[k] += f / mass_[k];
        for (const OfString& s : strings)
            for (int i = 0; i < s.count; ++i) dv[s.first + i] -= a / s.mass * s.mu[i];
    }
    double penetration(int a, const double* z) const noexcept override {
        return points[a].height - motion(points[a], z).y;
    }
    double penetration_speed(int a, const double* z) const noexcept override {
        return -motion(points[a], z).v;
    }
    double contact_force(int a, const double* z) const noexcept override {
        return pull(a, motion(points[a], z)).F;
    }
    double scale_squared(const double* z) const noexcept override {
        double sum = 0, pressed = 0;
        for (int i = 0; i < 2 * padded; ++i) sum += z[i] * z[i];
        for (int a = 0; a < static_cast<int>(points.size()); ++a)
            if (acts(a)) {
                const double eta = points[a].height - motion(points[a], z).y;
                pressed += points[a].law.k / (points[a].law.alpha + 1) *
                           std::pow(std::abs(eta), points[a].law.alpha + 1);
            }
        return std::max(
            {sum, 2 * pressed / strings.front().mass, 2 * padded * least_scale_ * least_scale_});
    }
    // solves for the modes without their coupling
    void solve(double, double gamma, const double*, const double* b, double* x) noexcept override {
        std::copy_n(b, size(), x);
        for (int i = 0; i < padded; ++i) {  // the blocks [1, -gamma w; gamma w, 1 + 2 gamma sigma]
            const double w = gamma * omega_[i], damped = 1 + gamma * damping_[i], p = b[i],
                         v = b[padded + i];
            x[i] = (damped * p + w * v) / (damped + w * w);
            x[padded + i] = (v - w * p) / (damped + w * w);
        }
    }

    // Rate of the fastest motion [1/s]. The bound follows string_equations.cpp: an impact at speed
    // v reaches the depth m v^2/2 = k eta^(alpha+1)/(alpha+1), m = 1/compliance. Contacts on one
    // string push the same modes, those on two strings push the body: their stiffnesses add up.
    double pace(const double* z) const noexcept {
        double fastest = 0, springs = 0, dampers = 0;
        for (const double omega : omega_) fastest = std::max(fastest, omega);
        for (int a = 0; a < static_cast<int>(points.size()); ++a) {
            const Point& p = points[a];
            if (a >= contacts) {
                springs = std::max(springs, p.law.k * compliance_[a]);
                dampers = std::max(dampers, p.damping * compliance_[a]);
            }
        }
        double pressed = 0;
        for (int a = 0; a < contacts; ++a) {
            if (!touched[a]) continue;
            const double v = penetration_speed(a, z), k = points[a].law.k,
                         alpha = points[a].law.alpha;
            const double depth =
                std::max(penetration(a, z),
                         std::pow(v * v * (alpha + 1) / (2 * k * compliance_[a]), 1 / (alpha + 1)));
            pressed += alpha * k * std::pow(depth, alpha - 1) * compliance_[a];
        }
        return std::max(std::sqrt(fastest * fastest + springs + pressed), dampers);
    }
    double energy(const double* z) const noexcept {
        const double *p = z, *v = z + padded, speed = w_speed(z), at = w(z);
        double sum = 0.5 * inertia_ * speed * speed + 0.5 * tension_ * at * at;
        for (int i = 0; i < padded; ++i) sum += 0.5 * mass_[i] * (p[i] * p[i] + v[i] * v[i]);
        for (const OfString& s : strings)
            sum += speed * weighted_sum(s.mu.data(), v + s.first, s.count);
        for (int a = 0; a < static_cast<int>(points.size()); ++a) {
            const double eta = points[a].height - motion(points[a], z).y;
            if (a >= contacts) sum += 0.5 * points[a].law.k * eta * eta;
            else sum += points[a].law.potential(eta);
        }
        return sum;
    }
    double omega(int i) const { return omega_[i]; }
    double w(const double* z) const noexcept {
        double sum = 0;
        for (int k = body; k < padded; ++k) sum += z[k] / omega_[k];
        return sum;
    }
    double w_speed(const double* z) const noexcept {
        double sum = 0;
        for (int k = body; k < padded; ++k) sum += z[padded + k];
        return sum;
    }

private:
    void add_body(const std::vector<BodyMode>& body_modes) {
        body = static_cast<int>(omega_.size());
        for (const BodyMode& m : body_modes) {
            omega_.push_back(std::sqrt(m.stiffness / m.mass));
            damping_.push_back(m.damping / m.mass);
            mass_.push_back(m.mass);
            give_ += 1 / m.mass;
        }
    }

    struct Motion {
        double y, v;
    };
    InstrumentEquations::Motion motion(const Point& p, const double* z) const noexcept {
        const int first = strings[p.string].first;
        double y = 0;
        for (std::size_t i = 0; i < p.g.size(); ++i) y += p.g[i] * z[first + i] / omega_[first + i];
        return {y + p.e * w(z),
                weighted_sum(p.g.data(), z + padded + first, static_cast<int>(p.g.size())) +
                    p.e * w_speed(z)};
    }
    struct Pull {
        double F, lost;  // [N], [W]
    };
    InstrumentEquations::Pull pull(int a, Motion m) const noexcept {
        const Point& p = points[a];
        const double eta = p.height - m.y;
        if (a >= contacts) return {p.law.k * eta - p.damping * m.v, p.damping * m.v * m.v};
        const double f =
            // odd: a trial may overshoot
            p.law.alpha == 1 ? p.law.k * eta
                             : p.law.k * std::pow(std::abs(eta), p.law.alpha - 1) * eta;
        const double give = 1 - p.beta * m.v, F = f * (p.clipped ? std::max(0.0, give) : give);
        return {F, (f - F) * m.v};
    }
    bool acts(int point) const noexcept { return point >= contacts || touched[point]; }

    std::vector<double> omega_, damping_, mass_;  // omega0, 2 sigma, m for each mode
    // sum T/L, sum mu L/3, the latter minus S, b
    double tension_ = 0, inertia_ = 0, rest_ = 0, give_ = 0;
    double least_scale_ = 0;          // [m/s], from the plucks
    std::vector<double> compliance_;  // for each point, sum g^2/m [1/kg]
};

}  // namespace jvari

// The modal two-point scheme as van Walstijn et al. 2016 print it (eqs 33, 38-49), in plain Eigen
// and any real type: the form that the fused kernel is timed against (double) and measured against
// (long double), and the body of the example plugin. Leaves out: exponents other than 1, velocity
// taps, the energy columns.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "scenes/start.hpp"
#include "schemes/making.hpp"
#include "schemes/modal_coefficients.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

template <class Real>
class PlainTwoPoint final : public Scheme {
    using Vector = Eigen::Array<Real, Eigen::Dynamic, 1>;

public:
    PlainTwoPoint(const Scene& scene, const Settings& settings)
        : scene_(scene),
          string_(scene.strings.front()),
          ratio_(steps_per_row(settings)),
          modes_(modes_of(string_, settings)) {
        const Real dt = 1 / static_cast<Real>(settings.sample_rate);
        const int M = modes_.count();
        const Real xi = dt * dt / (2 * static_cast<Real>(modes_.mass));
        A = B = Vector(M);
        for (int i = 0; i < M; ++i) {
            const ModeStep m =
                exact_step(modes_.omega0[i], modes_.sigma[i], 1 / settings.sample_rate);
            A(i) = m.A();  // (33)
            B(i) = m.B();
        }
        const Vector J = 1 + A + B;
        twice_over_J = 2 / J;
        gb = gc = Vector::Zero(M);
        if (!string_.barriers.empty()) {
            const auto& b = std::get<LumpedBarrier>(string_.barriers.front());
            gb = to_real(footprint_weights(modes_, b.position, b.width));
            k_b = b.stiffness.k;
            h_b = b.height;
        }
        if (string_.thread) {
            const Thread& c = *string_.thread;
            gc = to_real(footprint_weights(modes_, c.position, c.width));
            k_c = c.stiffness;
            h_c = c.height;
            phi_c = k_c / 2 + static_cast<Real>(c.damping) / dt;
        }
        if (string_.pluck)
            ee = xi / J *
                 to_real(footprint_weights(modes_, string_.pluck->position, string_.pluck->width));
        dt_ = 1 / settings.sample_rate;
        eb = xi / J * gb;
        ec = xi / J * gc;
        const Real theta_bb = (gb * eb).sum(), theta_cc = (gc * ec).sum();
        theta_bc = (gb * ec).sum();
        inverse_c = 1 / (1 + phi_c * theta_cc);
        beta_c = phi_c * theta_bc * inverse_c;  // (47)
        theta = theta_bb - beta_c * theta_bc;   // (48)
        for (const Tap& tap : scene.taps) {
            Vector w = Vector::Zero(M);
            if (tap.quantity == Quantity::displacement)
                w = to_real(displacement_weights(modes_, tap.position));
            if (tap.quantity == Quantity::nut_force)
                w = to_real(nut_force_weights(modes_, string_));
            taps_.push_back(w);
        }
        y0_ = to_real(start_of(modes_, string_).displacement);
        PlainTwoPoint::reset();
    }
    void reset() noexcept override {
        y = y0_;
        q = Vector::Zero(y.size());
        s = u = q;
        impulse_b = impulse_c = 0;
        n_ = 0;
    }
    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows; ++row) {
            for (int k = 0; k < out.taps; ++k)
                out.tap[k * out.stride + row] = static_cast<double>(value(k));
            impulse_b = impulse_c = 0;
            for (int n = 0; n < ratio_; ++n) {
                step();
                if (out.stopped(n, steps_between_questions)) return {};
            }
        }
        return {};
    }
    int dofs() const override { return 2 * modes_.count(); }

private:
    static Vector to_real(const std::vector<double>& v) {
        return Eigen::Map<const Eigen::ArrayXd>(v.data(), v.size()).cast<Real>();
    }

    Real value(int k) const {
        switch (scene_.taps[k].quantity) {
            case Quantity::bridge_force: return impulse_b / ratio_;
            case Quantity::thread_force: return impulse_c / ratio_;
            case Quantity::driving_force: return -(impulse_b + impulse_c) / ratio_;
            default: return (taps_[k] * y).sum();
        }
    }
    void step() {
        u = twice_over_J * (q - A * y);  // (42)
        if (string_.pluck) u += ee * static_cast<Real>(mean_force(*string_.pluck, n_ * dt_, dt_));
        ++n_;
        const Real yb = (gb * y).sum(), yc = (gc * y).sum(), ub = (gb * u).sum(),
                   uc = (gc * u).sum();
        const Real vc = (k_c * (h_c - yc) - phi_c * uc) * inverse_c;                    // (47)
        const Real Fb = contact(h_b - yb, -ub - theta_bc * vc), Fc = vc - beta_c * Fb;  // (46)
        s = u + eb * Fb + ec * Fc;                                                      // (41)
        y += s;                                                                         // (40)
        q = s - q;
        impulse_b += Fb;
        impulse_c += Fc;
    }
    // Force of eq 48 in the four cases of fig 4: d = h_b - y_b, b = u.
    Real contact(Real d, Real b) const {
        const Real phi = theta * k_b / 2;
        if (k_b == 0 || (d <= 0 && d + b <= 0)) return 0;
        Real r;
        if (d > 0 && d * (1 - phi) + b > 0) r = (2 * phi * d - b) / (1 + phi);
        else if (d > 0) r = (-b + std::sqrt(b * b + 4 * phi * d * d)) / 2;
        else r = -(b - 2 * phi * d + std::sqrt(b * b - 4 * phi * d * (b + d))) / (2 * (1 + phi));
        return (r + b) / theta;  // r = -b + theta F
    }

    Scene scene_;
    String string_;
    int ratio_;
    Modes modes_;
    double dt_ = 0;
    long n_ = 0;
    Vector A, B, twice_over_J, gb, gc, eb, ec, ee, y0_, y, q, s, u;
    std::vector<Vector> taps_;
    Real k_b = 0, h_b = 0, k_c = 0, h_c = 0, phi_c = 0, theta_bc = 0, inverse_c = 1, beta_c = 0,
         theta = 0, impulse_b = 0, impulse_c = 0;
};

}  // namespace jvari

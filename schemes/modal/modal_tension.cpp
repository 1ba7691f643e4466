// String whose tension grows with its stretch (Kirchhoff 1883, Carrier 1945): T + EA l/(2L), l =
// int y'^2 dx = L/2 sum beta_i^2 q_i^2, by the potential V = EA l^2/(8L). Between the points it
// steps like the string in three_point_modes.hpp, whose coefficients are exact at the tension T.
// The stretching is one force lambda along a direction d of the modes, linear in each step (Bilbao
// 2009, ch. 8):
//
//     lambda = -(A + kappa r),   r = d.(q+ - q-),   d = beta^2 q,   A = EA L/8 d.q-,
//     kappa = EA L/16
//
// A tension that grows by dT lifts the frequency of mode i by 1/2 dT beta^2/(mu omega). With a gain
// dt^2/m the frequency would rise 2x/sin 2x times more, x = omega dt/2. The gain of an impulse, dt
// R sin(omega dt)/(m omega), is right to first order in dT at any rate, and the energy balances
// with W = dt^2/gain for the mass.
//
// lambda is eliminated before the contact solve, so the contacts see a string that yields less:
// Theta - kappa D D'/(1 + kappa d.e), D_p = d.e_p. Energy is kept to rounding, including the term
// EA L/32 (d.q+)^2. Second order. Leaves out: thread, contact loss, profiles, compliance=matched,
// polarisation, a body that moves.
#include <cmath>
#include <numbers>

#include "schemes/contact/gradient_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/three_point_modes.hpp"

namespace jvari {

namespace {

// The stretching force, and its effect at the points.
struct Stretching {
    double A = 0, kappa = 0;
    double free = 0, own = 0;        // r without forces [m^2/N at the scale of d]; d.e
    std::vector<double> on, theta_;  // D_p; Theta between the points, which yield less

    explicit Stretching(const StringPoints& p) : on(p.count(), 0.0), theta_(p.theta) {}
    double force(const double* F) const {
        double r = free;
        for (std::size_t p = 0; p < on.size(); ++p) r += on[p] * F[p];
        return -(A + kappa * r) / (1 + kappa * own);
    }
    void apply(const std::vector<double>& theta, double share, double* free_of_points) noexcept {
        const double alone = -(A + kappa * free) / (1 + kappa * own),
                     less = kappa / (1 + kappa * own);
        for (std::size_t p = 0; p < on.size(); ++p) {
            free_of_points[p] += on[p] * alone;
            for (std::size_t q = 0; q < on.size(); ++q)
                theta_[p * on.size() + q] = share * theta[p * on.size() + q] - less * on[p] * on[q];
        }
    }
};
// Over dt^2/m: dt R sin(omega dt)/(m omega).
double impulse_gain(double omega0, double sigma, double dt) {
    const double square = omega_squared_damped(omega0, sigma), omega = std::sqrt(std::abs(square)),
                 h = omega * dt;
    return std::exp(-sigma * dt) * (square > 0   ? std::sin(h) / h
                                    : square < 0 ? std::sinh(h) / h
                                                 : 1);
}

double square_of_beta(int i, double length) {
    const double beta = (i + 1) * std::numbers::pi / length;
    return beta * beta;
}

class StretchingString {
public:
    static constexpr int levels = 2;
    static constexpr long steps_between_looks = 64;

    explicit StretchingString(ThreePointProblem problem)
        : p_(std::move(problem)),
          one_(p_.points),
          kappa_(p_.string().axial_stiffness * p_.points.length / 16) {
        const int n = p_.modes.count();
        for (auto* v : {&y_, &last_, &coming_, &d_, &e_}) v->assign(n, 0.0);
        for (auto* v : {&older_, &now_, &free_}) v->assign(p_.points.count(), 0.0);
        for (const Tap& tap : p_.scene.taps)
            taps_.emplace_back(tap.quantity, tap_weights(tap, p_.modes, p_.string()));
    }
    const StringPoints& points() const { return p_.points; }
    ThreadStart thread_start() const { return ThreadStart::plain; }
    ReadingsBeforeStep readings() const { return {older_.data(), now_.data(), free_.data()}; }
    const std::vector<double>& theta() const { return one_.theta_; }

    void reset() noexcept {
        step_ = 0;
        std::copy(p_.start.displacement.begin(), p_.start.displacement.end(), y_.begin());
        std::fill(last_.begin(), last_.end(), 0.0);
        std::copy(p_.first.begin(), p_.first.end(), coming_.begin());
        prepare(0.5);
        // the outer levels are equal: lambda = -2 kappa (d.q + r), r for the half step
        one_.kappa *= 2;
        settle(0.5);
    }
    void start(const double* force, double) noexcept { put(force, 0.5); }
    void approach(bool) noexcept {
        ++step_;
        for (std::size_t i = 0; i < y_.size(); ++i) {
            y_[i] += coming_[i];
            last_[i] = coming_[i];
            coming_[i] = p_.update.Ct[i] * last_[i] - p_.update.kappa[i] * y_[i];
        }
        prepare(1);
        settle(1);
    }
    Spent pass(const double* force, double, bool probed) noexcept {
        put(force, 1);
        Spent spent;
        for (std::size_t i = 0; probed && i < y_.size(); ++i) {
            const double r = coming_[i] + last_[i];
            spent.dissipated += p_.W[i] * p_.three_point.loss[i] * r * r / (4 * p_.dt * p_.dt);
            if (F_e_ != 0) spent.supplied += 0.5 * F_e_ * port(p_.update.ports.size() - 1)[i] * r;
        }
        return spent;
    }
    bool failed() const { return !(std::abs(sum_) < modal_overflow); }
    void reading(int level, double* out) const noexcept {
        for (int p = 0; p < p_.points.count(); ++p)
            out[p] = modal_dot(port(p), y_) + (level == 1 ? modal_dot(port(p), coming_) : 0);
    }
    double stored() const noexcept {
        double s = 0;
        for (std::size_t i = 0; i < y_.size(); ++i)
            s += square_of_beta(static_cast<int>(i), p_.points.length) * y_[i] *
                 (y_[i] + coming_[i]);
        return p_.stored(y_, coming_) + 0.5 * kappa_ * s * s;
    }
    double tap(int k, const double* mean) const noexcept {
        const auto& [quantity, w] = taps_[k];
        if (w.empty()) return heard_force(quantity, p_.points, mean);
        if (quantity != Quantity::velocity) return modal_dot(w, y_);
        return step_ == 0 ? modal_dot(w, p_.start.velocity)
                          : 0.5 / p_.dt * (modal_dot(w, coming_) + modal_dot(w, last_));
    }
    int dofs() const { return 2 * p_.update.modes(); }
    std::vector<Fact> facts() const { return p_.facts; }
    std::vector<FreeMode> free_modes() const { return p_.free_modes(); }

private:
    const std::vector<double>& port(std::size_t p) const { return p_.update.ports[p].weights; }
    double gain(std::size_t i) const { return p_.update.gain_of(static_cast<int>(i)); }
    // Computes the direction at y, and the motion along it and at the points without their forces.
    // share: the part of the force that the step applies.
    void prepare(double share) noexcept {
        F_e_ = p_.points.pluck
                   ? mean_about(*p_.points.pluck, static_cast<double>(step_) * p_.dt, p_.dt)
                   : 0;
        for (std::size_t i = 0; F_e_ != 0 && i < y_.size(); ++i)
            coming_[i] += share * gain(i) * F_e_ * port(p_.update.ports.size() - 1)[i];
        for (std::size_t i = 0; i < y_.size(); ++i) {
            d_[i] = square_of_beta(static_cast<int>(i), p_.points.length) * y_[i];
            e_[i] = share * gain(i) * d_[i];
        }
        one_.A = 2 * kappa_ * (modal_dot(d_, y_) - modal_dot(d_, last_));
        one_.kappa = kappa_;
        one_.free = modal_dot(d_, coming_) + modal_dot(d_, last_);
        one_.own = modal_dot(d_, e_);
        for (int p = 0; p < p_.points.count(); ++p) one_.on[p] = modal_dot(port(p), e_);
    }
    void settle(double share) noexcept {
        sum_ = 0;
        for (int p = 0; p < p_.points.count(); ++p) {
            now_[p] = modal_dot(port(p), y_);
            older_[p] = now_[p] - modal_dot(port(p), last_);
            free_[p] = modal_dot(port(p), coming_) + modal_dot(port(p), last_);
        }
        for (const double y : y_) sum_ += y;
        one_.apply(p_.points.theta, share, free_.data());
    }
    void put(const double* force, double share) noexcept {
        const double lambda = one_.force(force);
        for (std::size_t i = 0; i < y_.size(); ++i) coming_[i] += lambda * e_[i];
        for (int p = 0; p < p_.points.count(); ++p)
            for (std::size_t i = 0; force[p] != 0 && i < y_.size(); ++i)
                coming_[i] += share * gain(i) * force[p] * port(p)[i];
    }

    ThreePointProblem p_;
    Stretching one_;
    double kappa_;  // EA L/16
    std::vector<std::pair<Quantity, std::vector<double>>> taps_;
    // y^n, y^n - y^{n-1}, y^{n+1} - y^n; beta^2 y, and the displacement by a force of 1 along it
    std::vector<double> y_, last_, coming_, d_, e_;
    std::vector<double> older_, now_, free_;
    double F_e_ = 0, sum_ = 0;
    long step_ = 0;
};

std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    return driven(std::make_unique<StretchingString>(
                      problem_of_modes(descriptor, scene, settings, impulse_gain)),
                  descriptor, settings, rule_of<GradientRule>(settings));
}
}  // namespace

extern const Descriptor modal_tension = {
    .name = "modal_tension",
    .source = "Bilbao 2009, ch. 8: linear in each step, with the impulse gain of each mode",
    .represents = (modal_features - (Feature::thread | Feature::equilibrium)) |
                  Feature::several_barriers | Feature::tension_modulation,
    .balance = Balance::exact,
    .make = make,
    .stand_in_rank = 0};

}  // namespace jvari

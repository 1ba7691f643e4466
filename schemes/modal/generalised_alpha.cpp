// Default time integrators in finite-element programs, on a string in its modes: the
// generalised-alpha method (Chung & Hulbert 1993) or HHT (Hilber, Hughes & Taylor 1977) with a
// penalty at the contacts. With x_a = (1 - a) x^{n+1} + a x^n,
//
//     m (v'_{alpha_m} + 2 sigma v_{alpha_f} + omega0^2 q_{alpha_f}) = f_{alpha_f}
//     q^{n+1} = q + dt v + dt^2 [(1/2 - beta) v' + beta v'^{n+1}],
//     v^{n+1} = v + dt [(1 - gamma) v' + gamma v'^{n+1}]
//
// gamma = 1/2 - alpha_m + alpha_f, beta = (1 - alpha_m + alpha_f)^2/4. rho = rho_inf, the fraction
// that a mode far above the rate keeps in a step, is option `rho`: alpha_m = (2 rho - 1)/(rho + 1),
// alpha_f = rho/(rho + 1); for HHT alpha_m = 0, alpha_f = (1 - rho)/(1 + rho), rho >= 1/2.
// f_{alpha_f} is the mean between the forces at both ends (contact/end_forces_rule.hpp), so one
// scalar equation remains per contact. Frequencies are warped, and for rho < 1 high modes are
// damped, like in such programs. No energy balance; the stored energy is the true one. Option
// `compliance` = own (default) | matched: puts the compliance of the cut modes in series. Leaves
// out: contact loss with compliance=matched; polarisation; the body.
#include "scenes/excitation.hpp"
#include "schemes/contact/end_forces_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/modal_string.hpp"

namespace jvari {

namespace {
constexpr Option method_option{
    "method", "generalised_alpha", "the time integrator", {"generalised_alpha", "hht"}};
constexpr Option rho_option{
    "rho", "0.8",
    "rho_inf, what a mode far above the rate keeps in a step: 0 to 1; of hht 0.5 to 1"};
constexpr Option options[] = {method_option, rho_option, compliance_option, profile_points_option};

struct Weights {
    double m, f;  // alpha_m, alpha_f
    double gamma() const { return 0.5 - m + f; }
    double beta() const { return 0.25 * (1 - m + f) * (1 - m + f); }
};
Weights weights_of(const Settings& settings) {
    const double rho = number_option(settings, rho_option);
    const bool hht = choice_option(settings, method_option) == "hht";
    if (!(rho >= (hht ? 0.5 : 0) && rho <= 1))
        throw Refusal(std::string("option rho: expected a number from ") +
                      (hht ? "0.5 to 1, as the method is hht" : "0 to 1"));
    return hht ? Weights{0, (1 - rho) / (1 + rho)}
               : Weights{(2 * rho - 1) / (rho + 1), rho / (rho + 1)};
}

class GeneralisedAlphaModes {
public:
    static constexpr int levels = 1;
    static constexpr long steps_between_looks = 64;

    GeneralisedAlphaModes(const Descriptor& descriptor, const Scene& given,
                          const Settings& settings, const Weights& w)
        : w_(w), dt_(1 / settings.sample_rate) {
        Scene scene = given;
        const String s = scene.strings.front() =
            with_profile_points(scene.strings.front(), settings);
        modes_ = modes_of(s, settings);
        p_ = points_of(scene, dt_);
        add_lumped(p_, s);
        for (const Footprint& f : sites_of(scene).forces)
            if (g_.size() < p_.positions.size())
                g_.push_back(footprint_weights(modes_, f.position, f.width));
        if (s.pluck) g_e_ = footprint_weights(modes_, s.pluck->position, s.pluck->width);
        std::vector<double> own;
        for (int i = 0; i < count(); ++i) {
            const double w0 = modes_.omega0[i] * modes_.omega0[i], sigma = 2 * modes_.sigma[i];
            own.push_back(1 / (modes_.mass * w0));
            inverse_.push_back(
                1 / (1 - w.m + (1 - w.f) * (sigma * w.gamma() * dt_ + w0 * w.beta() * dt_ * dt_)));
        }
        for (const auto& g : g_)
            for (const auto& h : g_) {
                double sum = 0;
                for (int i = 0; i < count(); ++i) sum += g[i] * h[i] * gain(i);
                p_.theta.push_back(sum);
            }
        if (choice_option(settings, compliance_option) == "matched")
            p_.series = modal_missing_matrix(descriptor, scene, modes_, dt_, own);
        start_ = start_of(modes_, s, yield_of(own, p_.series));
        put_start(p_, s, modes_, start_);
        for (const Tap& tap : scene.taps)
            taps_.emplace_back(tap.quantity, tap_weights(tap, modes_, s));
        for (auto* v : {&older_, &free_}) v->assign(g_.size(), 0.0);
        for (auto* v : {&q_, &v_, &a_, &next_, &push_}) v->assign(count(), 0.0);
        reset();
    }

    const StringPoints& points() const { return p_; }
    void reset() noexcept {
        step_ = 0;
        sum_ = 0;
        std::copy(start_.displacement.begin(), start_.displacement.end(), q_.begin());
        std::copy(start_.velocity.begin(), start_.velocity.end(), v_.begin());
        std::fill(a_.begin(), a_.end(), 0.0);
        if (!start_.force.empty()) return;  // in equilibrium
        for (int i = 0; i < count(); ++i)   // a pluck acts from the first step on
            a_[i] = -modes_.omega0[i] * modes_.omega0[i] * q_[i] - 2 * modes_.sigma[i] * v_[i];
    }
    void approach(bool) noexcept {  // next_: v'^{n+1} without the points' forces
        F_e_ = p_.pluck ? mean_force(*p_.pluck, static_cast<double>(step_) * dt_, dt_) : 0;
        for (int i = 0; i < count(); ++i) {
            const double w0 = modes_.omega0[i] * modes_.omega0[i], sigma = 2 * modes_.sigma[i],
                         f = 1 - w_.f;
            const double f_e = g_e_.empty() ? 0 : g_e_[i] * F_e_ / modes_.mass;
            next_[i] = inverse_[i] *
                       (f_e - w_.m * a_[i] - sigma * (v_[i] + f * dt_ * (1 - w_.gamma()) * a_[i]) -
                        w0 * (q_[i] + f * (dt_ * v_[i] + dt_ * dt_ * (0.5 - w_.beta()) * a_[i])));
        }
        sum_ = 0;
        for (std::size_t p = 0; p < g_.size(); ++p) {
            older_[p] = free_[p] = 0;
            for (int i = 0; i < count(); ++i) {
                older_[p] += g_[p][i] * q_[i];
                free_[p] += g_[p][i] * moved(i, next_[i]);
            }
            sum_ += older_[p];
        }
    }
    ReadingsBeforeStep readings() const { return {older_.data(), older_.data(), free_.data()}; }
    Spent pass(const double* force, double, bool) noexcept {
        Spent spent;
        std::fill(push_.begin(), push_.end(), 0.0);
        for (std::size_t p = 0; p < g_.size(); ++p)
            for (int i = 0; force[p] != 0 && i < count(); ++i) push_[i] += g_[p][i] * force[p];
        for (int i = 0; i < count(); ++i) {
            const double a = next_[i] + push_[i] * inverse_[i] / modes_.mass, s = moved(i, a),
                         v = v_[i];
            v_[i] += dt_ * ((1 - w_.gamma()) * a_[i] + w_.gamma() * a);
            a_[i] = a;
            q_[i] += s;
            spent.dissipated +=
                2 * modes_.sigma[i] * modes_.mass * dt_ * 0.25 * (v + v_[i]) * (v + v_[i]);
            if (F_e_ != 0) spent.supplied += F_e_ * g_e_[i] * s;
        }
        ++step_;
        return spent;
    }
    void reading(int, double* out) const noexcept {
        for (std::size_t p = 0; p < g_.size(); ++p) out[p] = modal_dot(g_[p], q_);
    }
    double stored() const noexcept {
        double H = 0;
        for (int i = 0; i < count(); ++i) {
            const double w = modes_.omega0[i] * q_[i];
            H += 0.5 * modes_.mass * (v_[i] * v_[i] + w * w);
        }
        return H;
    }
    bool failed() const { return !(std::abs(sum_) < modal_overflow); }
    double tap(int k, const double* mean) const noexcept {
        const auto& [quantity, w] = taps_[k];
        return w.empty() ? heard_force(quantity, p_, mean)
                         : modal_dot(w, quantity == Quantity::velocity ? v_ : q_);
    }
    int dofs() const { return 3 * count(); }
    std::vector<Fact> facts() const { return {}; }
    std::vector<FreeMode> free_modes() const { return {}; }

private:
    int count() const { return modes_.count(); }
    // displacement in a step per unit force [m/N]
    double gain(int i) const { return dt_ * dt_ * w_.beta() * inverse_[i] / modes_.mass; }
    double moved(int i, double a) const {
        return dt_ * v_[i] + dt_ * dt_ * ((0.5 - w_.beta()) * a_[i] + w_.beta() * a);
    }

    Weights w_;
    double dt_;
    Modes modes_;
    StringPoints p_;
    std::vector<std::vector<double>> g_;  // the contacts in order, then the thread
    std::vector<double> g_e_, inverse_;   // inverse_: inverse of the factor on v'^{n+1}
    ModalStart start_;
    std::vector<double> q_, v_, a_, next_, push_, older_, free_;
    std::vector<std::pair<Quantity, std::vector<double>>> taps_;
    long step_ = 0;
    // in the step: the pluck's force [N]; the points' readings added up [m]
    double F_e_ = 0, sum_ = 0;
};

std::unique_ptr<Scheme> make(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    matched_without_loss(descriptor, scene, settings);
    const Weights w = weights_of(settings);
    const MakeRule make = [share = w.f](auto laws, auto theta, int) {
        return std::make_unique<EndForcesRule>(laws, theta, share);
    };
    return driven(std::make_unique<GeneralisedAlphaModes>(descriptor, scene, settings, w),
                  descriptor, settings, {make});
}
}  // namespace

extern const Descriptor modal_generalised_alpha = {
    .name = "modal_generalised_alpha",
    .source =
        "Chung & Hulbert 1993; Hilber, Hughes & Taylor 1977; with a penalty, as finite-element "
        "programs do",
    .represents = modal_features_of_points,
    .balance = Balance::none,
    .make = make,
    .options = options,
    .approximates = modal_approximates_elastic,
    .stand_in_rank = 0};

}  // namespace jvari

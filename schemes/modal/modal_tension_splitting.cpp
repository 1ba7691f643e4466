// The string of modal_tension.cpp without contacts, split into two parts that are exact: the linear modes for a time h, and the momentum
// that stretching and pluck give in h where the string stands, p_i -= h EA l beta_i^2 q_i/4. Half a kick, the modes, half a kick is
// Strang's splitting S(h), of second order and symmetric. As nothing here has a kink, the same step composed with itself has the fourth
// (Suzuki 1990; Hairer, Lubich & Wanner 2006, ch. II.4):
//
//     S(g h) S(g h) S((1 - 4g) h) S(g h) S(g h),   g = 1/(4 - 4^(1/3))
//
// Explicit. No balance of energy is promised: the stored energy is the true one, and its error is of the order of the step.
// Leaves out: barriers, thread, profiles, compliance=matched, polarisation, a body that moves.
#include <cmath>
#include <complex>

#include "schemes/contact/gradient_rule.hpp"
#include "schemes/driver/driver.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_string.hpp"

namespace jvari {

namespace {

constexpr Option order_option = {"order", "2", "in time: Strang's splitting, or five of its steps, one of them backwards", {"2", "4"}};

class SplitString {
public:
    static constexpr int levels = 1;
    static constexpr long steps_between_looks = 64;

    SplitString(const Descriptor& descriptor, const Scene& scene, const Settings& settings)
        : modes_(modes_of(scene.strings.front(), settings)), points_(points_of(scene.strings.front(), 1 / settings.sample_rate)) {
        const String& s = scene.strings.front();
        refuse_above_nyquist(descriptor, modes_, settings.sample_rate);
        initial_ = initial_displacement(modes_, s);
        for (const double beta : modes_.beta) square_.push_back(beta * beta);
        stiffness_ = s.axial_stiffness;
        if (s.pluck) plucked_ = footprint_weights(modes_, s.pluck->position, s.pluck->width);
        const double g = 1 / (4 - std::cbrt(4.0)), h = points_.dt;
        if (choice_option(settings, order_option) == "4")
            parts_ = {motion(g * h), motion(g * h), motion((1 - 4 * g) * h), motion(g * h), motion(g * h)};
        else parts_ = {motion(h)};
        for (const Tap& tap : scene.taps) taps_.emplace_back(tap.quantity, tap_weights(tap, modes_, s));
        reset();
    }
    const StringPoints& points() const { return points_; }
    void reset() noexcept {
        y_ = initial_;
        v_.assign(y_.size(), 0.0);
        step_ = 0;
    }
    void approach(bool) noexcept {}
    ReadingsBeforeStep readings() const { return {nullptr, nullptr, nullptr}; }
    Spent pass(const double*, double, bool probed) noexcept {
        double t = static_cast<double>(step_++) * points_.dt, pushed = 0;
        Spent spent;
        for (const Motion& m : parts_) {
            spent.supplied += kick(pushed + 0.5 * m.h, t);
            if (probed) spent.dissipated += linear();
            for (std::size_t i = 0; i < y_.size(); ++i) {
                const double y = y_[i], v = v_[i];
                y_[i] = m.of[i].yy * y + m.of[i].yv * v;
                v_[i] = m.of[i].vy * y + m.of[i].vv * v;
            }
            if (probed) spent.dissipated -= linear();
            t += m.h;
            pushed = 0.5 * m.h;  // two half kicks where the string stands are one
        }
        spent.supplied += kick(pushed, t);
        return spent;
    }
    void reading(int, double*) const noexcept {}
    double stored() const noexcept {
        const double l = stretch();
        return linear() + 0.125 * stiffness_ / points_.length * l * l;
    }
    bool failed() const {
        double sum = 0;
        for (const double y : y_) sum += y;
        return !(std::abs(sum) < modal_overflow);
    }
    double tap(int k, const double*) const noexcept {
        const auto& [quantity, w] = taps_[k];
        const std::vector<double>& of = quantity == Quantity::velocity ? v_ : y_;
        double sum = 0;
        for (std::size_t i = 0; i < w.size(); ++i) sum += w[i] * of[i];
        return sum;
    }
    int dofs() const { return 2 * modes_.count(); }
    std::vector<Fact> facts() const { return {}; }
    std::vector<FreeMode> free_modes() const {
        std::vector<FreeMode> all;
        for (int i = 0; i < modes_.count(); ++i)
            all.push_back({std::sqrt(std::max(0.0, omega_squared_damped(modes_.omega0[i], modes_.sigma[i]))), modes_.sigma[i]});
        return all;
    }

private:
    struct Motion {
        double h;
        struct OfMode {
            double yy, yv, vy, vv;
        };
        std::vector<OfMode> of;
    };
    Motion motion(double h) const {  // exact, h of either sign; complex where a mode is overdamped
        Motion m{h, {}};
        for (int i = 0; i < modes_.count(); ++i) {
            const double s = modes_.sigma[i], w0 = modes_.omega0[i];
            const std::complex<double> w = std::sqrt(std::complex<double>(omega_squared_damped(w0, s)));
            const double R = std::exp(-s * h), c = R * std::cos(w * h).real();
            const double sine = R * (w == 0.0 ? h : (std::sin(w * h) / w).real());
            m.of.push_back({c + s * sine, sine, -w0 * w0 * sine, c - s * sine});
        }
        return m;
    }
    double linear() const noexcept {  // energy of the modes at the tension T [J]
        double H = 0;
        for (std::size_t i = 0; i < y_.size(); ++i) {
            const double w = modes_.omega0[i] * y_[i];
            H += 0.5 * modes_.mass * (v_[i] * v_[i] + w * w);
        }
        return H;
    }
    double stretch() const noexcept {  // l [m]
        double sum = 0;
        for (std::size_t i = 0; i < y_.size(); ++i) sum += square_[i] * y_[i] * y_[i];
        return 0.5 * points_.length * sum;
    }
    double kick(double h, double t) noexcept {  // the work of the pluck [J]
        const double F = points_.pluck ? force(*points_.pluck, t) : 0, pull = 0.25 * stiffness_ * stretch();
        double work = 0;
        for (std::size_t i = 0; i < y_.size(); ++i) {
            const double by_pluck = F != 0 ? F * plucked_[i] : 0, change = h / modes_.mass * (by_pluck - pull * square_[i] * y_[i]);
            work += h * by_pluck * (v_[i] + 0.5 * change);
            v_[i] += change;
        }
        return work;
    }

    Modes modes_;
    StringPoints points_;
    std::vector<double> initial_, square_, plucked_;  // square_: beta^2 [1/m^2]
    std::vector<Motion> parts_;
    std::vector<std::pair<Quantity, std::vector<double>>> taps_;
    std::vector<double> y_, v_;
    double stiffness_ = 0;  // EA [N]
    long step_ = 0;
};

std::unique_ptr<Scheme> made(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    return driven<GradientRule>(std::make_unique<SplitString>(descriptor, scene, settings), descriptor, settings);
}
constexpr Option options[] = {order_option};
constexpr Features represented = Features(Feature::bending_stiffness) | Feature::damping | Feature::frequency_dependent_damping |
                                 Feature::measured_modes | Feature::initial_shape | Feature::pluck | Feature::tension_modulation;
}  // namespace

extern const Descriptor modal_tension_splitting = {.name = "modal_tension_splitting",
                                                   .source = "Strang 1968; of order 4 Suzuki 1990",
                                                   .represents = represented,
                                                   .balance = Balance::none,
                                                   .clock = Clock::stepped,
                                                   .make = made,
                                                   .options = options,
                                                   .stand_in_rank = 0};

}  // namespace jvari

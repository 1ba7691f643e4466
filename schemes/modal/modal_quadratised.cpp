// Modal schemes with quadratised (linearly implicit) contact: quadratised_contact.hpp on the two-point form of van Walstijn et al. 2016
// (eqs 38-52, the pass below) and on the three-point form of Issanchou et al. 2016 (modal_three_point.hpp). The thread is eliminated as in
// eqs 45-47 of the first. Energy columns hold the scheme's own energy, with psi^2/2 for the contact; the facts tell how far that is from
// the true one. Option `compliance` = own (default) | matched of the two-point form: what cut and step take from the string's compliance
// stands in series with barrier and thread (contact/residual.hpp), and psi = sqrt(2 Phi). Several barriers, profiles and contact loss:
// the two-point form with compliance=own, by contact/quadratised_points.hpp. Leaves out: polarisation.
#include <cmath>
#include <functional>
#include <optional>

#include "schemes/contact/quadratised_contact.hpp"
#include "schemes/contact/quadratised_points.hpp"
#include "schemes/contact/residual.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/kernels/modal_energies.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/modal_three_point.hpp"
#include "schemes/modal/modal_two_point_points.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

namespace {

// ---- Three-point: psi lives at half steps.

struct QuadratisedThreePointContact {
    static constexpr int dofs = 1;
    QuadratisedLaw q;
    double psi = 0, psi_next = 0, force = 0;
    QuadratisedFacts seen;

    void begin(double eta) { psi = q.psi(eta); }
    double first(double eta, double s0, double theta) {  // F^0/2 = gamma psi^{1/2}, psi^{1/2} = psi^0 - gamma s
        force = 0;
        psi_next = psi;
        if (eta <= 0) return 0;
        const double gamma = q.gamma(eta);
        force = std::max(gamma * (psi - gamma * s0) / (1 + gamma * gamma * theta), 0.0);
        psi_next = std::max(psi - gamma * (s0 + theta * force), 0.0);
        return force;
    }
    double next(double eta, double, double r0, double theta) {
        const QuadratisedStep s = solve_quadratised(q, eta, psi, r0, theta);
        psi_next = s.psi;
        return force = s.force;
    }
    void settle(double eta, double eta_old) {
        psi = psi_next;
        const double a = q.psi(eta), b = q.psi(eta_old);
        seen.note(force, psi, eta, std::sqrt(0.5 * (a * a + b * b)));
    }
    bool solved() const { return true; }
    double energy(double, double) const { return 0.5 * psi * psi; }
    double energy_next(double, double) const { return 0.5 * psi_next * psi_next; }
    std::vector<Fact> facts() const { return seen.list(); }
};

// ---- Two-point: s = y^{n+1} - y^n = u + e_b F_b + e_c F_c + e_e F_e in the form y' = y + s, u' = a s - (u + c y).

class QuadratisedTwoPoint final : public Scheme {
public:
    // missing: what it makes of the static response of each mode that it steps [m/N]; none: the string as it is
    using Missing = std::function<MissingCompliance(std::span<const double> own)>;
    QuadratisedTwoPoint(ModalString string, Quadratisation variant, const Missing& missing)
        : m_(std::move(string)), q_(QuadratisedLaw::make(m_.barrier, variant, 0.5)), y_(m_.size), u_(m_.size), A_(m_.size), B_(m_.size) {
        xi_ = m_.dt * m_.dt / (2 * m_.mass);
        a_ = c_ = J_ = A_;
        for (int i = 0; i < m_.count; ++i) {
            A_[i] = m_.num[i] / m_.den[i];
            B_[i] = 2 * m_.loss[i] / m_.den[i];  // (33)
            J_[i] = 1 + A_[i] + B_[i];
            a_[i] = 2 * (1 - A_[i]) / J_[i];
            c_[i] = 4 * A_[i] / J_[i];
        }
        e_b_ = scaled(m_.g_b);
        e_c_ = scaled(m_.g_c);
        e_e_ = scaled(m_.g_e);
        theta_cc_ = modal_dot(m_.g_c, e_c_);
        theta_bc_ = modal_dot(m_.g_b, e_c_);
        theta_be_ = modal_dot(m_.g_b, e_e_);
        theta_ce_ = modal_dot(m_.g_c, e_e_);
        const bool barrier = !m_.g_b.empty(), thread = !m_.g_c.empty();
        if (missing) {
            std::vector<double> own;
            for (int i = 0; i < m_.count; ++i) own.push_back(0.5 * xi_ / A_[i]);  // (42) with s = 0
            C_ = missing(own);
            series_ = ResidualPair(C_, m_.dt);
            theta_bc_ += series_->K_bc;
            theta_cc_ += series_->K_cc;
        }
        thread_ = {m_.k_c, m_.k_c / 2 + m_.r_c / m_.dt, modal_dot(m_.g_b, e_b_) + (series_ ? series_->K_bb : 0), theta_bc_, theta_cc_};
        unplucked_ = two_point_pass(barrier, thread, false);
        plucked_ = two_point_pass(barrier, thread, true);
        pass_.size = m_.size;
        pass_.p = a_.data();
        pass_.r = c_.data();
        pass_.g_b = m_.g_b.data();
        pass_.g_c = m_.g_c.data();
        pass_.e_b = e_b_.data();
        pass_.e_c = e_c_.data();
        pass_.e_e = e_e_.data();
        pass_.x = y_.data();
        pass_.v = u_.data();
        QuadratisedTwoPoint::reset();
    }

    void reset() noexcept override {
        y_ = m_.y0;
        for (int i = 0; i < m_.count; ++i) u_[i] = -2 * A_[i] / J_[i] * y_[i];  // (42) with q = 0
        y_b_ = modal_dot(m_.g_b, y_);
        u_b_ = modal_dot(m_.g_b, u_);
        y_c_ = modal_dot(m_.g_c, y_);
        u_c_ = modal_dot(m_.g_c, u_);
        step_ = 0;
        if (series_) series_->clear();
        psi_ = q_.psi(eta());
        status_ = {};
        seen_ = {};
        impulse_b_ = impulse_c_ = supplied_ = dissipated_ = 0;
    }

    Status advance(const Block& out) noexcept override {
        if (status_.outcome != Outcome::ok) return status_;
        for (int row = 0; row < out.rows; ++row) {
            write(out, row);
            impulse_b_ = impulse_c_ = supplied_ = dissipated_ = 0;
            for (int k = 0; k < m_.steps_per_row; ++k) {
                solve();
                if (out.energy) ledger();
                step();
                if (!m_.g_b.empty()) seen_.note(F_b_, psi_, eta(), q_.psi(eta()));
                if (out.stopped(k, steps_between_questions)) return {};
            }
            if (!(std::abs(y_b_ + y_c_) < modal_overflow)) return status_ = {Outcome::diverged, step_ - 1};
        }
        return {};
    }

    int dofs() const override { return 2 * m_.count + (m_.g_b.empty() ? 0 : 1); }
    std::vector<Fact> facts() const override {
        if (m_.g_b.empty()) return {};
        double compliance = 0;
        for (int i = 0; i < m_.count; ++i) compliance += 0.5 * xi_ * m_.g_b[i] * m_.g_b[i] / A_[i];
        std::vector<Fact> f = seen_.list();
        f.push_back(series_ ? Fact{facts::series_compliance, series_->C_bb}
                            : Fact{facts::static_compliance, compliance / m_.true_compliance});
        return f;
    }
    std::vector<FreeMode> free_modes() const override {
        std::vector<FreeMode> all;
        for (int i = 0; i < m_.count; ++i) all.push_back(two_point_mode(A_[i], B_[i], m_.dt));
        return all;
    }

private:
    ModalArray scaled(const ModalArray& g) const {  // e_z = xi g_z/J
        ModalArray e = g;
        for (std::size_t i = 0; i < std::min<std::size_t>(e.size(), m_.count); ++i) e[i] *= xi_ / J_[i];
        return e;
    }

    // Of barrier and thread where they touch, at the step in hand: with what is in series, and the pluck's part of it.
    double at_b() const { return y_b_ + (series_ ? C_.be * m_.pluck_at(step_) + series_->D_b : 0); }
    double at_c() const { return y_c_ + (series_ ? C_.ce * m_.pluck_at(step_) + series_->D_c : 0); }
    double eta() const { return m_.h_b - at_b(); }

    void solve() {
        F_e_ = 0.5 * (m_.pluck_at(step_) + m_.pluck_at(step_ + 1));
        change_ = m_.pluck_at(step_ + 1) - m_.pluck_at(step_);
        double u_b = u_b_ + theta_be_ * F_e_, u_c = u_c_ + theta_ce_ * F_e_;
        if (series_) {
            u_b += C_.be * change_ - series_->H_b;
            u_c += C_.ce * change_ - series_->H_c;
        }
        const double v_c = thread_.alone(m_.h_c - at_c(), u_c);
        const QuadratisedStep s = solve_quadratised(q_, eta(), psi_, u_b + theta_bc_ * v_c, thread_.theta);
        F_b_ = s.force;
        psi_ = s.psi;
        F_c_ = v_c - thread_.beta * F_b_;
        s_c_ = u_c + theta_bc_ * F_b_ + theta_cc_ * F_c_;
        impulse_b_ += F_b_;
        impulse_c_ += F_c_;
        if (!series_) return;
        lost_ = series_->lost(F_b_, F_c_);
        series_->take(F_b_, F_c_);
    }

    void push() {
        pass_.F_b = F_b_;
        pass_.F_c = F_c_;
        pass_.F_e = F_e_;
    }
    void step() {
        push();
        (F_e_ != 0 ? plucked_ : unplucked_)(pass_);
        y_b_ = pass_.x_b;
        u_b_ = pass_.v_b;
        y_c_ = pass_.x_c;
        u_c_ = pass_.v_c;
        ++step_;
    }

    void ledger() {  // (51), (52) over one step
        push();
        const auto [loss, work] = two_point_spending(pass_, B_.data(), F_e_ != 0 ? m_.g_e.data() : nullptr);
        dissipated_ += loss / xi_ + m_.r_c / m_.dt * s_c_ * s_c_ + lost_;
        supplied_ += F_e_ * work - (F_b_ * C_.be + F_c_ * C_.ce) * change_;
    }
    double momentum(int i) const { return 0.5 * J_[i] * u_[i] + A_[i] * y_[i]; }  // q of (31)

    double stored() const {  // (49) with psi
        const double sum = two_point_stored(pass_, J_.data(), A_.data());
        const double e_c = m_.h_c - at_c();
        return sum / xi_ + 0.5 * m_.k_c * e_c * e_c + 0.5 * psi_ * psi_ + (series_ ? series_->stored() : 0);
    }

    void write(const Block& out, int row) const {
        const double per_row = m_.steps_per_row;
        const auto velocity = [this](const ModalArray& weights) {  // p/m = 2 q/dt
            double sum = 0;
            for (int i = 0; i < m_.size; ++i) sum += weights[i] * momentum(i);
            return sum * (2 / m_.dt);
        };
        write_taps(out, row, m_.taps, y_, velocity, impulse_b_ / per_row, impulse_c_ / per_row);
        if (series_)
            for (int k = 0; k < out.taps; ++k)
                out.tap[k * out.stride + row] += C_.on_tap(k, series_->P_b(), series_->P_c(), m_.pluck_at(step_));
        if (out.energy) write_energy(out, row, stored(), supplied_, dissipated_);
    }

    ModalString m_;
    QuadratisedLaw q_;
    MissingCompliance C_;
    std::optional<ResidualPair> series_;
    double change_ = 0, lost_ = 0;  // of the pluck over the step [N]; of what is in series [J]
    ModalArray y_, u_, A_, B_, a_, c_, J_, e_b_, e_c_, e_e_;
    double xi_ = 0, theta_bc_ = 0, theta_cc_ = 0, theta_be_ = 0, theta_ce_ = 0;
    EliminatedThread thread_;
    ModalPass pass_;
    ModalPassFunction unplucked_ = nullptr, plucked_ = nullptr;
    long step_ = 0;
    Status status_;
    QuadratisedFacts seen_;
    double psi_ = 0;                                // [sqrt(J)]
    double y_b_ = 0, u_b_ = 0, y_c_ = 0, u_c_ = 0;  // [m]
    double F_b_ = 0, F_c_ = 0, F_e_ = 0, s_c_ = 0;  // of the step in hand [N], [m]
    double impulse_b_ = 0, impulse_c_ = 0;          // sums of F over the interval of a row [N]
    double supplied_ = 0, dissipated_ = 0;          // [J]
};

// ---- The table.

using Made = std::unique_ptr<Scheme>;

Made made(const Descriptor& descriptor, const Scene& scene, const Settings& settings, int levels, Quadratisation variant) {
    if (!touches_once_without_loss(scene.strings.front())) {
        if (levels == 3) throw Refusal(std::string(descriptor.name) + ": several barriers, profiles and contact loss are for levels=2");
        refuse_matched_points(descriptor, settings);
        return std::make_unique<ModalTwoPointPoints<QuadratisedPoints>>(
            descriptor, scene, settings, exact_two_point, [variant](const auto&... parts) { return QuadratisedPoints(parts..., variant); });
    }
    ModalString string = modal_string(descriptor, scene, settings);
    const bool matched = choice_option(settings, compliance_option) == "matched";
    if (levels == 2) {
        QuadratisedTwoPoint::Missing missing;
        if (matched)
            missing = [&](std::span<const double> own) {
                return modal_compliance(descriptor, scene, modes_of(scene.strings.front(), string.count), own);
            };
        return std::make_unique<QuadratisedTwoPoint>(string, variant, missing);
    }
    const ModalArray gain(string.size, string.dt * string.dt / string.mass), inertia(string.count, string.mass);
    if (matched) {  // at low rates its string is too soft, which is refused with the figure
        std::vector<double> own;
        for (int i = 0; i < string.count; ++i) own.push_back(gain[i] / string.num[i]);  // under a steady force: d = 0
        modal_compliance(descriptor, scene, modes_of(scene.strings.front(), string.count), own);
        throw Refusal(
            std::string(descriptor.name) +
            ": compliance=matched with levels=3: a compliance could stand in series here, but psi at half steps has no step for it; "
            "ask for levels=2, or for modal_spatial_newton, which carries it on the same recursion");
    }
    const QuadratisedThreePointContact contact{QuadratisedLaw::make(string.barrier, variant, 1), 0, 0, 0, {}};
    return std::make_unique<ModalThreePoint<QuadratisedThreePointContact>>(std::move(string), gain, inertia, contact);
}

constexpr Option levels_option{"levels", "2", "time levels of the recursion", {"2", "3"}};
constexpr Option variant_option{"variant",
                                "released",
                                "psi out of contact: kept, driven to 0, or released in full where it would pull",
                                {"raw", "constrained", "released"}};
constexpr Option chosen_options[] = {levels_option, variant_option, compliance_option, profile_points_option};
constexpr Option two_point_options[] = {compliance_option, profile_points_option};

Made made_as_chosen(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    const std::string variant = choice_option(settings, variant_option);
    return made(descriptor, scene, settings, choice_option(settings, levels_option) == "2" ? 2 : 3,
                variant == "raw"           ? Quadratisation::raw
                : variant == "constrained" ? Quadratisation::constrained
                                           : Quadratisation::released);
}

template <int levels, Quadratisation variant>
Made made_as(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    return made(descriptor, scene, settings, levels, variant);
}

constexpr const char* raw_source = "Ducceschi et al. 2021 without the constraint on psi (known-bad control)";
constexpr const char* constrained_source = "Ducceschi et al. 2021, with g signed by psi and psi driven to 0 out of contact";
constexpr const char* released_source = "Ducceschi et al. 2021, psi released in full where it would pull";

constexpr Descriptor quadratised(const char* name, const char* source, Made (*make)(const Descriptor&, const Scene&, const Settings&)) {
    return {.name = name,
            .source = source,
            .represents = modal_features,
            .balance = Balance::exact,
            .clock = Clock::stepped,
            .make = make,
            .note = "One lumped barrier without contact loss: this form is built for one contact, the two-point forms take several."};
}
constexpr Approximation approximates[] = {{Feature::profile_barrier, facts::contact_points}};
constexpr Descriptor of_several_points(Descriptor d, std::span<const Option> options) {
    d.represents =
        modal_features | Features(Feature::profile_barrier) | Features(Feature::several_barriers) | Features(Feature::contact_loss);
    d.options = options;
    d.approximates = approximates;
    d.note = "";
    return d;
}
}  // namespace

extern const Descriptor modal_quadratised =
    of_several_points(quadratised("modal_quadratised", released_source, made_as_chosen), chosen_options);
extern const Descriptor modal_quadratised_two_point_constrained = of_several_points(
    quadratised("modal_quadratised_two_point_constrained", constrained_source, made_as<2, Quadratisation::constrained>), two_point_options);
extern const Descriptor modal_quadratised_two_point_raw =
    of_several_points(quadratised("modal_quadratised_two_point_raw", raw_source, made_as<2, Quadratisation::raw>), two_point_options);
extern const Descriptor modal_quadratised_three_point =
    quadratised("modal_quadratised_three_point", released_source, made_as<3, Quadratisation::released>);
extern const Descriptor modal_quadratised_three_point_constrained =
    quadratised("modal_quadratised_three_point_constrained", constrained_source, made_as<3, Quadratisation::constrained>);
extern const Descriptor modal_quadratised_three_point_raw =
    quadratised("modal_quadratised_three_point_raw", raw_source, made_as<3, Quadratisation::raw>);

}  // namespace jvari

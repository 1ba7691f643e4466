// The modal two-point scheme: van Walstijn, Bridges & Mehes 2016, eqs 16-52 (the update in the form
// of two_point_modes.hpp).
//
// Exact modal frequencies and decay by the coefficients of eq 33; the thread eliminated by eqs
// 45-47; one barrier, whose force is the two-point discrete gradient of eq 30. Starts from rest
// with q = 0 as in the paper: with losses that is not quite the true rest, a freely decaying mode
// begins with a small phase offset (fact `start_phase_offset`); without losses free motion is exact
// to rounding. Option `compliance` = own (default, the paper's scheme) | matched: what truncation
// and step take from the string's compliance stands in series with barrier and thread
// (contact/compliance.hpp), and its part is added to displacement and nut force.
// `modal_two_point_trapezoidal` is the same with the coefficients a_i, b_i of eq 32 not replaced:
// stable, and dispersive. These are the kernels of one contact. Profiles, several barriers, contact
// loss and a moving body: the same string as two_point_modes.hpp, by the driver. Leaves out:
// contact loss and a moving body with compliance=matched; polarisation.
#include "scenes/excitation.hpp"
#include "schemes/body/body_modes.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/two_point_modes.hpp"

namespace jvari {

namespace {

TwoPointCoefficients trapezoidal(double omega0, double sigma, double dt) {  // a_i, b_i of (32)
    return {0.25 * omega0 * omega0 * dt * dt, sigma * dt};
}

// The string of two_point_modes.hpp with one contact at most, whose rows a kernel makes whole.
class ModalTwoPoint final : public Scheme {
public:
    ModalTwoPoint(std::unique_ptr<TwoPointModes> string, int steps_per_row)
        : string_(std::move(string)) {
        const StringPoints& p = points();
        const std::size_t n = p.count();
        m_.steps_per_row = steps_per_row;
        m_.dt = p.dt;
        if (p.series) m_.series = ResidualPair(*p.series, p.dt);
        if (barrier_) {
            m_.barrier = p.contacts.laws.front();
            m_.h_b = p.contacts.heights.front();
            m_.own_bb = p.theta.front();
            m_.theta = m_.own_bb + m_.series.K_bb;
        }
        if (thread_) {
            const Thread& thread = p.threads.front();
            m_.k_c = thread.stiffness;
            m_.r_c = thread.damping;
            m_.h_c = thread.height;
            m_.own_cc = p.theta.back();
            m_.theta_cc = m_.own_cc + m_.series.K_cc;
            if (barrier_) m_.own_bc = p.theta[1], m_.theta_bc = m_.own_bc + m_.series.K_bc;
            const double theta[] = {m_.theta, m_.theta_bc, m_.theta_bc, m_.theta_cc};
            const EliminatedThreads eliminated({thread}, 1, theta, p.dt);
            m_.phi_c = eliminated.one().phi;
            m_.inverse_c = eliminated.one().inverse;
            m_.beta_c = eliminated.one().answer;
            m_.theta = eliminated.between_contacts(theta).front();
        }
        if (const auto& pluck = string_->pluck_force(); p.pluck) {
            if (barrier_) m_.theta_be = pluck.theta.front();
            if (thread_) m_.theta_ce = pluck.theta[n - 1];
            m_.pluck = pluck.mean.data();
            m_.pluck_first = pluck.first;
            m_.pluck_steps = static_cast<long>(pluck.mean.size());
            for (long k = 0; p.series && k <= m_.pluck_steps; ++k)
                pluck_now_.push_back(force(*p.pluck, (m_.pluck_first + k) * p.dt));
            m_.pluck_now = pluck_now_.data();
        }
        for (std::size_t k = 0; k < string_->taps().size(); ++k) add_tap(k, string_->taps()[k]);
        m_.taps = taps_;
        const ContactKind kind = !barrier_               ? ContactKind::none
                                 : m_.barrier.alpha == 1 ? ContactKind::linear
                                                         : ContactKind::power;
        row_ = two_point_row(kind, thread_, p.series ? Compliance::matched : Compliance::own);
        ModalTwoPoint::reset();
    }

    void reset() noexcept override {
        string_->reset();
        static_cast<TwoPointStream&>(m_) = string_->stream();
        m_.step = 0;
        m_.series.clear();
        m_.impulse_b = m_.impulse_c = m_.supplied = m_.dissipated = m_.iterations =
            m_.iterations_most = m_.depth = 0;
        m_.range = {};
        m_.status = {};
    }
    Status advance(const Block& out) noexcept override {
        for (int row = 0; row < out.rows && m_.status.outcome == Outcome::ok; ++row) {
            if (out.energy) {
                write_energy(out, row, stored(), m_.supplied, m_.dissipated);
                m_.supplied = m_.dissipated = 0;
            }
            if (!row_(m_, out, row)) return {};
        }
        return m_.status;
    }
    int dofs() const override { return string_->dofs(); }
    std::vector<FreeMode> free_modes() const override { return string_->free_modes(); }
    std::vector<Fact> facts() const override {
        std::vector<Fact> f = string_->facts();
        f.insert(f.begin(), {facts::start_phase_offset, string_->start_phase_offset()});
        if (!barrier_) return f;
        f.push_back({facts::smallest_contact_force, m_.range.least});
        f.push_back({facts::largest_contact_force, m_.range.most});
        f.push_back({facts::deepest_penetration, m_.depth});
        if (points().series) f.push_back({facts::series_compliance, m_.series.C_bb});
        if (m_.barrier.alpha == 1) return f;
        f.push_back({facts::contact_iterations_mean,
                     m_.step > 0 ? m_.iterations / static_cast<double>(m_.step) : 0});
        f.push_back({facts::contact_iterations_most, m_.iterations_most});
        return f;
    }

private:
    const StringPoints& points() const { return string_->points(); }
    double pluck_now() const {
        const long n = m_.step - m_.pluck_first;
        return n >= 0 && n < static_cast<long>(pluck_now_.size()) ? pluck_now_[n] : 0;
    }

    // Stored energy (49). While a pluck acts, what its force alone and together with others stores
    // in C is left out, and its work counted to match.
    double stored() const noexcept {
        const double F_e = pluck_now(), y_b = m_.y_b + m_.series.D_b + m_.series.C_be * F_e,
                     y_c = m_.y_c + m_.series.D_c + m_.series.C_ce * F_e;
        double H = string_->stored() + m_.series.stored();
        if (barrier_) H += m_.barrier.potential(m_.h_b - y_b);
        if (thread_) H += 0.5 * m_.k_c * (m_.h_c - y_c) * (m_.h_c - y_c);
        return H;
    }
    void add_tap(std::size_t k, const TwoPointModes::TapOfModes& of) {
        const StringPoints& p = points();
        TwoPointTap tap{of.on_y.empty() ? nullptr : of.on_y.data(),
                        of.on_u.empty() ? nullptr : of.on_u.data()};
        // 1 N of the contact, of the thread
        const double none[2] = {}, b[2] = {1, 0}, c[2] = {barrier_ ? 0.0 : 1.0, 1};
        if (barrier_) tap.on_b = heard_force(of.quantity, p, b);
        if (thread_) tap.on_c = heard_force(of.quantity, p, c);
        if (barrier_ && p.series) tap.on_P_b = p.series->on_tap(k, b, 0);
        if (thread_ && p.series) tap.on_P_c = p.series->on_tap(k, c, 0);
        if (p.series) tap.on_e = p.series->on_tap(k, none, 1);
        taps_.push_back(tap);
    }

    std::unique_ptr<TwoPointModes> string_;
    const bool barrier_ = points().contacts.count() == 1, thread_ = !points().threads.empty();
    // at the instants of the pluck's steps; where something is in series [N]
    std::vector<double> pluck_now_;
    std::vector<TwoPointTap> taps_;
    TwoPoint m_;
    TwoPointRow row_ = nullptr;
};

template <TwoPointLaw law>
std::unique_ptr<Scheme> made(const Descriptor& descriptor, const Scene& scene,
                             const Settings& settings) {
    const Features needed = needed_by(scene);
    if (!needed.has(Feature::moving_body) && !needed.any(any_rigid) &&
        touches_once_without_loss(scene.strings.front()))
        return std::make_unique<ModalTwoPoint>(
            std::make_unique<TwoPointModes>(descriptor, scene, settings, law),
            steps_per_row(settings));
    matched_without_loss(descriptor, scene, settings);
    return on_its_support<TwoPointModes, GradientRule>(
        descriptor, scene, settings,
        [&](const Scene& one) {
            return std::make_unique<TwoPointModes>(descriptor, one, settings, law);
        },
        [&] { return TwoPointBody(scene.body->modes, 1 / settings.sample_rate, law); });
}

template <class Rule>
std::unique_ptr<Scheme> made_by(const Descriptor& descriptor, const Scene& scene,
                                const Settings& settings) {
    matched_without_loss(descriptor, scene, settings);
    return driven<Rule>(
        std::make_unique<TwoPointModes>(descriptor, scene, settings, exact_two_point), descriptor,
        settings);
}

}  // namespace

extern const Descriptor modal_two_point = {
    .name = "modal_two_point",
    .source = "van Walstijn et al. 2016, eqs 16-52",
    .represents = modal_features_of_points | Feature::moving_body | any_rigid,
    .balance = Balance::exact,
    .clock = Clock::stepped,
    .make = made<exact_two_point>,
    .options = matched_options,
    .approximates = modal_approximates,
    .stand_in_rank = 2};
extern const Descriptor modal_two_point_trapezoidal = {
    .name = "modal_two_point_trapezoidal",
    .source = "van Walstijn et al. 2016, eq 32: coefficients not replaced (dispersive control)",
    .represents = modal_features_of_points | any_rigid,
    .balance = Balance::exact,
    .clock = Clock::stepped,
    .make = made<trapezoidal>,
    .options = matched_options,
    .approximates = modal_approximates};

#define JVARI_MAKER_BY(name, Rule, source) made_by<Rule>,
extern const Descriptor modal_quadratised;
extern const StringRow modal_two_point_row;
const StringRow modal_two_point_row = {
    &modal_two_point, {JVARI_RULES(JVARI_MAKER_BY)}, {{"quadratised", &modal_quadratised}}};

}  // namespace jvari

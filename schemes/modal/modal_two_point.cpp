// The modal two-point scheme: van Walstijn, Bridges & Mehes 2016, eqs 16-52 (the update in the form of modal_two_point_kernel.hpp).
//
// Exact modal frequencies and decay by the coefficients of eq 33; the thread eliminated by eqs 45-47; one barrier, whose force is the
// two-point discrete gradient of eq 30. Starts from rest with q = 0 as in the paper: with losses that is not quite the true rest, a freely
// decaying mode begins with a small phase offset (fact `start_phase_offset`); without losses free motion is exact to rounding.
// Option `compliance` = own (default, the paper's scheme) | matched: what truncation and step take from the string's compliance stands in
// series with barrier and thread (contact/compliance.hpp), and its part is added to displacement and nut force.
// `modal_two_point_trapezoidal` is the same with the coefficients a_i, b_i of eq 32 not replaced: stable, and dispersive.
// These are the kernels of one contact. Profiles, several barriers, contact loss and a moving body: the same string as two_point_modes.hpp,
// by the driver. Leaves out: contact loss and a moving body with compliance=matched; polarisation.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "scenes/excitation.hpp"
#include "scenes/modes.hpp"
#include "schemes/aligned.hpp"
#include "schemes/body/body_modes.hpp"
#include "schemes/body/instrument.hpp"
#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/contact/rigid_rule.hpp"
#include "schemes/driver/pairings.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/kernels/modal_two_point_kernel.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/modal_string.hpp"
#include "schemes/modal/two_point_modes.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

namespace {

using Coefficients = TwoPointCoefficients;
using Law = TwoPointLaw;

Coefficients trapezoidal(double omega0, double sigma, double dt) {  // a_i, b_i of (32)
    return {0.25 * omega0 * omega0 * dt * dt, sigma * dt};
}

constexpr Option two_point_options[] = {compliance_option, profile_points_option};

class ModalTwoPoint final : public Scheme {
public:
    ModalTwoPoint(const Descriptor& descriptor, const Scene& scene, const Settings& settings, Law law) {
        const bool matched = choice_option(settings, compliance_option) == "matched";
        const String& s = scene.strings.front();
        m_.steps_per_row = steps_per_row(settings);
        m_.dt = 1 / settings.sample_rate;
        const Modes modes = modes_of(s, settings);
        refuse_above_nyquist(descriptor, modes, settings.sample_rate);
        m_.modes = modes.count();
        m_.size = (m_.modes + two_point_padding - 1) / two_point_padding * two_point_padding;

        const double xi = m_.dt * m_.dt / (2 * modes.mass);
        std::vector<double> A, B, c, loss, all_J, inverse_J, scale;  // scale = sqrt(J/xi)
        for (int i = 0; i < m_.modes; ++i) {
            const auto [Ai, Bi] = law(modes.omega0[i], modes.sigma[i], m_.dt);
            const double J = 1 + Ai + Bi;
            A.push_back(Ai);
            B.push_back(Bi);
            c.push_back(4 * Ai / J);
            loss.push_back(2 * Bi / J);
            all_J.push_back(J);
            inverse_J.push_back(1 / J);
            scale.push_back(std::sqrt(J / xi));
        }
        stream_ = AlignedVector(static_cast<std::size_t>(m_.size) * two_point_columns);
        m_.stream = stream_.data();
        put(TwoPointColumn::c, keep(c));
        put(TwoPointColumn::loss, keep(loss));
        m_.J = keep(all_J);

        std::vector<double> y0 = initial_displacement(modes, s), u0 = y0;
        for (int i = 0; i < m_.modes; ++i) {
            y0[i] *= scale[i];
            u0[i] = -2 * A[i] / (1 + A[i] + B[i]) * y0[i];  // (42) with q = 0
            free_.push_back(two_point_mode(A[i], B[i], m_.dt));
            offset_ = std::max(offset_, start_phase_offset(modes.omega0[i], modes.sigma[i], A[i], B[i]));
        }
        y0_ = keep(y0);
        u0_ = keep(u0);

        const auto unscaled = [&scale](std::vector<double> w) {
            for (std::size_t i = 0; i < w.size(); ++i) w[i] /= scale[i];
            return w;
        };
        if (!s.barriers.empty()) {
            const auto& b = std::get<LumpedBarrier>(s.barriers.front());
            const auto g = footprint_weights(modes, b.position, b.width);
            double own = 0, truth = 0;
            for (int i = 0; i < m_.modes; ++i) truth += g[i] * g[i] / (modes.mass * modes.omega0[i] * modes.omega0[i]);
            for (int i = 0; i < m_.modes; ++i) own += 0.5 * xi * g[i] * g[i] / A[i];  // (42) with s = 0
            compliance_ = own / truth;
            g_b_ = keep(unscaled(g));
            put(TwoPointColumn::g_b, g_b_);
            m_.barrier = {b.stiffness.k, b.exponent};
            m_.h_b = b.height;
            m_.theta = two_point_dot(g_b_, g_b_, m_.size);
        }
        if (s.thread) {
            g_c_ = keep(unscaled(footprint_weights(modes, s.thread->position, s.thread->width)));
            put(TwoPointColumn::g_c, g_c_);
            m_.k_c = s.thread->stiffness;
            m_.r_c = s.thread->damping;
            m_.h_c = s.thread->height;
            m_.theta_cc = two_point_dot(g_c_, g_c_, m_.size);
            if (g_b_) m_.theta_bc = two_point_dot(g_b_, g_c_, m_.size);
        }
        if (s.pluck) {
            m_.g_e = keep(unscaled(footprint_weights(modes, s.pluck->position, s.pluck->width)));
            if (g_b_) m_.theta_be = two_point_dot(g_b_, m_.g_e, m_.size);
            if (g_c_) m_.theta_ce = two_point_dot(g_c_, m_.g_e, m_.size);
            const PluckSteps steps = pluck_steps(*s.pluck, m_.dt);
            m_.pluck_first = steps.first;
            m_.pluck_steps = steps.count;
            for (long n = m_.pluck_first; n < m_.pluck_first + m_.pluck_steps; ++n)
                pluck_.push_back(0.5 * (force(*s.pluck, n * m_.dt) + force(*s.pluck, (n + 1) * m_.dt)));
            m_.pluck = pluck_.data();
        }
        for (const Tap& tap : scene.taps) {
            using From = TwoPointTap::From;
            switch (tap.quantity) {
                case Quantity::displacement:
                    taps_.push_back({From::modes, keep(unscaled(displacement_weights(modes, tap.position)))});
                    break;
                case Quantity::nut_force: taps_.push_back({From::modes, keep(unscaled(nut_force_weights(modes, s)))}); break;
                case Quantity::velocity: {  // p/m = 2q/dt, q = J u/2 + A y
                    std::vector<double> on_y = unscaled(displacement_weights(modes, tap.position)), on_u = on_y;
                    for (int i = 0; i < m_.modes; ++i) {
                        on_u[i] /= m_.dt * inverse_J[i];
                        on_y[i] *= 2 * A[i] / m_.dt;
                    }
                    taps_.push_back({From::modes_and_increment, keep(on_y), keep(on_u)});
                    break;
                }
                case Quantity::bridge_force: taps_.push_back({From::bridge}); break;
                case Quantity::thread_force: taps_.push_back({From::thread}); break;
                case Quantity::driving_force: taps_.push_back({From::driving}); break;
            }
        }
        m_.taps = taps_;
        if (matched) put_in_series(descriptor, scene, modes, A);
        if (s.thread) {
            const double theta[] = {m_.theta, m_.theta_bc, m_.theta_bc, m_.theta_cc};
            const EliminatedThreads thread({*s.thread}, 1, theta, m_.dt);
            m_.phi_c = thread.one().phi;
            m_.inverse_c = thread.one().inverse;
            m_.beta_c = thread.one().answer;
            m_.theta = thread.between_contacts(theta).front();
        }
        const ContactKind kind = !g_b_ ? ContactKind::none : m_.barrier.alpha == 1 ? ContactKind::linear : ContactKind::power;
        advance_ = two_point_kernel(kind, g_c_ != nullptr, matched ? Compliance::matched : Compliance::own);
        ModalTwoPoint::reset();
    }

    void reset() noexcept override {
        put(TwoPointColumn::y, y0_);
        put(TwoPointColumn::u, u0_);
        m_.step = 0;
        m_.series.points.clear();
        m_.y_b = g_b_ ? two_point_dot(g_b_, y0_, m_.size) : 0;
        m_.u_b = g_b_ ? two_point_dot(g_b_, u0_, m_.size) : 0;
        m_.y_c = g_c_ ? two_point_dot(g_c_, y0_, m_.size) : 0;
        m_.u_c = g_c_ ? two_point_dot(g_c_, u0_, m_.size) : 0;
        m_.impulse_b = m_.impulse_c = m_.supplied = m_.dissipated = m_.iterations = m_.iterations_most = 0;
        m_.least_force = m_.most_force = m_.depth = 0;
        m_.status = {};
    }
    Status advance(const Block& out) noexcept override { return advance_(m_, out); }
    int dofs() const override { return 2 * m_.modes; }
    std::vector<FreeMode> free_modes() const override { return free_; }
    std::vector<Fact> facts() const override {
        std::vector<Fact> f = {{facts::start_phase_offset, offset_}};
        if (g_b_) {
            f.push_back({facts::smallest_contact_force, m_.least_force});
            f.push_back({facts::largest_contact_force, m_.most_force});
            f.push_back({facts::deepest_penetration, m_.depth});
            f.push_back(matched_ ? Fact{facts::series_compliance, m_.series.points.C_bb} : Fact{facts::static_compliance, compliance_});
        }
        if (g_b_ && m_.barrier.alpha != 1) {
            f.push_back({facts::contact_iterations_mean, m_.step > 0 ? m_.iterations / static_cast<double>(m_.step) : 0});
            f.push_back({facts::contact_iterations_most, m_.iterations_most});
        }
        return f;
    }

private:
    // Phase [rad] by which a mode released with q = 0 leads the true motion released at rest: q/y = tanh(s dt/2) on the discrete mode
    // z = exp(s dt), where the true motion has s dt/2.
    static double start_phase_offset(double omega0, double sigma, double A, double B) {
        if (omega0 <= sigma) return 0;
        const double J = 1 + A + B, real = (1 - A) / J, square = (1 + A - B) / J - real * real;  // z of (35)
        if (square <= 0) return 0;
        const std::complex<double> z(real, std::sqrt(square)), t = (z - 1.0) / (z + 1.0), s = std::log(z);
        return std::abs(std::atan2(t.real(), t.imag()) - std::atan2(s.real(), s.imag()));
    }

    const double* keep(const std::vector<double>& v) {  // padded with zeros, for the life of the scheme
        kept_.emplace_back(m_.size);
        std::copy(v.begin(), v.end(), kept_.back().data());
        return kept_.back().data();
    }

    void put(TwoPointColumn column, const double* values) {
        for (int i = 0; i < m_.size; ++i) m_.stream[two_point_at(column, i)] = values[i];
    }

    // docs/compliance-matching.md: the constants of the points' step, from C over barrier, thread and pluck.
    void put_in_series(const Descriptor& descriptor, const Scene& scene, const Modes& modes, const std::vector<double>& A) {
        std::vector<double> own;
        own.reserve(A.size());
        for (const double Ai : A) own.push_back(m_.dt * m_.dt / (4 * modes.mass * Ai));  // (42) with s = 0
        const MissingCompliance C = modal_compliance(descriptor, scene, modes, m_.dt, own);
        for (std::size_t k = 0; k < taps_.size(); ++k) taps_[k].on_force = C.taps[k];
        matched_ = true;
        ResidualPair& z = m_.series.points = ResidualPair(C, m_.dt);
        m_.theta += z.K_bb;
        m_.theta_bc += z.K_bc;
        m_.theta_cc += z.K_cc;
        if (m_.g_e) {
            const Pluck& pluck = *scene.strings.front().pluck;
            for (long n = m_.pluck_first; n <= m_.pluck_first + m_.pluck_steps; ++n) pluck_now_.push_back(force(pluck, n * m_.dt));
            m_.series.pluck = pluck_now_.data();
        }
    }

    TwoPoint m_;
    bool matched_ = false;
    std::vector<double> pluck_now_;
    TwoPointAdvance advance_ = nullptr;
    double offset_ = 0;
    double compliance_ = 0;  // under a steady force at the bridge, relative to the true one of the same modes
    std::vector<FreeMode> free_;
    AlignedVector stream_;
    const double *g_b_ = nullptr, *g_c_ = nullptr;  // barrier and thread; nullptr where the scene has none
    std::vector<AlignedVector> kept_;
    const double *y0_ = nullptr, *u0_ = nullptr;
    std::vector<double> pluck_;
    std::vector<TwoPointTap> taps_;
};

// All barriers rigid, none of them moved by a body, and none above the string at its start.
std::unique_ptr<Scheme> made_rigid(const Descriptor& descriptor, const Scene& scene, const Settings& settings, Law law) {
    const auto refuse = [&](const std::string& why) { throw Refusal(std::string(descriptor.name) + ": " + why); };
    for (const Barrier& b : scene.strings.front().barriers)
        if (const auto* lumped = std::get_if<LumpedBarrier>(&b); !lumped || lumped->stiffness.k != rigid)
            refuse("a rigid barrier beside one that gives way; make all of them rigid, or give each a stiffness");
    if (needed_by(scene).has(Feature::moving_body)) refuse("leaves out a rigid barrier of a string on a moving body");
    matched_without_loss(descriptor, scene, settings);
    auto string = std::make_unique<TwoPointModes>(descriptor, scene, settings, law);
    string->reset();
    const StringPoints& p = string->points();
    std::vector<double> start(p.count());
    string->reading(0, start.data());
    for (int a = 0; a < p.contacts.count(); ++a)
        if (const double inside = p.contacts.heights[a] - start[a]; inside > 1e-12 * p.length)
            refuse("the string starts " + std::to_string(inside * 1e6) + " um inside a rigid barrier; lower the barrier or start above it");
    return std::make_unique<Driver<TwoPointModes, RigidRule>>(std::move(string), steps_per_row(settings));
}

template <Law law>
std::unique_ptr<Scheme> made(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    if (needed_by(scene).has(Feature::rigid_barrier)) return made_rigid(descriptor, scene, settings, law);
    if (!needed_by(scene).has(Feature::moving_body) && touches_once_without_loss(scene.strings.front()))
        return std::make_unique<ModalTwoPoint>(descriptor, scene, settings, law);
    matched_without_loss(descriptor, scene, settings);
    return on_its_support<TwoPointModes, GradientRule>(
        scene, steps_per_row(settings), [&](const Scene& one) { return std::make_unique<TwoPointModes>(descriptor, one, settings, law); },
        [&] { return TwoPointBody(scene.body->modes, 1 / settings.sample_rate, law); });
}

template <class Rule>
std::unique_ptr<Scheme> made_by(const Descriptor& descriptor, const Scene& scene, const Settings& settings) {
    matched_without_loss(descriptor, scene, settings);
    return std::make_unique<Driver<TwoPointModes, Rule>>(std::make_unique<TwoPointModes>(descriptor, scene, settings, exact_two_point),
                                                         steps_per_row(settings));
}

constexpr Features two_point_features = modal_features | Features(Feature::profile_barrier) | Features(Feature::several_barriers) |
                                        Features(Feature::contact_loss) | Feature::moving_body | Feature::rigid_barrier;
constexpr Approximation two_point_approximates[] = {{Feature::profile_barrier, facts::contact_points}};
}  // namespace

extern const Descriptor modal_two_point = {.name = "modal_two_point",
                                           .source = "van Walstijn et al. 2016, eqs 16-52",
                                           .represents = two_point_features,
                                           .balance = Balance::exact,
                                           .clock = Clock::stepped,
                                           .make = made<exact_two_point>,
                                           .options = two_point_options,
                                           .approximates = two_point_approximates,
                                           .stand_in_rank = 2};
extern const Descriptor modal_two_point_trapezoidal = {
    .name = "modal_two_point_trapezoidal",
    .source = "van Walstijn et al. 2016, eq 32: coefficients not replaced (dispersive control)",
    .represents = two_point_features - Feature::moving_body,
    .balance = Balance::exact,
    .clock = Clock::stepped,
    .make = made<trapezoidal>,
    .options = two_point_options,
    .approximates = two_point_approximates};

#define JVARI_MAKER_BY(name, Rule, source) made_by<Rule>,
extern const Descriptor modal_quadratised;
extern const StringRow modal_two_point_row;
const StringRow modal_two_point_row = {&modal_two_point, {JVARI_RULES(JVARI_MAKER_BY)}, {{"quadratised", &modal_quadratised}}};

}  // namespace jvari

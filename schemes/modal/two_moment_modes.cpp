#include "schemes/modal/two_moment_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/excitation.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal_coefficients.hpp"

namespace jvari {

template class Driver<TwoMomentModes>;

using std::numbers::pi;

namespace {
using Moments = TwoMomentStream;

PluckMoments pluck_moments(const Pluck& e, long n, double dt) {
    const double t = static_cast<double>(n) * dt;
    return {mean_force(e, t, dt), first_moment(e, t, dt)};
}
}  // namespace

// Computes cos 2z = cos(omega H)/cosh(sigma H), with cosh in place of cos for an overdamped mode.
// The half angle keeps all digits of low modes. The branch is that of omega H.
ExactMode::ExactMode(double mass, double omega0, double sigma, double H)
    : kappa(std::sqrt(mass) * omega0) {
    const double square = omega_squared_damped(omega0, sigma),
                 decay = std::min(sigma * H, 300.0),  // a mode that decays within a step
        turns = std::sqrt(std::abs(square)) * H, half = 0.5 * turns, grows = std::cosh(decay),
                 damped = std::pow(std::sinh(0.5 * decay), 2);
    delta = std::exp(-2 * decay);
    if (square > 0) {
        const double s = std::sqrt((damped + std::pow(std::sin(half), 2)) / grows),
                     c = std::sqrt((damped + std::pow(std::cos(half), 2)) / grows),
                     branch = std::floor(turns / pi);
        z = std::fmod(branch, 2) == 1 ? 0.5 * (branch + 1) * pi - std::atan2(s, c)
                                      : 0.5 * branch * pi + std::atan2(s, c);
        lead = std::abs(std::atan2(std::cos(turns) * std::tanh(decay), std::sin(turns)) -
                        std::atan2(sigma * std::sin(turns), std::sqrt(square) * std::sin(turns)));
        // difference between two squares, or between squared sinh values, written as a product
    } else {
        const double gamma = std::min(turns, decay),
                     slow = std::min(0.5 * std::pow(omega0 * H, 2) / (sigma * H + turns), decay);
        z = std::atan2(std::sqrt(std::sinh(0.5 * (decay + gamma)) * std::sinh(slow) / grows),
                       std::sqrt((damped + std::pow(std::cosh(0.5 * gamma), 2)) / grows));
    }
    sine = std::sin(z), cosine = std::cos(z);
    by_v = 0.5 * H * std::exp(-decay) / z;
}

double ExactMode::p_1() const {
    const double z_2 = z * z;
    double S_1 = 2 * (sine / z - cosine);
    if (z < 0.1)
        S_1 =
            2 * z_2 *
            (1.0 / 3 - z_2 * (1.0 / 30 - z_2 * (1.0 / 840 - z_2 * (1.0 / 45360 - z_2 / 3991680))));
    return -S_1 / kappa;
}

TwoMomentModes::TwoMomentModes(const Descriptor& descriptor, const Scene& scene,
                               const Settings& settings)
    : dt_(1 / settings.sample_rate) {
    const String& s = scene.strings.front();
    const Modes modes = modes_of(s, settings);
    const int count = m_.modes = modes.count();
    m_.size = (count + modal_padding - 1) / modal_padding * modal_padding;
    std::vector<double> own;
    for (auto* v : {&a0_, &b0_}) v->assign(m_.size, 0.0);
    for (int i = 0; i < count; ++i) {
        const double omega0 = modes.omega0[i], sigma = modes.sigma[i],
                     square = omega_squared_damped(omega0, sigma);
        offset_ = std::max(offset_, modes_.emplace_back(modes.mass, omega0, sigma, dt_).lead);
        own.push_back(1 / (modes.mass * omega0 * omega0));
        free_modes_.push_back({square > 0 ? std::sqrt(square) : 0, sigma});
    }
    p_ = points_of(scene, dt_);
    add_lumped(p_, s);
    const auto measured = modes_measured(s);  // none of these may be cut
    if (choice_option(settings, compliance_option) == "matched" &&
        !(measured && *measured <= count))
        p_.series = modal_missing_matrix(descriptor, scene, modes, 0, own);
    const ModalStart start = start_of(modes, s, yield_of(own, p_.series));
    put_start(p_, s, modes, start);
    put_points(modes, scene);
    for (int i = 0; i < count; ++i) begin(i, start.displacement[i], start.velocity[i]);
    put_taps(modes, scene);
    free_.assign(2 * static_cast<std::size_t>(p_.count()), 0.0);
    free_sums_.assign(TwoMomentStream::line * free_.size(), 0.0);
    m_.free = free_sums_.data();
    pass_ = two_moment_pass(m_.points, m_.thread);
    reset();
}

TwoMomentModes::Reading TwoMomentModes::reading_of(const std::vector<double>& weights,
                                                   bool velocity) const {
    Reading r{AlignedVector(m_.size), AlignedVector(m_.size)};
    for (int i = 0; i < m_.modes; ++i) {
        const ExactMode& e = modes_[i];
        const double w = weights[i] / e.kappa;
        // y = (a c - b s)/kappa; the damped velocity over w is (a s + b c)/kappa = by_v v
        r.on_a[i] = velocity ? w * e.sine / e.by_v : w * e.cosine;
        r.on_b[i] = velocity ? w * e.cosine / e.by_v : -w * e.sine;
    }
    return r;
}

void TwoMomentModes::put_points(const Modes& modes, const Scene& scene) {
    const int P = m_.points = p_.count(), D = 2 * P;
    m_.thread = !p_.threads.empty();
    stream_.assign(static_cast<std::size_t>(m_.size) * m_.columns(), 0.0);
    m_.stream = stream_.data();
    const auto put = [&](int column, const auto& of) {
        for (int i = 0; i < m_.modes; ++i) stream_[m_.at(column, i)] = of(i);
    };
    put(Moments::A11, [&](int i) {
        const ExactMode& e = modes_[i];
        return e.cosine * e.cosine - e.delta * e.sine * e.sine;
    });
    put(Moments::A12, [&](int i) {
        const ExactMode& e = modes_[i];
        return (1 + e.delta) * e.sine * e.cosine;
    });
    put(Moments::A22, [&](int i) {
        const ExactMode& e = modes_[i];
        return e.delta * e.cosine * e.cosine - e.sine * e.sine;
    });
    const Sites sites = sites_of(scene);
    std::vector<std::vector<double>> g;
    for (int p = 0; p < P; ++p) {
        const Footprint& f = sites.forces[p];
        g.push_back(footprint_weights(modes, f));
        put(Moments::weights + p, [&](int i) { return g[p][i] * modes_[i].p_0(); });
        put(Moments::weights + P + p, [&](int i) { return g[p][i] * modes_[i].p_1(); });
        readings_.push_back(reading_of(g[p], false));
    }
    p_.theta.assign(static_cast<std::size_t>(D) * D, 0.0);
    for (int p = 0; p < P; ++p)
        for (int q = 0; q < P; ++q) {
            const MomentMatrix T = compliance(g[p], g[q]);
            p_.theta[p * D + q] = T.m00, p_.theta[p * D + P + q] = T.m01;
            p_.theta[(P + p) * D + q] = T.m10, p_.theta[(P + p) * D + P + q] = T.m11;
        }
    if (const auto& pluck = scene.strings.front().pluck)
        put_pluck(modes, *pluck, scene.duration, g);
}

// Sums are rounded once: an error in Theta would enter the balance in every step.
MomentMatrix TwoMomentModes::compliance(const std::vector<double>& g,
                                        const std::vector<double>& h) const {
    long double even = 0, odd = 0, turned = 0;
    for (int i = 0; i < m_.modes; ++i) {
        const ExactMode& e = modes_[i];
        const long double both = static_cast<long double>(g[i]) * h[i];
        even += 0.5L * e.p_0() * e.p_0() * both;
        odd += 0.5L * e.p_1() * e.p_1() * both;
        turned += e.cosine / e.kappa * e.p_1() * both;
    }
    return {static_cast<double>(even), static_cast<double>(turned), static_cast<double>(-turned),
            static_cast<double>(odd)};
}

void TwoMomentModes::put_pluck(const Modes& modes, const Pluck& pluck, double duration,
                               const std::vector<std::vector<double>>& g) {
    const int P = m_.points;
    const auto g_e = footprint_weights(modes, pluck.position, pluck.width);
    for (auto* v : {&pluck_.p_0, &pluck_.p_1}) v->assign(m_.size, 0.0);
    for (int i = 0; i < m_.modes; ++i) {
        pluck_.p_0[i] = g_e[i] * modes_[i].p_0();
        pluck_.p_1[i] = g_e[i] * modes_[i].p_1();
    }
    pluck_.theta.resize(P);
    for (int p = 0; p < P; ++p) pluck_.theta[p] = compliance(g[p], g_e);
    const PluckSteps steps = pluck_steps(pluck, dt_, duration);
    pluck_.of = pluck;
    pluck_.first_step = steps.first;
    pluck_.steps = steps.count;
    for (long n = steps.first; n < steps.first + steps.tabulated; ++n)
        pluck_.moments.push_back(pluck_moments(pluck, n, dt_));
}

void TwoMomentModes::put_taps(const Modes& modes, const Scene& scene) {
    for (const Tap& tap : scene.taps) {
        TapOfModes t;
        if (const auto w = tap_weights(tap, modes, scene.strings.front()); !w.empty())
            t.on_modes = reading_of(w, tap.quantity == Quantity::velocity);
        std::vector<double> one(p_.count());  // 1 N at each point
        for (int p = 0; t.on_modes.on_a.empty() && p < p_.count(); one[p++] = 0) {
            one[p] = 1;
            t.on_mean.push_back(heard_force(tap.quantity, p_, one.data()));
        }
        taps_.push_back(std::move(t));
    }
}

void TwoMomentModes::begin(int i, double displacement, double velocity) noexcept {
    const ExactMode& e = modes_[i];
    const double y = e.kappa * displacement, u = e.kappa * e.by_v * velocity;
    a0_[i] = y * e.cosine + u * e.sine;
    b0_[i] = u * e.cosine - y * e.sine;
}

ModalState TwoMomentModes::state() const {
    ModalState state;
    for (int i = 0; i < m_.modes; ++i) {
        const auto [y, u] = at_row(i);
        state.displacement.push_back(y / modes_[i].kappa);
        state.velocity.push_back(u / (modes_[i].kappa * modes_[i].by_v));
    }
    return state;
}

bool TwoMomentModes::start_from(const TwoMomentModes& before) noexcept {
    if (before.m_.modes != m_.modes) return false;
    for (int i = 0; i < m_.modes; ++i) {
        const ExactMode& e = before.modes_[i];
        const auto [y, u] = before.at_row(i);
        begin(i, y / e.kappa, u / (e.kappa * e.by_v));
    }
    return true;
}

void TwoMomentModes::reset() noexcept {
    for (int i = 0; i < m_.size; ++i) {
        stream_[m_.at(Moments::a, i)] = a0_[i];
        stream_[m_.at(Moments::b, i)] = b0_[i];
    }
    step_ = 0;
    sum_ = 0;
    for (int p = 0; p < m_.points; ++p) {
        free_sums_[p] = free_sums_[m_.points + p] = 0;
        for (int i = 0; i < m_.modes; ++i) {
            free_sums_[p] += at(Moments::weights + p, i) * b0_[i];
            free_sums_[m_.points + p] += at(Moments::weights + m_.points + p, i) * a0_[i];
        }
    }
}

void TwoMomentModes::approach(bool) noexcept {
    const long k = step_ - pluck_.first_step;
    const bool plucked = k >= 0 && k < pluck_.steps;
    const PluckMoments F = !plucked                         ? PluckMoments{}
                           : k < std::ssize(pluck_.moments) ? pluck_.moments[k]
                                                            : pluck_moments(pluck_.of, step_, dt_);
    F_0_ = F.mean, F_1_ = F.first;
    const int P = m_.points;
    for (int p = 0; p < 2 * P; ++p) free_[p] = free_sums_[p];
    sum_ = 0;
    for (int p = 0; p < P; ++p) {
        sum_ += free_[p];
        if (!plucked) continue;
        const MomentMatrix& T = pluck_.theta[p];
        free_[p] += T.m00 * F_0_ + T.m01 * F_1_;
        free_[P + p] += T.m10 * F_0_ + T.m11 * F_1_;
    }
}

// Energies: the forces' work on the modes, the pluck's share in that work, and the modes' loss by
// the damping at both ends of the step.
Spent TwoMomentModes::spent(const double* force) const noexcept {
    const int P = m_.points;
    Spent all;
    double r_0 = 0, r_1 = 0;  // at the pluck's point
    for (int p = 0; p < P; ++p) {
        const MomentMatrix& T = pluck_.theta.empty() ? MomentMatrix{} : pluck_.theta[p];
        r_0 += T.m01 * force[P + p];
        r_1 += T.m10 * force[p];
    }
    for (int i = 0; i < m_.modes; ++i) {
        const ExactMode& e = modes_[i];
        const auto [y, u] = at_row(i);
        double kick_a = 0, kick_b = 0;
        for (int p = 0; p < P; ++p) {
            kick_b += at(Moments::weights + p, i) * force[p];
            kick_a += at(Moments::weights + P + p, i) * force[P + p];
        }
        const double a = at(Moments::a, i), b = at(Moments::b, i);
        if (F_0_ != 0 || F_1_ != 0) {
            kick_b += pluck_.p_0[i] * F_0_, kick_a += pluck_.p_1[i] * F_1_;
            r_0 += pluck_.p_0[i] * (b + 0.5 * kick_b), r_1 += pluck_.p_1[i] * (a + 0.5 * kick_a);
        }
        const double v = (b + kick_b) * e.cosine - (a + kick_a) * e.sine;  // at the end
        all.dissipated += 0.5 * ((1 / e.delta - 1) * u * u + (1 - e.delta) * v * v);
    }
    all.supplied = F_0_ * r_0 + F_1_ * r_1;
    return all;
}

Spent TwoMomentModes::pass(const double* force, double, bool probed) noexcept {
    const Spent all = probed ? spent(force) : Spent{};
    ++step_;
    if (F_0_ != 0 || F_1_ != 0) {
        const std::ptrdiff_t stride = m_.columns() * Moments::line;
        add_to_column<Moments::line>(m_.stream + m_.at(Moments::b, 0), stride, pluck_.p_0, F_0_);
        add_to_column<Moments::line>(m_.stream + m_.at(Moments::a, 0), stride, pluck_.p_1, F_1_);
    }
    pass_(m_, force);
    return all;
}

void TwoMomentModes::reading(int, double* out) const noexcept {
    for (int p = 0; p < m_.points; ++p) out[p] = dot(readings_[p]);
}

// Energy at the row, in the middle of the damping.
double TwoMomentModes::stored() const noexcept {
    double sum = 0;
    for (int i = 0; i < m_.modes; ++i) {
        const auto [y, u] = at_row(i);
        sum += 0.5 * (y * y + u * u / modes_[i].delta);
    }
    return sum;
}

double TwoMomentModes::tap(int k, const double* mean) const noexcept {
    const TapOfModes& t = taps_[k];
    double sum = 0;
    if (!t.on_modes.on_a.empty()) sum += dot(t.on_modes);
    for (std::size_t p = 0; p < t.on_mean.size(); ++p) sum += t.on_mean[p] * mean[p];
    return sum;
}

void TwoMomentModes::fuse(MomentObstacle& obstacle, int steps_per_row) {
    obstacle_ = &obstacle;
    steps_per_row_ = steps_per_row;
    rows_ = two_moment_rows(m_.points, m_.thread, obstacle.has_series());
    force_.assign(3 * static_cast<std::size_t>(m_.points), 0.0);
    for (std::size_t k = 0; k < taps_.size(); ++k) {
        const TapOfModes& t = taps_[k];
        const bool modal = !t.on_modes.on_a.empty(),
                   series = p_.series && m_.points > 0 && !p_.series->taps[k].empty();
        fused_taps_.push_back({modal ? t.on_modes.on_a.data() : nullptr, t.on_modes.on_b.data(),
                               modal ? nullptr : t.on_mean.data(),
                               series ? p_.series->taps[k].data() : nullptr});
    }
}

FusedRows TwoMomentModes::fused_rows(const Block& out, int row, double* sum) noexcept {
    const long rows =
        rows_without_pluck(out.rows - row, step_ - pluck_.first_step, pluck_.steps, steps_per_row_);
    if (!rows_ || rows == 0) return {};
    RowsInHand r{fused_taps_.data(), row, row + static_cast<int>(rows),
                 steps_per_row_,     sum, force_.data() + 2 * m_.points,
                 force_.data()};
    const bool stopped = !rows_(m_, *obstacle_, out, r);
    step_ += r.steps;
    sum_ = 0;
    for (int p = 0; p < m_.points; ++p) sum_ += m_.free[p];
    return {r.end - row, r.steps, r.converged, stopped};
}

}  // namespace jvari

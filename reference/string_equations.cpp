#include "reference/string_equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/masses.hpp"
#include "reference/partial_sums.hpp"
#include "scenes/excitation.hpp"
#include "scenes/pitch.hpp"

namespace jvari {

namespace {
JVARI_CLONES
double dot(const double* g, const double* x, int n) {
    Lanes sum = {};
    for (int i = 0; i < n; i += lanes)
        sum += *reinterpret_cast<const Lanes*>(g + i) * *reinterpret_cast<const Lanes*>(x + i);
    return total(sum);
}

JVARI_CLONES
double square(const double* g, const double* x, int n) {  // sum g x^2
    Lanes sum = {};
    for (int i = 0; i < n; i += lanes) {
        const Lanes v = *reinterpret_cast<const Lanes*>(x + i);
        sum += *reinterpret_cast<const Lanes*>(g + i) * v * v;
    }
    return total(sum);
}

JVARI_CLONES
void oscillate(const double* omega, const double* damping, const double* p, const double* v,
               double* dp, double* dv, int n) {
    for (int i = 0; i < n; ++i) {
        dp[i] = omega[i] * v[i];
        dv[i] = -(omega[i] * p[i] + damping[i] * v[i]);
    }
}

JVARI_CLONES
void add(const double* d, double F, double* dv, int n) {
    for (int i = 0; i < n; ++i) dv[i] += F * d[i];
}
}  // namespace

StringEquations::StringEquations(const Modes& modes, const String& s,
                                 const std::optional<InSeries>& series)
    : mass_(modes.mass),
      EA_(s.axial_stiffness),
      length_(s.length),
      modes_(modes.count()),
      held_(modes.count() - static_cast<int>(s.masses.size())),
      rests_(s.start && std::holds_alternative<RestStart>(*s.start)) {
    if (series) series_ = SeriesStates(*series, mass_);
    padded = (modes_ + series_.count + lanes - 1) / lanes * lanes;
    const auto pad = [&](std::vector<double>& rows, double value) { rows.push_back(value); };
    const auto fill = [&](std::vector<double>& rows) {
        rows.resize((rows.size() + padded - 1) / padded * padded, 0.0);
    };
    for (int i = 0; i < modes.count(); ++i) {
        pad(omega_, modes.omega0[i < held_ ? i : 0]);
        pad(damping_, 2 * modes.sigma[i]);
        pad(loss_, 2 * modes.mass * modes.sigma[i]);
    }
    falls_ = falling(modes, s);
    for (double& f : falls_) f /= mass_;
    for (int i = 0; i < modes.count() && EA_ > 0; ++i)
        pad(reach_, std::pow((i + 1) * std::numbers::pi / (length_ * modes.omega0[i]), 2));
    for (auto* rows : {&omega_, &damping_, &loss_, &reach_}) fill(*rows);
    const auto add_point = [&](const std::vector<double>& g) {
        for (int i = 0; i < modes.count(); ++i) {
            pad(reads_, g[i] / scale(i));
            pad(weights_, g[i]);
            pad(gains_, g[i] / modes.mass);
        }
        for (auto* rows : {&reads_, &weights_, &gains_}) fill(*rows);
    };
    for (const auto& [b, g] : touched_by(modes, s)) {
        add_point(g);
        point_.push_back({{b.stiffness.k, b.exponent},
                          b.contact_loss,
                          0,
                          b.height,
                          b.loss_law == LossLaw::clipped,
                          b.sign()});
    }
    contacts = static_cast<int>(point_.size());
    if (s.thread) {
        add_point(footprint_weights(modes, s.thread->position, s.thread->width));
        point_.push_back({{s.thread->stiffness, 1}, 0, s.thread->damping, s.thread->height});
    }
    points = static_cast<int>(point_.size());
    if (s.pluck) {
        pluck_.push_back(*s.pluck);
        add_point(footprint_weights(modes, s.pluck->position, s.pluck->width));
        least_scale_ = 1e-2 * std::abs(s.pluck->amplitude) / wave_impedance(s);
    }
    make_workspaces();
    for (int a = 0; a < contacts; ++a)
        for (int b = 0; b < contacts; ++b)
            couples_.push_back(std::abs(dot(row(weights_, a), row(gains_, b), padded)));
}

void StringEquations::make_workspaces() {
    touched.assign(contacts, 0);
    inverse_.assign(padded, 0.0);
    compliance_.assign(static_cast<std::size_t>(points) * points, 0.0);
    small_.assign(static_cast<std::size_t>(points) * (points + 1), 0.0);
    force_.assign(points, 0.0);
    motion_.resize(points);
    pull_.resize(points);
    stiffness_.assign(contacts, 0.0);
    for (auto* v : {&acting_, &speed_, &change_}) v->assign(std::max(points, series_.count), 0.0);
}

void StringEquations::read_series(const double* z, double* series) const noexcept {
    series_.read(states(z), series);
}
void StringEquations::put_series(const double* series, double* z) const noexcept {
    series_.put(series, states(z));
}

StringEquations::Motion StringEquations::motion(int a, const double* z) const noexcept {
    return {dot(row(reads_, a), z, padded) + series_.yield(a, states(z)),
            dot(row(weights_, a), z + padded, padded) + series_.yield_speed(a, states(z))};
}

StringEquations::Pull StringEquations::pull(int a, Motion m) const noexcept {
    const Point& q = point_[a];
    const double eta = q.height - m.y;
    const double k = q.law.k, alpha = q.law.alpha;
    if (a >= contacts) {  // the point's own force moves it by at_once F
        const double own = 1 + q.r * series_.at_once(a), F = (k * eta - q.r * m.v) / own;
        return {F, k / own, q.r / own, q.r, 0};
    }
    const double slope = alpha == 1 ? k : k * std::pow(std::abs(eta), alpha - 1), f = slope * eta,
                 give = 1 - q.beta * m.v;
    if (q.clipped && give < 0) return {0, 0, 0, f / m.v, alpha * slope / m.v};
    // F = f (1 - beta (v + at_once F))
    const double own = 1 + q.beta * f * series_.at_once(a);
    return {f * give / own, alpha * slope * give / (own * own), q.beta * f / own, q.beta * f,
            q.beta * alpha * slope};
}

double StringEquations::penetration(int a, const double* z) const noexcept {
    return point_[a].height - motion(a, z).y;
}
double StringEquations::penetration_speed(int a, const double* z) const noexcept {
    const Motion m = motion(a, z);
    return -m.v - (acts(a) ? series_.at_once(a) * pull(a, m).F : 0);
}
double StringEquations::contact_force(int a, const double* z) const noexcept {
    return pull(a, motion(a, z)).F;
}

void StringEquations::slope(double t, const double* z, double* dz) const noexcept {
    const double *p = z, *v = z + padded;
    double *dp = dz, *dv = dz + padded, *sum = dz + 2 * padded;
    std::fill_n(sum, sums, 0.0);
    oscillate(omega_.data(), damping_.data(), p, v, dp, dv, padded);
    std::copy(falls_.begin() + held_, falls_.end(), dv + held_);
    sum[dissipated] = square(loss_.data(), v, padded);
    if (!reach_.empty()) {
        const double pull = 0.125 * EA_ * length_ * square(reach_.data(), p, padded) / mass_;
        for (int i = 0; i < padded; ++i) dv[i] -= pull * reach_[i] * omega_[i] * p[i];
    }
    std::fill(acting_.begin(), acting_.end(), 0.0);
    for (int a = 0; a < points; ++a) {
        if (!acts(a)) continue;
        const Motion m = motion(a, z);
        const Pull f = pull(a, m);
        acting_[a] = f.F;
        const double speed = m.v + series_.at_once(a) * f.F;
        add(row(gains_, a), f.F, dv, padded);
        sum[a < contacts ? bridge_impulse : thread_impulse] += point_[a].sign * f.F;
        sum[dissipated] += f.drag * speed * speed;
    }
    series_.speed(states(z), acting_.data(), states(dz));
    sum[dissipated] += series_.lost(states(dz), states(dz));
    if (plucked) {
        const double F = jvari::force(
            pluck_[0], pluck_[0].start + std::clamp(pluck_time + t, 0.0, pluck_[0].duration));
        add(row(gains_, points), F, dv, padded);
        sum[supplied] = F * dot(row(weights_, points), v, padded);
    }
}

double StringEquations::potential(int a, double y) const noexcept {
    const double eta = point_[a].height - y;
    if (a < contacts && eta <= 0) return 0;
    return point_[a].law.potential(std::abs(eta));
}

double StringEquations::scale_squared(const double* z) const noexcept {
    double sum = 0, pressed = 0;
    for (int i = 0; i < 2 * padded; ++i) sum += z[i] * z[i];
    for (int a = 0; a < points; ++a)
        if (acts(a)) pressed += potential(a, motion(a, z).y);
    return std::max({sum, 2 * pressed / mass_, 2 * padded * least_scale_ * least_scale_});
}

double StringEquations::rounding(const double* z) const noexcept {
    double most = 0;
    for (int a = 0; rests_ && a < contacts; ++a) {
        if (!touched[a]) continue;
        const double K = std::max(0.0, pull(a, motion(a, z)).K),
                     of_gain =
                         std::abs(point_[a].height) * std::sqrt(K / couples_[a * contacts + a]);
        for (int i = 0; i < padded; ++i)
            most = std::max(most, of_gain * std::abs(row(gains_, a)[i]));
    }
    return std::numeric_limits<double>::epsilon() * most;
}

// Bounds the rate: an impact at speed v on a barrier reaches the depth m v^2/2 = k
// eta^(alpha+1)/(alpha+1), with m = 1/sum(g^2/m_i) the modes' mass there. Points close to each
// other push the same modes: their stiffnesses add up, like Gershgorin's circles.
double StringEquations::pace(const double* z, bool decays) const noexcept {
    double decay = 0;
    for (int a = 0; a < contacts; ++a) {
        stiffness_[a] = 0;
        if (!touched[a]) continue;
        const Point& q = point_[a];
        const double give = couples_[a * contacts + a], v = penetration_speed(a, z);
        const double k = q.law.k, alpha = q.law.alpha;
        const double depth = std::max(
            penetration(a, z), std::pow(v * v * (alpha + 1) / (2 * k * give), 1 / (alpha + 1)));
        stiffness_[a] = k * std::pow(depth, alpha - 1);
        // decay rate for a point without mass
        if (decays) decay = std::max(decay, series_.at_once(a) * q.law.slope(depth));
    }
    double fastest = 0;
    for (int a = 0; a < contacts; ++a) {
        if (!touched[a]) continue;
        double sum = 0;
        for (int b = 0; b < contacts; ++b) sum += couples_[a * contacts + b] * stiffness_[b];
        fastest = std::max(fastest, sum);
    }
    return std::max(std::sqrt(fastest), decay);
}

void StringEquations::solve(double t, double gamma, const double* z, const double* b,
                            double* x) noexcept {
    if (gamma != gamma_) {
        gamma_ = gamma;
        for (int i = 0; i < padded; ++i) {
            const double w = gamma * omega_[i];
            inverse_[i] = 1 / (1 + gamma * damping_[i] + w * w);
        }
        std::fill(inverse_.begin() + held_, inverse_.begin() + modes_, 1.0);
        for (int a = 0; a < points; ++a)
            for (int c = 0; c < points; ++c) {
                double sum = 0;
                for (int i = 0; i < padded; ++i)
                    sum += row(weights_, a)[i] * row(gains_, c)[i] * inverse_[i];
                compliance_[a * points + c] = sum;
            }
        series_.factor(gamma);
    }
    const double *bp = b, *bv = b + padded;
    double *xp = x, *xv = x + padded;
    for (int i = 0; i < padded; ++i) {  // the blocks [1, -gamma w; gamma w, 1 + 2 gamma sigma]
        const double w = gamma * omega_[i], p = bp[i], v = bv[i];
        xp[i] = ((1 + gamma * damping_[i]) * p + w * v) * inverse_[i];
        xv[i] = (v - w * p) * inverse_[i];
    }
    for (int i = held_; i < modes_; ++i) xp[i] = bp[i] + gamma * omega_[i] * bv[i], xv[i] = bv[i];
    series_.solve(states(b), states(x));
    // dF_a = -K_a dy_a - R_a dv_a,   dy_a = (block solution) + gamma^2 S_ab dF_b,   dv_a = (block
    //                                solution) + gamma S_ab dF_b
    const int wide = points + 1;
    for (int a = 0; a < points; ++a) {
        double* equation = small_.data() + a * wide;
        std::fill_n(equation, wide, 0.0);
        equation[a] = 1;
        if (!acts(a)) continue;
        motion_[a] = motion(a, z);
        const Pull f = pull_[a] = pull(a, motion_[a]);
        const Motion d = motion(a, x);
        for (int c = 0; c < points; ++c)
            if (acts(c)) equation[c] += (gamma * f.K + f.R) * gamma * compliance_[a * points + c];
        for (int c = 0; series_.count > 0 && c < points; ++c)
            if (acts(c))
                equation[c] += gamma * (f.K * series_.answer(a, c) * series_.share(a) +
                                        f.R * series_.answer_speed(a, c));
        equation[points] = -f.K * d.y - f.R * d.v;
    }
    // elimination; the matrix is I + (positive diagonal) x (Gram matrix): pivots on the diagonal
    // hold
    for (int c = 0; c < points; ++c) {
        const double* top = small_.data() + c * wide;
        for (int a = c + 1; a < points; ++a) {
            double* equation = small_.data() + a * wide;
            const double factor = equation[c] / top[c];
            if (factor != 0)
                for (int j = c; j < wide; ++j) equation[j] -= factor * top[j];
        }
    }
    for (int a = points - 1; a >= 0; --a) {
        const double* equation = small_.data() + a * wide;
        double F = equation[points];
        for (int c = a + 1; c < points; ++c) F -= equation[c] * force_[c];
        force_[a] = F / equation[a];
    }
    for (int a = 0; a < points; ++a) {
        if (!acts(a)) continue;
        const double* d = row(gains_, a);
        const double F = gamma * force_[a];
        for (int i = 0; i < padded; ++i) {
            const double v = F * d[i] * inverse_[i];
            xv[i] += v;
            xp[i] += gamma * omega_[i] * v;
        }
        for (int j = 0; j < series_.count; ++j) states(x)[j] += F * series_.answer(j, a);
    }
    // the sums' rows
    double* sum = x + 2 * padded;
    std::copy_n(b + 2 * padded, sums, sum);
    const double* v = z + padded;
    double lost = 0;
    for (int i = 0; i < padded; ++i) lost += 2 * loss_[i] * v[i] * xv[i];
    for (int a = 0; a < points; ++a) {
        if (!acts(a)) continue;
        const Motion d = motion(a, x);
        sum[a < contacts ? bridge_impulse : thread_impulse] += point_[a].sign * gamma * force_[a];
        const double at_once = series_.at_once(a), speed = motion_[a].v + at_once * pull_[a].F;
        lost += 2 * pull_[a].drag * speed * (d.v + at_once * force_[a]) -
                pull_[a].drag_slope * speed * speed * d.y;
    }
    for (int a = 0; a < points; ++a) {
        acting_[a] = acts(a) ? pull_[a].F : 0;
        if (!acts(a)) force_[a] = 0;
    }
    series_.speed(states(z), acting_.data(), speed_.data());
    series_.speed(states(x), force_.data(), change_.data());
    lost += 2 * series_.lost(speed_.data(), change_.data());
    sum[dissipated] += gamma * lost;
    if (plucked) {
        const double F = jvari::force(
            pluck_[0], pluck_[0].start + std::clamp(pluck_time + t, 0.0, pluck_[0].duration));
        sum[supplied] += gamma * F * dot(row(weights_, points), xv, padded);
    }
}

}  // namespace jvari

#include "reference/string_equations.hpp"

#include <algorithm>
#include <cmath>

#include "reference/partial_sums.hpp"
#include "scenes/excitation.hpp"

namespace jvari {

namespace {
JVARI_CLONES
double dot(const double* g, const double* x, int n) {
    Lanes sum = {};
    for (int i = 0; i < n; i += lanes) sum += *reinterpret_cast<const Lanes*>(g + i) * *reinterpret_cast<const Lanes*>(x + i);
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
void oscillate(const double* omega, const double* damping, const double* p, const double* v, double* dp, double* dv, int n) {
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

StringEquations::StringEquations(const Modes& modes, const String& s, const std::optional<InSeries>& series) : mass_(modes.mass) {
    padded = (modes.count() + (series && series->relaxes() ? 1 : 0) + lanes - 1) / lanes * lanes;
    const auto pad = [&](std::vector<double>& rows, double value) { rows.push_back(value); };
    const auto fill = [&](std::vector<double>& rows) { rows.resize((rows.size() + padded - 1) / padded * padded, 0.0); };
    for (int i = 0; i < modes.count(); ++i) {
        pad(omega_, modes.omega0[i]);
        pad(damping_, 2 * modes.sigma[i]);
        pad(loss_, 2 * modes.mass * modes.sigma[i]);
    }
    for (auto* rows : {&omega_, &damping_, &loss_}) fill(*rows);
    const SeriesPoints in = series ? series->points : SeriesPoints();
    if (series && series->relaxes()) {
        thread_ = modes.count();
        thread_rate_ = std::sqrt(in.stiff_cc / modes.mass);
        thread_loss_ = in.r_c / (thread_rate_ * thread_rate_);
        damping_[thread_] = in.k_c / in.r_c;
    }
    if (series) pull_back_ = series->pull();
    const auto add_point = [&](const std::vector<double>& g, double own = 0) {  // own: Y_c in what it reads
        for (int i = 0; i < modes.count(); ++i) {
            pad(reads_, g[i] / modes.omega0[i]);
            pad(weights_, g[i]);
            pad(gains_, g[i] / modes.mass);
        }
        if (thread_ >= 0) {
            reads_.push_back(0);
            weights_.push_back(0);
            gains_.push_back(own * thread_rate_ / in.r_c);
            own_.push_back(own / thread_rate_);
        } else own_.push_back(0);
        for (auto* rows : {&reads_, &weights_, &gains_}) fill(*rows);
    };
    std::vector<double> at_thread(modes.count(), 0.0);
    if (s.thread) at_thread = footprint_weights(modes, s.thread->position, s.thread->width);
    for (const Barrier& barrier : s.barriers) {
        const auto& b = std::get<LumpedBarrier>(barrier);
        auto g = footprint_weights(modes, b.position, b.width);
        for (int i = 0; i < modes.count(); ++i) g[i] -= pull_back_ * at_thread[i];
        add_point(g, pull_back_);
        const double lifted = pull_back_ != 0 ? pull_back_ * s.thread->height : 0;
        point_.push_back({SeriesLaw({b.stiffness.k, b.exponent}, in.law.S), b.contact_loss, 0, b.height - lifted});
    }
    contacts = static_cast<int>(point_.size());
    if (s.thread) {
        add_point(at_thread, thread_ >= 0 ? -1 : 0);
        const bool own = !in.thread;
        point_.push_back({SeriesLaw({own ? s.thread->stiffness : in.stiff_cc, 1}, 0), 0, own ? s.thread->damping : 0, s.thread->height});
    }
    points = static_cast<int>(point_.size());
    if (s.pluck) {
        pluck_.push_back(*s.pluck);
        add_point(footprint_weights(modes, s.pluck->position, s.pluck->width));
    }
    touched.assign(contacts, 0);
    inverse_.assign(padded, 0.0);
    compliance_.assign(static_cast<std::size_t>(points) * points, 0.0);
    small_.assign(static_cast<std::size_t>(points) * (points + 1), 0.0);
    force_.assign(points, 0.0);
    motion_.resize(points);
    pull_.resize(points);
    stiffness_.assign(contacts, 0.0);
    for (int a = 0; a < contacts; ++a)
        for (int b = 0; b < contacts; ++b) couples_.push_back(std::abs(dot(row(weights_, a), row(gains_, b), padded)));
}

StringEquations::Motion StringEquations::motion(int a, const double* z) const noexcept {
    const double thread = thread_ >= 0 ? own_[a] * z[padded + thread_] : 0;
    return {dot(row(reads_, a), z, padded) + thread, dot(row(weights_, a), z + padded, padded)};
}

StringEquations::Pull StringEquations::pull(int a, Motion m) const noexcept {
    const Point& q = point_[a];
    const double eta = q.height - m.y;
    const double k = q.law.law.k, alpha = q.law.law.alpha;
    if (a >= contacts) return {k * eta - q.r * m.v, k, q.r, q.r, 0};
    if (alpha == 1) {
        const double f = q.law.both * eta, give = 1 - q.beta * m.v;
        return {f * give, q.law.both * give, q.beta * f, q.beta * f, q.beta * k};
    }
    if (q.law.S > 0) return {std::copysign(q.law.force(std::abs(eta)), eta), q.law.slope(std::abs(eta)), 0, 0, 0};
    const double slope = k * std::pow(std::abs(eta), alpha - 1), f = slope * eta, give = 1 - q.beta * m.v;
    return {f * give, alpha * slope * give, q.beta * f, q.beta * f, q.beta * alpha * slope};
}

double StringEquations::penetration(int a, const double* z) const noexcept {
    return point_[a].height - motion(a, z).y;
}
double StringEquations::penetration_speed(int a, const double* z) const noexcept {
    return -dot(row(weights_, a), z + padded, padded) - (thread_ >= 0 ? own_[a] * thread_slope(z) : 0);
}
double StringEquations::thread_slope(const double* z) const noexcept {
    double sum = -damping_[thread_] * z[padded + thread_];
    for (int a = 0; a < points; ++a)
        if (acts(a)) sum += row(gains_, a)[thread_] * pull(a, motion(a, z)).F;
    return sum;
}
double StringEquations::thread_force(const double* z) const noexcept {
    return thread_ >= 0 ? pull(contacts, motion(contacts, z)).F : 0;
}
void StringEquations::put_thread(double Y, double* z) const noexcept {
    if (thread_ >= 0) z[padded + thread_] = thread_rate_ * Y;
}
double StringEquations::contact_force(int a, const double* z) const noexcept {
    return pull(a, motion(a, z)).F;
}

void StringEquations::slope(double t, const double* z, double* dz) const noexcept {
    const double *p = z, *v = z + padded;
    double *dp = dz, *dv = dz + padded, *sum = dz + 2 * padded;
    std::fill_n(sum, sums, 0.0);
    oscillate(omega_.data(), damping_.data(), p, v, dp, dv, padded);
    sum[dissipated] = square(loss_.data(), v, padded);
    for (int a = 0; a < points; ++a) {
        if (!acts(a)) continue;
        const Motion m = motion(a, z);
        const Pull f = pull(a, m);
        add(row(gains_, a), f.F, dv, padded);
        sum[a < contacts ? bridge_impulse : thread_impulse] += f.F;
        if (a < contacts) sum[thread_impulse] -= pull_back_ * f.F;
        sum[dissipated] += f.drag * m.v * m.v;
    }
    if (thread_ >= 0) sum[dissipated] += thread_loss_ * dv[thread_] * dv[thread_];
    if (plucked) {
        const double F = jvari::force(pluck_[0], pluck_[0].start + std::clamp(pluck_time + t, 0.0, pluck_[0].duration));
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
    return std::max(sum, 2 * pressed / mass_);
}

// An impact at speed v on a barrier goes as deep as m v^2/2 = k eta^(alpha+1)/(alpha+1), m = 1/sum(g^2/m_i) what the modes have there.
// Points close to each other push the same modes: their stiffnesses add up, as Gershgorin's circles do.
double StringEquations::pace(const double* z) const noexcept {
    for (int a = 0; a < contacts; ++a) {
        stiffness_[a] = 0;
        if (!touched[a]) continue;
        const Point& q = point_[a];
        const double give = couples_[a * contacts + a], v = penetration_speed(a, z);
        const double k = q.law.law.k, alpha = q.law.law.alpha;
        const double depth = std::max(penetration(a, z), std::pow(v * v * (alpha + 1) / (2 * k * give), 1 / (alpha + 1)));
        stiffness_[a] = q.law.S > 0 ? q.law.slope(depth) : k * std::pow(depth, alpha - 1);
    }
    double fastest = 0;
    for (int a = 0; a < contacts; ++a) {
        if (!touched[a]) continue;
        double sum = 0;
        for (int b = 0; b < contacts; ++b) sum += couples_[a * contacts + b] * stiffness_[b];
        fastest = std::max(fastest, sum);
    }
    return std::sqrt(fastest);
}

void StringEquations::solve(double t, double gamma, const double* z, const double* b, double* x) noexcept {
    if (gamma != gamma_) {
        gamma_ = gamma;
        for (int i = 0; i < padded; ++i) {
            const double w = gamma * omega_[i];
            inverse_[i] = 1 / (1 + gamma * damping_[i] + w * w);
        }
        for (int a = 0; a < points; ++a)
            for (int c = 0; c < points; ++c) {
                double sum = 0;
                for (int i = 0; i < padded; ++i) sum += row(weights_, a)[i] * row(gains_, c)[i] * inverse_[i];
                compliance_[a * points + c] = sum;
            }
    }
    const double *bp = b, *bv = b + padded;
    double *xp = x, *xv = x + padded;
    for (int i = 0; i < padded; ++i) {  // the blocks [1, -gamma w; gamma w, 1 + 2 gamma sigma]
        const double w = gamma * omega_[i], p = bp[i], v = bv[i];
        xp[i] = ((1 + gamma * damping_[i]) * p + w * v) * inverse_[i];
        xv[i] = (v - w * p) * inverse_[i];
    }
    // dF_a = -K_a dy_a - R_a dv_a,   dy_a = (block solution) + gamma^2 S_ab dF_b,   dv_a = (block solution) + gamma S_ab dF_b
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
        for (int c = 0; thread_ >= 0 && c < points; ++c)
            if (acts(c)) equation[c] += gamma * f.K * own_[a] * row(gains_, c)[thread_] * inverse_[thread_];
        equation[points] = -f.K * d.y - f.R * d.v;
    }
    for (int c = 0; c < points; ++c) {  // elimination; the matrix is I + (positive diagonal) x (Gram matrix): pivots on the diagonal hold
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
        sum[a < contacts ? bridge_impulse : thread_impulse] += gamma * force_[a];
        if (a < contacts) sum[thread_impulse] -= gamma * pull_back_ * force_[a];
        lost += 2 * pull_[a].drag * motion_[a].v * d.v - pull_[a].drag_slope * motion_[a].v * motion_[a].v * d.y;
    }
    if (thread_ >= 0) {
        double change = -damping_[thread_] * xv[thread_];
        for (int a = 0; a < points; ++a)
            if (acts(a)) change += row(gains_, a)[thread_] * force_[a];
        lost += 2 * thread_loss_ * thread_slope(z) * change;
    }
    sum[dissipated] += gamma * lost;
    if (plucked) {
        const double F = jvari::force(pluck_[0], pluck_[0].start + std::clamp(pluck_time + t, 0.0, pluck_[0].duration));
        sum[supplied] += gamma * F * dot(row(weights_, points), xv, padded);
    }
}

void StringEquations::jacobian(double t, const double* z, double* J) const noexcept {
    const int n = size();
    std::fill_n(J, static_cast<long>(n) * n, 0.0);
    const auto at = [&](int i, int j) -> double& { return J[static_cast<long>(j) * n + i]; };
    const double* v = z + padded;
    for (int i = 0; i < padded; ++i) {
        at(i, padded + i) = omega_[i];
        at(padded + i, i) = -omega_[i];
        at(padded + i, padded + i) = -damping_[i];
        at(2 * padded + dissipated, padded + i) = 2 * loss_[i] * v[i];
    }
    for (int a = 0; a < points; ++a) {
        if (!acts(a)) continue;
        const Motion m = motion(a, z);
        const Pull f = pull(a, m);
        const double *y = row(reads_, a), *g = row(weights_, a), *d = row(gains_, a);
        const int impulse = 2 * padded + (a < contacts ? bridge_impulse : thread_impulse);
        for (int j = 0; j < padded; ++j) {
            for (int i = 0; i < padded; ++i) {
                at(padded + i, j) -= d[i] * f.K * y[j];
                at(padded + i, padded + j) -= d[i] * f.R * g[j];
            }
            at(impulse, j) -= f.K * y[j];
            at(impulse, padded + j) -= f.R * g[j];
            if (a < contacts) at(2 * padded + thread_impulse, j) += pull_back_ * f.K * y[j];
            at(2 * padded + dissipated, j) -= f.drag_slope * m.v * m.v * y[j];
            at(2 * padded + dissipated, padded + j) += 2 * f.drag * m.v * g[j];
        }
    }
    if (thread_ >= 0) {
        const int own = padded + thread_;
        for (int a = 0; a < points; ++a) {
            if (!acts(a)) continue;
            const double K = pull(a, motion(a, z)).K * own_[a];
            for (int i = 0; i < padded; ++i) at(padded + i, own) -= row(gains_, a)[i] * K;
            at(2 * padded + (a < contacts ? bridge_impulse : thread_impulse), own) -= K;
            if (a < contacts) at(2 * padded + thread_impulse, own) += pull_back_ * K;
        }
        const double twice = 2 * thread_loss_ * thread_slope(z);
        for (int j = 0; j < 2 * padded; ++j) at(2 * padded + dissipated, j) += twice * at(own, j);
    }
    if (plucked) {
        const double F = jvari::force(pluck_[0], pluck_[0].start + std::clamp(pluck_time + t, 0.0, pluck_[0].duration));
        for (int j = 0; j < padded; ++j) at(2 * padded + supplied, padded + j) += F * row(weights_, points)[j];
    }
}

}  // namespace jvari

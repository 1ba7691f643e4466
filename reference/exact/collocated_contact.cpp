#include "reference/exact/collocated_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/exact/macro_window.hpp"
#include "reference/gauss_legendre.hpp"
#include "schemes/decompositions.hpp"

namespace jvari {

namespace {
// for a sum with a few terms, relative to the largest
constexpr double last_bits = 4 * std::numeric_limits<double>::epsilon();
// For more touching points the fixed-point iteration comes first, as long as it contracts.
constexpr int few = 4;
constexpr double contracts = 0.3;
}  // namespace

CollocatedContact::CollocatedContact(const MacroWindow& w, std::span<const BarrierLaw> laws)
    : window_(&w), law_(laws.begin(), laws.end()) {
    gauss_legendre(node_, weight_);
    using Real = long double;
    std::vector<Real> V;  // by columns: powers of the nodes
    for (int n = 0; n < nodes; ++n)
        for (int q = 0; q < nodes; ++q)
            V.push_back(std::pow(static_cast<Real>(node_[q]), static_cast<Real>(n)));
    const std::vector<Real> inverted = inverse_of(V, nodes);
    const auto inverse = [&](int power, int node) { return inverted[node * nodes + power]; };
    for (int n = 0; n < nodes; ++n)
        for (int j = 0; j < nodes; ++j) powers_[n * nodes + j] = static_cast<double>(inverse(n, j));
    // int_0^c (c - x)^l/l! x^n dx = n! c^(n+l+1)/(n+l+1)!
    std::array<Real, orders + nodes + 1> factorial{1};
    for (std::size_t n = 1; n < factorial.size(); ++n) factorial[n] = factorial[n - 1] * n;
    // for each node, and for 1
    std::array<std::array<Real, orders + nodes + 1>, nodes + 1> powers_of;
    for (int i = 0; i <= nodes; ++i) {
        powers_of[i][0] = 1;
        for (std::size_t n = 1; n < factorial.size(); ++n)
            powers_of[i][n] = powers_of[i][n - 1] * (i < nodes ? node_[i] : 1);
    }
    const auto integral = [&](int i, int l, int n) {
        return powers_of[i][n + l + 1] * factorial[n] / factorial[n + l + 1];
    };
    within_.resize(orders * nodes * nodes);
    for (int l = 0; l < orders; ++l)
        for (int j = 0; j < nodes; ++j) {
            Real all = 0;
            for (int n = 0; n < nodes; ++n) all += inverse(n, j) * integral(nodes, l, n);
            whole_[l * nodes + j] = static_cast<double>(all);
            for (int i = 0; i < nodes; ++i) {
                Real sum = 0;
                for (int n = 0; n < nodes; ++n) sum += inverse(n, j) * integral(i, l, n);
                within_[(l * nodes + j) * nodes + i] = static_cast<double>(sum);
            }
        }
    for (int q = 0; q < nodes; ++q) {
        double p0 = 1, p1 = 2 * node_[q] - 1;
        for (int n = 1; n + 1 < nodes; ++n) {
            const double next = ((2 * n + 1) * (2 * node_[q] - 1) * p1 - n * p0) / (n + 1);
            p0 = p1;
            p1 = next;
        }
        last_[q] = (2 * nodes - 1) * weight_[q] * p1;
        before_last_[q] = (2 * nodes - 3) * weight_[q] * p0;
    }
    const std::size_t most = static_cast<std::size_t>(w.contacts) * nodes;
    touching_.resize(w.contacts);
    lossy_ = std::any_of(law_.begin(), law_.end(), [](const BarrierLaw& l) { return l.beta != 0; });
    for (auto* v : {&force_, &guess_, &position_, &speed_, &base_, &base_speed_, &right_,
                    &stiffness_, &drag_, &scratch_})
        v->resize(most + 1);
    for (auto* v : {&couple_, &couple_speed_, &matrix_}) v->resize(most * most + 1);
    integrals_.resize((orders + 1) * static_cast<std::size_t>(nodes));
}

// Sets guess_ to the last step's forces, by polynomials beyond or inside it, if the same point
// touched.
void CollocatedContact::guess(std::span<const int> touching, double d, From from) noexcept {
    for (std::size_t a = 0; a < touching.size(); ++a) {
        const auto before = std::find(touching_.begin(), touching_.begin() + count_, touching[a]);
        // no polynomial goes further
        const bool known =
            from != From::elsewhere && d <= 4 * d_ && before != touching_.begin() + count_;
        const BarrierLaw& law = law_[touching[a]];
        double c[nodes] = {};
        if (known) {
            const double* f = force_.data() + (before - touching_.begin()) * nodes;
            for (int n = 0; n < nodes; ++n)
                for (int j = 0; j < nodes; ++j) c[n] += powers_[n * nodes + j] * f[j];
        }
        for (int i = 0; i < nodes; ++i) {
            const double x = (from == From::last_end ? 1 : 0) + node_[i] * d / d_;
            double f = 0;
            for (int n = nodes - 1; known && n >= 0; --n) f = f * x + c[n];
            guess_[a * nodes + i] =
                known ? f
                      : law.force(-base_[a * nodes + i],
                                  base_speed_[a * nodes + i] / window_->seconds());
        }
    }
}

// Number of orders l over a step d; h^(l) d^(l+1)/(l+1)! no longer counts beyond.
int CollocatedContact::orders_of(double d) const noexcept {
    const MacroWindow& w = *window_;
    int last = 2;
    for (double x = d * w.reach; last < std::min(w.terms, orders) && x > 1e-18;
         x *= d * w.reach / last)
        ++last;
    return last;
}

// Moves the points at the nodes by the node forces, from the motion without these. Costs a tenth of
// couple().
void CollocatedContact::move_points(double d) noexcept {
    const SweepFunctions& sweep = window_->sweep();
    const int last = orders_of(d), size = count_ * nodes;
    std::copy_n(base_.begin(), size, position_.begin());
    std::copy_n(base_speed_.begin(), size, speed_.begin());
    for (int b = 0; b < count_; ++b) {
        // [order] the force, then its integrals d^(l+1) w^l F
        double* integral = integrals_.data();
        std::copy_n(force_.begin() + b * nodes, nodes, integral);
        double f[nodes];
        for (int j = 0; j < nodes; ++j) f[j] = force_[b * nodes + j] * d;
        for (int l = 0; l < last; ++l) {
            sweep.combined(integral + (l + 1) * nodes, nodes, f, nodes,
                           &within_[static_cast<std::size_t>(l) * nodes * nodes], nodes);
            for (double& x : f) x *= d;
        }
        for (int a = 0; a < count_; ++a) {
            const double* h = window_->kernel(touching_[a], touching_[b]);
            sweep.combine(&position_[a * nodes], nodes, h, last, integral + nodes, nodes);
            // A series compliance yields at once, at the speed h^(0) F.
            if (lossy_) sweep.combine(&speed_[a * nodes], nodes, h, last, integral, nodes);
        }
    }
}

// Response to unit node forces: positions and speeds at the nodes, [node of force][node].
void CollocatedContact::couple(double d) noexcept {
    const MacroWindow& w = *window_;
    const int size = count_ * nodes, last = orders_of(d);
    for (int a = 0; a < count_; ++a)
        for (int b = 0; b < count_; ++b) {
            const double* h = w.kernel(touching_[a], touching_[b]);
            double f[orders], power = d;
            for (int l = 0; l < last; ++l, power *= d) f[l] = h[l] * power;
            // all at once: a call for each would cost more than its sums
            double columns[nodes * nodes];
            const auto write = [&](std::vector<double>& to) {
                for (int j = 0; j < nodes; ++j)
                    for (int i = 0; i < nodes; ++i)
                        to[static_cast<std::size_t>(b * nodes + j) * size + a * nodes + i] =
                            columns[j * nodes + i];
            };
            w.sweep().combined(columns, nodes * nodes, f, last, within_.data(), nodes * nodes);
            write(couple_);
            if (!lossy_) continue;
            w.sweep().combined(columns, nodes * nodes, f + 1, last - 1, within_.data(),
                               nodes * nodes);
            for (double& x : columns) x /= d;
            // A series compliance yields at once, at the speed h^(0) F.
            for (int i = 0; i < nodes; ++i) columns[i * nodes + i] += h[0];
            write(couple_speed_);
        }
}

double CollocatedContact::step(const double* r, std::span<const int> touching, double d,
                               From from) noexcept {
    const MacroWindow& w = *window_;
    const int P = static_cast<int>(touching.size()), size = P * nodes, stride = w.stride;
    const double second = w.seconds();
    const SweepFunctions& sweep = w.sweep();
    for (int a = 0; a < P; ++a) {
        const double* c = r + touching[a] * stride;
        for (int i = 0; i < nodes; ++i) {
            double at[3];
            sweep.evaluate(c, w.size, node_[i] * d, at);
            base_[a * nodes + i] = at[0];
            base_speed_[a * nodes + i] = at[1];
        }
    }
    guess(touching, d, from);
    std::swap(force_, guess_);
    std::copy(touching.begin(), touching.end(), touching_.begin());
    count_ = P;
    d_ = d;
    bool coupled = P <= few, factored = false;
    if (coupled) couple(d);
    double before = HUGE_VAL;  // the residual
    for (int iteration = 0;; ++iteration) {
        // [N]; rounding: force equivalent of the last bits in place and speed
        double residual = 0, scale = 0, stiffest = 0, rounding = 0;
        if (!coupled) move_points(d);
        else {
            std::copy_n(base_.begin(), size, position_.begin());
            std::copy_n(base_speed_.begin(), size, speed_.begin());
            sweep.combine(position_.data(), size, force_.data(), size, couple_.data(), size);
            if (lossy_)
                sweep.combine(speed_.data(), size, force_.data(), size, couple_speed_.data(), size);
        }
        for (int i = 0; i < size; ++i) {
            const BarrierLaw& law = law_[touching[i / nodes]];
            const double p = position_[i], v = speed_[i] / second, elastic = law.elastic(-p),
                         give = law.give(v), f = elastic * give;
            stiffness_[i] = law.stiffness(p, elastic) * give;
            // f = f(p, v): df/dp = -stiffness, df/dv = -drag
            drag_[i] = give > 0 || !law.clipped ? elastic * law.beta / second : 0;
            right_[i] = f - force_[i];
            residual = std::max(residual, std::abs(right_[i]));
            stiffest = std::max(stiffest, stiffness_[i]);
            scale = std::max(scale, std::abs(f));
            // A contact that creeps under a strong loss is a small force between large ones: 1 -
            // beta v is near 0 and drag v is not.
            rounding = std::max(
                rounding,
                last_bits *
                    (std::abs(stiffness_[i]) * (std::abs(base_[i]) + std::abs(p)) +
                     std::abs(drag_[i]) * (std::abs(base_speed_[i]) + std::abs(speed_[i]))));
        }
        if (residual <= std::max({1e-14 * scale, 0.1 * stiffest * w.rounding(), rounding})) break;
        if (!(scale < HUGE_VAL) || iteration == 40) {
            d_ = 0;
            return HUGE_VAL;
        }
        // down to rounding
        if (residual > 0.1 * before && residual <= 1e-12 * scale) break;
        if (!coupled && residual <= contracts * before) {
            before = residual;
            for (int i = 0; i < size; ++i) force_[i] += right_[i];
            continue;
        }
        if (!coupled) couple(d), coupled = true;
        if (!factored || residual > 0.1 * before) {
            // The matrix is near the identity for a step that resolves the contact: no pivots.
            sweep.scale_rows(matrix_.data(), stiffness_.data(), couple_.data(), drag_.data(),
                             lossy_ ? couple_speed_.data() : nullptr, size);
            sweep.factor(matrix_.data(), scratch_.data(), size);
            factored = true;
        }
        before = residual;
        sweep.substitute(matrix_.data(), right_.data(), scratch_.data(), size);
        for (int i = 0; i < size; ++i) force_[i] += right_[i];
    }
    double error = 0;
    for (int a = 0; a < P; ++a) {
        double f7 = 0, f6 = 0, most = 0;
        for (int j = 0; j < nodes; ++j) {
            const double f = force_[a * nodes + j];
            f7 += last_[j] * f;
            f6 += before_last_[j] * f;
            most = std::max(most, std::abs(f));
        }
        const double unlike = lets_go_within(a);
        most = std::max(most, unlike);
        if (most == 0) continue;
        const double* h = w.kernel(touching[a], touching[a]);
        const double power = unlike > 0 ? 0 : 1.5;
        const double rest = std::max(std::abs(f7), std::abs(f6)) / most,
                     push = (h[0] + h[1] * d) * most;
        error = std::max(
            error, push / (push + std::abs(r[touching[a] * stride + 1])) * std::pow(rest, power));
    }
    return error;
}

// Tests a clipped loss by the speeds at the nodes and at both ends: such a force is no polynomial,
// and only a sufficiently short step may contain the release.
double CollocatedContact::lets_go_within(int which) const noexcept {
    const BarrierLaw& law = law_[touching_[which]];
    double at_start = 0, at_end = 0, most = 0;
    int holds = 0;
    for (int j = 0; law.clipped && j < nodes; ++j) {
        const double v = speed_[which * nodes + j] / window_->seconds();
        holds += law.give(v) > 0;
        most = std::max(most,
                        std::abs(law.elastic(-position_[which * nodes + j]) * (1 - law.beta * v)));
        at_start += powers_[j] * v;
        for (int n = 0; n < nodes; ++n) at_end += powers_[n * nodes + j] * v;
    }
    holds += (law.give(at_start) > 0) + (law.give(at_end) > 0);
    return holds > 0 && holds < nodes + 2 ? most : 0;
}

void CollocatedContact::path(const double* r, double* path) const noexcept {
    const MacroWindow& w = *window_;
    std::copy_n(r, static_cast<std::size_t>(w.contacts) * w.stride, path);
    for (int b = 0; b < count_; ++b) {
        double f[nodes];
        derivatives(b, f);
        for (int a = 0; a < w.contacts; ++a) {
            const double* h = w.kernel(a, touching_[b]);
            w.sweep().combine(path + a * w.stride, w.size, f, nodes, h - 1, -1);  // h^(n-1-m) F^(m)
        }
    }
}

void CollocatedContact::derivatives(int which, double* f) const noexcept {
    double scale = 1;
    for (int n = 0; n < nodes; ++n, scale *= n / d_) {
        double sum = 0;
        for (int j = 0; j < nodes; ++j) sum += powers_[n * nodes + j] * force_[which * nodes + j];
        f[n] = sum * scale;
    }
}

double CollocatedContact::force(int which, double at) const noexcept {
    double f[nodes], sum = 0, power = 1;
    derivatives(which, f);
    for (int n = 0; n < nodes; ++n, power *= at / n) sum += f[n] * power;
    return sum;
}

void CollocatedContact::moments(int which, double until, int count, double* m) const noexcept {
    if (until < d_) {
        double f[nodes], e[2 * most_terms];
        derivatives(which, f);
        powers(until, nodes + count + 1, e);
        for (int i = 0; i < count; ++i) {
            m[i] = 0;
            for (int n = 0; n < nodes; ++n) m[i] += f[n] * e[n + i + 1];
        }
        return;
    }
    double power = d_;
    for (int i = 0; i < count; ++i, power *= d_) {
        double sum = 0;
        for (int j = 0; j < nodes; ++j) sum += whole_[i * nodes + j] * force_[which * nodes + j];
        m[i] = sum * power;
    }
}

double CollocatedContact::dissipated(int which) const noexcept {
    const BarrierLaw& law = law_[touching_[which]];
    double sum = 0;
    for (int j = 0; law.beta != 0 && j < nodes; ++j) {
        const double p = position_[which * nodes + j],
                     v = speed_[which * nodes + j] / window_->seconds();
        sum += weight_[j] * d_ * window_->seconds() * law.elastic(-p) * (1 - law.give(v)) * v;
    }
    return sum;
}

}  // namespace jvari

// The unknown is each contact's new depth eta - r, and not r: a stiff contact's depth is far below
// the rounding of r. Source: the contact equations of van Walstijn et al. 2016 (eq 48) and
// Issanchou et al. 2016 (eq 16) for several contacts; Newton's method with a derivative line search
// (Nocedal & Wright 2006, chapter 3) on a convex merit.
#include "schemes/contact/contact_gram.hpp"

namespace jvari {

namespace {
constexpr int most_iterations = 100, plain_iterations = 20;
// relative to an equation's terms: nothing finer can be reached
constexpr double rounding = 2e-15;
constexpr double force_change = 1e-8;  // relative; Newton's next error is about its square
}  // namespace

MeanForce mean_force(const ContactLaw& law, double eta, double depth) {
    const double r = eta - depth, a = law.alpha;
    if (eta <= 0) {  // enters, or stays out
        if (depth <= 0) return {};
        const double F = law.potential(depth) / -r;
        return {F, (law.force(depth) - F) / r};
    }
    if (depth <= 0) {  // leaves: r >= eta > 0
        const double F = law.potential(eta) / r;
        return {F, -F / r};
    }
    if (a == 1) return {law.k * (eta - 0.5 * r), -0.5 * law.k};
    const auto [value, slope] = power_quotient(a + 1, -r / eta);  // stays
    const double scale = law.force(eta) / (a + 1);
    return {scale * value, std::min(0.0, -scale / eta * slope)};
}

ContactGram::ContactGram(std::span<const ContactLaw> laws, std::span<const double> theta,
                         Force force, double share)
    : laws_(laws.begin(), laws.end()),
      theta_(theta.begin(), theta.end()),
      of_the_ends_(force == Force::of_the_ends),
      share_(share) {
    const int n = count();
    std::vector<char> seen(n, 0);
    for (int seed = 0; seed < n; ++seed) {
        if (seen[seed]) continue;
        const int first = static_cast<int>(order_.size());
        order_.push_back(seed);
        seen[seed] = 1;
        for (std::size_t i = first; i < order_.size(); ++i)
            for (int j = 0; j < n; ++j)
                if (!seen[j] && theta_[order_[i] * n + j] != 0) {
                    order_.push_back(j);
                    seen[j] = 1;
                }
        groups_.push_back({first, static_cast<int>(order_.size()) - first});
    }
    for (auto* w : {&depth_, &mean_, &spring_, &slope_, &defect_, &dr_, &df_, &root_})
        w->assign(n, 0.0);
    active_.assign(n, 0);
    for (const ContactLaw& law : laws_) half_root_.push_back(std::sqrt(0.5 * law.k));
    for (const ContactLaw& law : laws_) give_.push_back(2 / law.k);
    for (const Group& g : groups_) largest_ = std::max(largest_, g.count);
    system_ = ScaledSystem(largest_);
    closed_.resize(closed_sets * groups_.size());
    for (std::size_t i = 0; i < closed_.size(); ++i)
        if (const int size = groups_[i / closed_sets].count; size > 1 && !of_the_ends_)
            closed_[i].system = ScaledSystem(size);
}

[[gnu::always_inline]] inline ContactSolution ContactGram::alone(int a, double eta,
                                                                 double b) const noexcept {
    return loses(a) ? losing_alone(a, eta, b) : spring_alone(a, eta, b, theta_[a * count() + a]);
}

MeanForce ContactGram::spring_at(int a, double eta, double depth) const noexcept {
    const ContactLaw& law = laws_[a];
    return of_the_ends_ ? MeanForce{(1 - share_) * law.force(depth) + share_ * law.force(eta),
                                    -(1 - share_) * law.slope(depth)}
                        : mean_force(law, eta, depth);
}

MeanForce ContactGram::force_at(int a, double eta, double depth) const noexcept {
    const MeanForce G = spring_at(a, eta, depth);
    if (!loses(a)) return G;
    const double w = loss_[a].factor(eta - depth);
    if (loss_[a].clipped && w == 0) return {};
    return {G.value * w, std::min(0.0, G.slope * w - loss_[a].kappa * G.value)};
}

GramSolution ContactGram::solve(const double* eta, const double* b, double* r, double* force,
                                bool elastic) noexcept {
    GramSolution worst;
    losing_ = !loss_.empty() && !elastic;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        const Group& g = groups_[i];
        const int a = order_[g.first];
        GramSolution s;
        if (g.count == 1) {
            if (eta[a] <= 0 && eta[a] + b[a] <= 0) {  // stays out
                r[a] = -b[a];
                force[a] = 0;
                continue;
            }
            const ContactSolution one = alone(a, eta[a], b[a]);
            r[a] = one.r;
            force[a] = one.force;
            s = {one.iterations, one.residual, one.converged};
        } else if (!solve_by_set(i, eta, b, r, force, s)) {
            s = solve_group(g, eta, b, r, force);
        }
        worst.iterations = std::max(worst.iterations, s.iterations);
        worst.residual = std::max(worst.residual, s.residual);
        worst.converged = worst.converged && s.converged;
    }
    lost_ = 0;
    for (int a = 0; losing_ && a < count(); ++a)
        if (loses(a)) lost_ += lost_by(a, eta[a], r[a], force[a]);
    return worst;
}

// dr = -(I + Theta D)^-1 (r + b - Theta F), D = -dF/dr; with w = D^1/2 dr on the active set the
// matrix I + D^1/2 Theta D^1/2 is symmetric and positive definite whatever Theta's rank. df is the
// matching change of f, dr = Theta df. False where the factor is not finite.
bool ContactGram::newton_step(const int* set, int n) noexcept {
    const int stride = count();
    int m = 0;
    for (int i = 0; i < n; ++i) {
        if (!(slope_[set[i]] < 0)) continue;
        root_[set[i]] = std::sqrt(-slope_[set[i]]);
        active_[m++] = set[i];
    }
    if (!system_.factor(theta_.data(), stride, active_.data(), m, root_.data())) return false;
    double* w = df_.data();  // by position in the active set, until the end
    for (int i = 0; i < m; ++i) w[i] = -root_[active_[i]] * defect_[active_[i]];
    system_.solve(w);
    for (int i = 0; i < n; ++i) {  // dr = -defect - Theta D dr; on the active set D dr = D^1/2 w
        const int a = set[i];
        double sum = -defect_[a];
        for (int l = 0; l < m; ++l)
            sum -= theta_[a * stride + active_[l]] * root_[active_[l]] * w[l];
        dr_[a] = sum;
    }
    for (int i = 0; i < m; ++i)  // stiff: the same without the difference of nearly equal terms
        if (-slope_[active_[i]] * theta_[active_[i] * stride + active_[i]] > 1)
            dr_[active_[i]] = w[i] / root_[active_[i]];
    return true;
}

const ContactGram::Closed& ContactGram::closed(std::size_t group, std::uint64_t set) noexcept {
    const std::size_t slot = (set ^ (set >> 3) ^ (set >> 11) ^ (set >> 29)) % closed_sets;
    Closed& kept = closed_[group * closed_sets + slot];
    if (kept.set == set) return kept;
    kept.set = set;
    const int* all = order_.data() + groups_[group].first;
    int n = 0;
    for (int i = 0; i < groups_[group].count; ++i)
        if (set >> i & 1) active_[n++] = all[i];
    if (!kept.system.factor(theta_.data(), count(), active_.data(), n, half_root_.data()))
        kept.set = 0;
    return kept;
}

// Forces if the contacts in a set stay in contact, another, `one` or -1, follows its own equation,
// and the rest stays out. With D = k/2 for the set,
//
//     (1/D + Theta) F = 2 eta + b - Theta_s1 F_1,    b_1' = b_1 - Theta_1s F_0,
//     Theta_11' = Theta_11 - Theta_1s (1/D + Theta)^-1 Theta_s1
std::optional<ContactGram::Fit> ContactGram::fit(std::size_t group, std::uint64_t set, int one,
                                                 const double* eta, const double* b, double* r,
                                                 double* force, GramSolution& s) noexcept {
    const int stride = count(), n = groups_[group].count;
    const int* all = order_.data() + groups_[group].first;
    s = {};
    const Closed* kept = set ? &closed(group, set) : nullptr;
    if (kept && kept->set != set) return std::nullopt;
    int m = 0;
    for (int i = 0; i < n; ++i) {
        const int a = all[i];
        force[a] = 0;
        if (!(set >> i & 1)) continue;
        active_[m] = a;
        df_[m++] = half_root_[a] * (2 * eta[a] + b[a]);
    }
    if (kept) kept->system.solve(df_.data());
    if (one >= 0) {
        const int o = all[one];
        const double* to = theta_.data() + o * stride;
        double b_one = b[o], theta = to[o];
        for (int i = 0; i < m; ++i) dr_[i] = half_root_[active_[i]] * to[active_[i]];
        if (kept) kept->system.solve(dr_.data());
        for (int i = 0; i < m; ++i) {
            const double by = half_root_[active_[i]] * to[active_[i]];
            b_one -= by * df_[i], theta -= by * dr_[i];
        }
        const ContactSolution own = solve_contact(laws_[o], eta[o], b_one, theta);
        if (!own.converged) return std::nullopt;
        s.iterations = own.iterations;
        force[o] = own.force;
        depth_[o] = eta[o] - own.r;
        for (int i = 0; i < m; ++i) df_[i] -= dr_[i] * own.force;
        active_[m] = o;
    }
    for (int i = 0; i < m; ++i) force[active_[i]] = half_root_[active_[i]] * df_[i];
    const int acting = m + (one >= 0);
    Fit fit;
    for (int i = 0; i < n; ++i) {
        const int a = all[i];
        const double* to = theta_.data() + a * stride;
        double moved = -b[a], terms = std::abs(b[a]) + std::abs(eta[a]);
        for (int j = 0; j < acting; ++j) {
            const double by = to[active_[j]] * force[active_[j]];
            moved += by, terms += std::abs(by);
        }
        r[a] = moved;
        if (i != one && !(set >> i & 1)) {
            if (!(eta[a] <= 0 && eta[a] - moved <= 0)) ++fit.misfits, fit.misfit = i;
            continue;
        }
        if (i != one) depth_[a] = give_[a] * force[a] - eta[a];
        const double defect = std::abs(eta[a] - depth_[a] - moved) / terms;
        if (!(defect <= 4 * rounding)) return std::nullopt;
        s.residual = std::max(s.residual, defect);
        if (i != one && !(depth_[a] > 0)) ++fit.misfits, fit.misfit = i;
    }
    return fit;
}

bool ContactGram::solve_by_set(std::size_t group, const double* eta, const double* b, double* r,
                               double* force, GramSolution& s) noexcept {
    const Group& g = groups_[group];
    if (of_the_ends_ || losing_ || g.count > 64) return false;
    std::uint64_t set = 0;
    int one = -1;  // a contact with an exponent other than 1
    for (int i = 0; i < g.count; ++i) {
        const int a = order_[g.first + i];
        if (!(eta[a] > 0)) continue;
        if (laws_[a].alpha == 1) set |= std::uint64_t{1} << i;
        else if (one >= 0) return false;
        else one = i;
    }
    std::optional<Fit> f = fit(group, set, one, eta, b, r, force, s);
    if (f && f->misfits == 1 && one < 0) {
        one = f->misfit;
        f = fit(group, set & ~(std::uint64_t{1} << one), one, eta, b, r, force, s);
    }
    return f && f->misfits == 0;
}

GramSolution ContactGram::solve_group(const Group& group, const double* eta, const double* b,
                                      double* r, double* f) noexcept {
    const int stride = count(), n = group.count;
    const int* set = order_.data() + group.first;
    bool out = true;
    for (int i = 0; i < n; ++i) {
        const int a = set[i];
        r[a] = -b[a];
        f[a] = 0;
        out = out && eta[a] <= 0 && eta[a] + b[a] <= 0;
    }
    if (out) return {};

    // a first guess: each contact with the others' forces kept
    for (int sweep = 0; sweep < 2; ++sweep)
        for (int i = 0; i < n; ++i) {
            const int a = set[i];
            double rest = b[a];
            for (int j = 0; j < n; ++j)
                if (j != i) rest -= theta_[a * stride + set[j]] * f[set[j]];
            f[a] = alone(a, eta[a], rest).force;
        }

    const auto reach = [&](int a) {  // scale of rounding in r_a's equation
        double sum = std::abs(b[a]) + std::abs(eta[a]);
        for (int j = 0; j < n; ++j)  // G and kappa r G may nearly cancel
            sum += std::abs(theta_[a * stride + set[j]]) *
                   std::max(std::abs(f[set[j]]), spring_[set[j]]);
        return sum;
    };
    const auto displaced = [&](int a) {  // r_a = -b_a + (Theta f)_a
        double sum = -b[a];
        for (int j = 0; j < n; ++j) sum += theta_[a * stride + set[j]] * f[set[j]];
        return sum;
    };
    const auto evaluate = [&] {  // F, dF/dr and the defect r + b - Theta F, all from the depths
        for (int i = 0; i < n; ++i) {
            const MeanForce F = force_at(set[i], eta[set[i]], depth_[set[i]]);
            mean_[set[i]] = F.value;
            slope_[set[i]] = F.slope;
            if (loses(set[i]))  // r has the digits of eta in these terms
                spring_[set[i]] = spring_at(set[i], eta[set[i]], depth_[set[i]]).value *
                                  (1 + loss_[set[i]].kappa * std::abs(eta[set[i]]));
        }
        for (int i = 0; i < n; ++i) {
            double sum = eta[set[i]] + b[set[i]] - depth_[set[i]];
            for (int j = 0; j < n; ++j) sum -= theta_[set[i] * stride + set[j]] * mean_[set[j]];
            defect_[set[i]] = sum;
        }
    };
    const auto merit_slope = [&](double t) {  // along f + t df, r + t dr
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            const int a = set[i];
            sum += dr_[a] * (f[a] + t * df_[a] - force_at(a, eta[a], depth_[a] - t * dr_[a]).value);
        }
        return sum;
    };

    GramSolution s;
    s.converged = false;
    for (int i = 0; i < n; ++i) depth_[set[i]] = eta[set[i]] - displaced(set[i]);
    evaluate();
    for (s.iterations = 1; s.iterations <= most_iterations && !s.converged; ++s.iterations) {
        if (!newton_step(set, n)) break;
        s.converged = true;
        for (int i = 0; i < n; ++i) {
            const int a = set[i];
            df_[a] = mean_[a] + slope_[a] * dr_[a] - f[a];
            const double step = std::abs(dr_[a]);
            const bool stays_out = slope_[a] == 0 && step <= -1e-3 * depth_[a];
            const bool settled =
                slope_[a] < 0 && -slope_[a] * step <= force_change * std::abs(mean_[a]);
            s.converged = s.converged &&
                          (stays_out || settled || std::abs(defect_[a]) <= rounding * reach(a));
        }
        double t = 1;
        if (!s.converged) {
            const double start = merit_slope(0);
            const double end = merit_slope(1),
                         allowed = s.iterations <= plain_iterations ? 0.25 * std::abs(start) : 0;
            // past the minimum: bisect for a point before it at which the slope has fallen by half
            if (end > allowed) {
                double low = 0, high = 1;
                for (int i = 0; i < 60; ++i) {
                    t = 0.5 * (low + high);
                    const double slope = merit_slope(t);
                    if (slope > 0) high = t;
                    else low = t;
                    if (slope <= 0 && slope >= 0.5 * start) break;
                }
                t = low > 0 ? low : 1;  // no descent at all: the slopes are rounding
            }
        }
        for (int i = 0; i < n; ++i) {
            f[set[i]] += t * df_[set[i]];
            depth_[set[i]] -= t * dr_[set[i]];
        }
        evaluate();
    }
    --s.iterations;
    for (int i = 0; i < n; ++i) {
        const int a = set[i];
        if (f[a] < 0 && !loses(a)) f[a] = mean_[a];
    }
    for (int i = 0; i < n; ++i) {
        const int a = set[i];
        r[a] = displaced(a);
        const double scale = reach(a) * (1 - theta_[a * stride + a] * slope_[a]);
        if (scale > 0) s.residual = std::max(s.residual, std::abs(defect_[a]) / scale);
    }
    s.converged = s.converged && std::isfinite(s.residual);
    return s;
}

}  // namespace jvari

// Source: docs/two-moments.md, sections 5 to 7.
#include "schemes/moments/moment_obstacle.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "schemes/decompositions.hpp"

namespace jvari {

namespace {
constexpr int most_blocks = 25, most_sweeps = 2000;
constexpr std::size_t kept_sets = 16;

// Gauss's elimination with pivots, in place: rows of `columns` numbers, the first n of which are
// the matrix and the others right sides, which become solutions. False where a pivot is nothing.
bool eliminate(double* rows, int n, int columns) noexcept {
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(rows[i * columns + k]) > std::abs(rows[pivot * columns + k])) pivot = i;
        if (!(std::abs(rows[pivot * columns + k]) > 0)) return false;
        if (pivot != k)
            std::swap_ranges(rows + k * columns, rows + (k + 1) * columns, rows + pivot * columns);
        const double scale = 1 / rows[k * columns + k];
        for (int j = k; j < columns; ++j) rows[k * columns + j] *= scale;
        for (int i = 0; i < n; ++i) {
            const double factor = rows[i * columns + k];
            if (i == k || factor == 0) continue;
            for (int j = k; j < columns; ++j) rows[i * columns + j] -= factor * rows[k * columns + j];
        }
    }
    return true;
}
}  // namespace

MomentObstacle::MomentObstacle(const Contacts& contacts, const std::vector<Thread>& threads,
                               std::span<const double> theta, double span,
                               const MissingMatrix* series)
    : contacts_(contacts),
      n_(contacts.count()),
      points_(n_ + static_cast<int>(threads.size())),
      span_(span),
      theta_(theta.begin(), theta.end()),
      at_(n_) {
    if (n_ > most_contacts)
        throw Refusal("forces that are lines in the step: at most " +
                      std::to_string(most_contacts) + " contacts, here " + std::to_string(n_));
    const int P = points_, n = n_, D = 2 * P;
    if (series && P > 0) {
        ladder_.emplace(*series, span);
        ladder_->add_compliance(theta_);
    }
    for (auto* v : {&f_, &moved_, &spring_}) v->assign(D, 0.0);
    if (!threads.empty()) thread_ = threads.front();
    std::vector<long double> T(static_cast<std::size_t>(4) * n * n);
    const auto at = [&](int i, int p, int j, int q) { return theta_[(i * P + p) * D + j * P + q]; };
    if (thread_) {
        const double k = thread_->stiffness, r = thread_->damping / span;
        const long double K[2][2] = {{0.5 * k + r, -0.5 * k}, {0.5 * k, 3 * r}};
        std::vector<long double> S(4);
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                S[2 * i + j] = (i == j) + K[i][0] * at(0, n, j, n) + K[i][1] * at(1, n, j, n);
        S = inverse_of(S, 2);
        answer_.assign(4 * n, 0.0);
        std::vector<long double> answer(4 * n);
        for (int i = 0; i < 2; ++i) {
            pull_by_stretch_[i] = static_cast<double>(-S[2 * i] * k);
            for (int j = 0; j < 2; ++j) {
                long double by = 0;
                for (int l = 0; l < 2; ++l) {
                    by += S[2 * i + l] * K[l][j];
                    for (int a = 0; a < n; ++a)
                        for (int m = 0; m < 2; ++m)
                            answer[(2 * i + j) * n + a] += S[2 * i + l] * K[l][m] * at(m, n, j, a);
                }
                pull_by_free_[i][j] = static_cast<double>(-by);
            }
        }
        std::copy(answer.begin(), answer.end(), answer_.begin());
        for (int i = 0; i < 2; ++i)
            for (int a = 0; a < n; ++a)
                for (int j = 0; j < 2; ++j)
                    for (int b = 0; b < n; ++b)
                        for (int l = 0; l < 2; ++l)
                            T[((i * n + a) * 2 + j) * n + b] -=
                                at(i, a, l, n) * answer[(2 * l + j) * n + b];
    }
    for (int i = 0; i < 2; ++i)
        for (int a = 0; a < n; ++a)
            for (int j = 0; j < 2; ++j)
                for (int b = 0; b < n; ++b)
                    T_.push_back(static_cast<double>(T[((i * n + a) * 2 + j) * n + b] +
                                                     at(i, a, j, b)));
    for (int a = 0; a < n; ++a) {
        rules_.emplace_back(contacts.laws[a], contacts.loss[a], contacts.loss_law[a], own(a), span);
        if (rules_[a].is_linear()) linear_ |= std::uint64_t{1} << a;
    }
    found_.resize(n);
    active_.resize(2 * n);
    ends_.assign(D, 0.0);
    trial_.assign(D, 0.0);
    matrix_.assign(static_cast<std::size_t>(2 * n) * (4 * n + 1), 0.0);
    if (n == 1 && linear_) {
        const Kept& full = (sets_.resize(1), kept(1));
        std::copy_n(full.inverse.begin(), 4, inverse_);
    } else if (n > 1) {
        sets_.resize(kept_sets);
        for (Kept& s : sets_) {
            s.contacts.assign(n, 0);
            s.inverse.assign(static_cast<std::size_t>(4) * n * n, 0.0);
        }
    }
}

int MomentObstacle::dofs() const {
    return static_cast<int>(std::count_if(contacts_.laws.begin(), contacts_.laws.end(),
                                          [](const ContactLaw& l) { return l.rigid(); }));
}

void MomentObstacle::begin(const double* reading, const double*, const double* force) {
    if (ladder_) ladder_->rest(force);
    for (int a = 0; a < n_; ++a) {
        at_[a] = {};
        at_[a].eta = contacts_.heights[a] - reading[a] - (ladder_ ? ladder_->yields(a) : 0);
    }
    if (thread_) stretch_ = reading[n_] + (ladder_ ? ladder_->yields(n_) : 0) - thread_->height;
    stretch_before_ = stretch_;
    moved_thread_ = pull_1_ = 0;
    set_ = 0;
}

void MomentObstacle::start_from(const MomentObstacle& before) noexcept {
    if (!ladder_) return;
    for (int p = 0; p < points_; ++p) spring_[p] = ladder_->yields(p);
    ladder_->start_from(*before.ladder_);
    for (int a = 0; a < n_; ++a) at_[a].eta += spring_[a] - ladder_->yields(a);
    if (thread_) stretch_ += ladder_->yields(n_) - spring_[n_];
}

double MomentObstacle::potential(const double*, int) const {
    double sum = ladder_ ? ladder_->stored() : 0;
    for (int a = 0; a < n_; ++a) sum += rules_[a].potential(at_[a].eta, at_[a].stored);
    if (thread_) sum += 0.5 * thread_->stiffness * stretch_ * stretch_;
    return sum;
}

double MomentObstacle::loss() const {
    double lost = ladder_ ? ladder_->lost() : 0;
    for (int a = 0; a < n_; ++a) {
        const Point& p = at_[a];
        lost += p.closed ? rules_[a].lost_linear(p.eta_before, p.stored_before, p.from, p.force_from)
                         : p.lost;
    }
    if (thread_ && thread_->damping > 0) {  // r_c/H (r_0^2 + 3 r_1^2), r_1 from phi_c1
        const double r = thread_->damping / span_,
                     r_1 = -(pull_1_ + 0.5 * thread_->stiffness * moved_thread_) / (3 * r);
        lost += r * (moved_thread_ * moved_thread_ + 3 * r_1 * r_1);
    }
    return lost / span_;
}

void MomentObstacle::take(int a, const MomentContact& s) noexcept {
    Point& p = at_[a];
    moved_[a] = p.eta - s.to;
    p = {s.to, s.stored, p.eta, p.stored, s.from, 0, false, s.lost};
    if (s.touches && rules_[a].is_linear()) set_ |= std::uint64_t{1} << a;
    if (s.phi_0 != 0 || s.phi_1 != 0)
        tally_.note(s.phi_0, std::max({p.eta_before, p.eta, s.from}));
}

void MomentObstacle::take_linear(int a, double phi_0, double phi_1, double from,
                                 double to) noexcept {
    Point& p = at_[a];
    moved_[a] = p.eta - to;
    p = {to, 0.5 * (phi_0 + phi_1) * std::max(to, 0.0), p.eta, p.stored, from, phi_0 - phi_1, true,
         0};
    if (phi_0 != 0) tally_.note(phi_0, std::max({p.eta_before, p.eta, from}));
}

bool MomentObstacle::alone(const double* b, double* force) noexcept {
    if (rules_[0].stays_out(at_[0].eta, b[0], b[points_])) {
        force[0] = force[points_] = 0;
        MomentContact out;
        out.from = out.to = at_[0].eta - b[0];
        out.lost = rules_[0].conserves() ? 0 : rules_[0].potential(at_[0].eta, at_[0].stored);
        take(0, out);
        return true;
    }
    const MomentContact s = rules_[0].solve(own(0), at_[0].eta, at_[0].stored, b[0], b[points_]);
    force[0] = s.phi_0, force[points_] = s.phi_1;
    take(0, s);
    tally_.note(s.iterations, s.residual);
    return s.converged;
}

// Of the linear contacts in full contact: c (phi_0 + phi_1) + (T phi)_0 = E_1 and c (phi_0 - phi_1)
// - (T phi)_1 = E_0.
const MomentObstacle::Kept& MomentObstacle::kept(std::uint64_t set) noexcept {
    Kept& s = sets_[sets_.size() == 1 ? 0 : (set ^ (set >> 7) ^ (set >> 19)) % sets_.size()];
    if (s.set == set) return s;
    if (s.contacts.empty()) s.contacts.assign(n_, 0), s.inverse.assign(4 * n_ * n_, 0.0);
    s.set = set;
    s.size = 0;
    for (int a = 0; a < n_; ++a)
        if (set >> a & 1) s.contacts[s.size++] = a;
    const int m = 2 * s.size, columns = 2 * m;
    double* rows = matrix_.data();
    std::fill_n(rows, m * columns, 0.0);
    for (int x = 0; x < s.size; ++x) {
        const int a = s.contacts[x];
        const double c = rules_[a].c();
        double *first = rows + 2 * x * columns, *second = first + columns;
        for (int y = 0; y < s.size; ++y)
            for (int j = 0; j < 2; ++j) {
                first[2 * y + j] = T(0, a, j, s.contacts[y]);
                second[2 * y + j] = -T(1, a, j, s.contacts[y]);
            }
        first[2 * x] += c, first[2 * x + 1] += c;
        second[2 * x] += c, second[2 * x + 1] -= c;
        first[m + 2 * x] = second[m + 2 * x + 1] = 1;
    }
    eliminate(rows, m, columns);
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j) s.inverse[i * m + j] = rows[i * columns + m + j];
    return s;
}

void MomentObstacle::moved_by_others(int a, const double* b, const double* force, double& b_0,
                                     double& b_1) const noexcept {
    b_0 = b[a], b_1 = b[points_ + a];
    for (int c = 0; c < n_; ++c) {
        if (c == a) continue;
        const double phi_0 = force[c], phi_1 = force[points_ + c];
        if (phi_0 == 0 && phi_1 == 0) continue;
        b_0 += T(0, a, 0, c) * phi_0 + T(0, a, 1, c) * phi_1;
        b_1 += T(1, a, 0, c) * phi_0 + T(1, a, 1, c) * phi_1;
    }
}

bool MomentObstacle::several(const double* b, double* force) noexcept {
    const int P = points_;
    const Kept* s = nullptr;
    std::fill_n(force, n_, 0.0);
    std::fill_n(force + P, n_, 0.0);
    if (set_ != 0) {
        s = &kept(set_);
        const int m = 2 * s->size;
        for (int x = 0; x < s->size; ++x) {
            const int a = s->contacts[x];
            ends_[2 * x] = at_[a].eta - b[a];
            ends_[2 * x + 1] = at_[a].eta + b[P + a];
        }
        for (int x = 0; x < m; ++x) {
            double phi = 0;
            for (int y = 0; y < m; ++y) phi += s->inverse[x * m + y] * ends_[y];
            force[x % 2 * P + s->contacts[x / 2]] = phi;
        }
    }
    int misfits = 0, who = 0;
    for (int a = 0; a < n_; ++a) {
        bool fits;
        if (set_ >> a & 1) {
            fits = force[a] > std::abs(force[P + a]);
        } else {
            double b_0, b_1;
            moved_by_others(a, b, force, b_0, b_1);
            trial_[a] = b_0, trial_[P + a] = b_1;
            fits = rules_[a].stays_out(at_[a].eta, b_0, b_1);
        }
        if (!fits) ++misfits, who = a;
    }
    const std::uint64_t set = set_;
    if (misfits == 0) {
        for (int a = 0; a < n_; ++a) {
            if (set >> a & 1) {
                const double c = rules_[a].c(), phi_0 = force[a], phi_1 = force[P + a];
                take_linear(a, phi_0, phi_1, c * (phi_0 - phi_1), c * (phi_0 + phi_1));
            } else {
                MomentContact out;
                out.from = out.to = at_[a].eta - trial_[a];
                out.lost = rules_[a].conserves() ? 0
                                                 : rules_[a].potential(at_[a].eta, at_[a].stored);
                take(a, out);
            }
        }
        if (set) tally_.note(0, 0);
        return true;
    }
    if (misfits == 1 && with_one(set & ~(std::uint64_t{1} << who), who, b, force)) return true;
    return by_newton(b, force);
}

// Contact a by its own equation, those of `others` in full contact and eliminated, the rest out.
// False where these do not agree.
bool MomentObstacle::with_one(std::uint64_t others, int a, const double* b,
                              double* force) noexcept {
    const int P = points_;
    MomentMatrix less = own(a);
    double b_0 = b[a], b_1 = b[P + a];
    const Kept* s = others ? &kept(others) : nullptr;
    const int m = s ? 2 * s->size : 0;
    // ends of the others by phi_a: -T_0a, T_1a
    const auto by_own = [&](int x, int j) {
        const int c = s->contacts[x / 2];
        return x % 2 == 0 ? -T(0, c, j, a) : T(1, c, j, a);
    };
    for (int x = 0; x < m; ++x) {
        const int c = s->contacts[x / 2];
        double free = 0, by_0 = 0, by_1 = 0;  // phi of the others
        for (int y = 0; y < m; ++y) {
            const int d = s->contacts[y / 2];
            const double inverse = s->inverse[x * m + y];
            free += inverse * (y % 2 == 0 ? at_[d].eta - b[d] : at_[d].eta + b[P + d]);
            by_0 += inverse * by_own(y, 0), by_1 += inverse * by_own(y, 1);
        }
        const double t_0 = T(0, a, x % 2, c), t_1 = T(1, a, x % 2, c);
        b_0 += t_0 * free, b_1 += t_1 * free;
        less.m00 += t_0 * by_0, less.m01 += t_0 * by_1;
        less.m10 += t_1 * by_0, less.m11 += t_1 * by_1;
    }
    const MomentContact own = rules_[a].solve(less, at_[a].eta, at_[a].stored, b_0, b_1);
    if (!own.converged) return false;
    std::fill_n(trial_.data(), 2 * P, 0.0);
    trial_[a] = own.phi_0, trial_[P + a] = own.phi_1;
    for (int x = 0; x < m; ++x) {
        double phi = 0;
        for (int y = 0; y < m; ++y) {
            const int d = s->contacts[y / 2];
            phi += s->inverse[x * m + y] *
                   ((y % 2 == 0 ? at_[d].eta - b[d] : at_[d].eta + b[P + d]) +
                    by_own(y, 0) * own.phi_0 + by_own(y, 1) * own.phi_1);
        }
        trial_[x % 2 * P + s->contacts[x / 2]] = phi;
    }
    for (int c = 0; c < n_; ++c) {
        if (c == a) continue;
        if (others >> c & 1) {
            if (!(trial_[c] > std::abs(trial_[P + c]))) return false;
            continue;
        }
        double c_0, c_1;
        moved_by_others(c, b, trial_.data(), c_0, c_1);
        if (!rules_[c].stays_out(at_[c].eta, c_0, c_1)) return false;
        ends_[c] = at_[c].eta - c_0;
    }
    set_ = others;
    for (int c = 0; c < n_; ++c) {
        force[c] = trial_[c], force[P + c] = trial_[P + c];
        if (c == a) {
            take(a, own);
        } else if (others >> c & 1) {
            const double give = rules_[c].c();
            take_linear(c, force[c], force[P + c], give * (force[c] - force[P + c]),
                        give * (force[c] + force[P + c]));
        } else {
            MomentContact out;
            out.from = out.to = ends_[c];
            out.lost =
                rules_[c].conserves() ? 0 : rules_[c].potential(at_[c].eta, at_[c].stored);
            take(c, out);
        }
    }
    tally_.note(own.iterations, own.residual);
    return true;
}

// phi_a = S_a(b_a + the others' T phi) for all contacts: Newton's steps with S_a' = answer().
bool MomentObstacle::by_newton(const double* b, double* force) noexcept {
    const int P = points_;
    int iterations = 0;
    const auto index = [&](int x) { return x % 2 * P + x / 2; };
    for (; iterations < most_blocks; ++iterations) {
        double worst = 0, largest = 0;
        int active = 0;
        for (int a = 0; a < n_; ++a) {
            double b_0, b_1;
            moved_by_others(a, b, force, b_0, b_1);
            found_[a] = rules_[a].solve(own(a), at_[a].eta, at_[a].stored, b_0, b_1);
            const MomentContact& s = found_[a];
            worst = std::max({worst, std::abs(s.phi_0 - force[a]),
                              std::abs(s.phi_1 - force[P + a])});
            largest = std::max({largest, std::abs(s.phi_0), std::abs(s.phi_1)});
            if (s.phi_0 == 0 && s.phi_1 == 0) force[a] = force[P + a] = 0;
            else active_[active++] = 2 * a, active_[active++] = 2 * a + 1;
        }
        if (worst <= 1e-13 * largest) break;
        const int columns = active + 1;
        for (int i = 0; i < active; i += 2) {
            const int a = active_[i] / 2;
            const MomentMatrix S = rules_[a].answer(own(a), found_[a]);
            double *first = matrix_.data() + i * columns, *second = first + columns;
            for (int k = 0; k < active; ++k) {
                const int c = active_[k] / 2, j = active_[k] % 2;
                const double t_0 = c == a ? 0 : T(0, a, j, c), t_1 = c == a ? 0 : T(1, a, j, c);
                first[k] = (k == i) - (S.m00 * t_0 + S.m01 * t_1);
                second[k] = (k == i + 1) - (S.m10 * t_0 + S.m11 * t_1);
            }
            first[active] = found_[a].phi_0 - force[a];
            second[active] = found_[a].phi_1 - force[P + a];
        }
        if (!eliminate(matrix_.data(), active, columns)) {
            iterations = most_blocks;
            break;
        }
        for (int i = 0; i < active; ++i)
            force[index(active_[i])] += matrix_[i * columns + active];
    }
    if (iterations == most_blocks) return in_turn(b, force, iterations);
    set_ = 0;
    bool converged = true;
    for (int a = 0; a < n_; ++a) {
        force[a] = found_[a].phi_0, force[P + a] = found_[a].phi_1;
        converged = converged && found_[a].converged;
        take(a, found_[a]);
    }
    tally_.note(std::max(iterations, 1), 0);
    return converged;
}

// One contact after another, the others' forces held, until no force changes.
bool MomentObstacle::in_turn(const double* b, double* force, int iterations) noexcept {
    const int P = points_;
    std::fill_n(force, n_, 0.0);
    std::fill_n(force + P, n_, 0.0);
    bool converged = false;
    for (int sweep = 0; sweep < most_sweeps && !converged; ++sweep, ++iterations) {
        double worst = 0, largest = 0;
        converged = true;
        for (int a = 0; a < n_; ++a) {
            double b_0, b_1;
            moved_by_others(a, b, force, b_0, b_1);
            found_[a] = rules_[a].solve(own(a), at_[a].eta, at_[a].stored, b_0, b_1);
            const MomentContact& s = found_[a];
            worst = std::max({worst, std::abs(s.phi_0 - force[a]),
                              std::abs(s.phi_1 - force[P + a])});
            largest = std::max({largest, std::abs(s.phi_0), std::abs(s.phi_1)});
            force[a] = s.phi_0, force[P + a] = s.phi_1;
            converged = converged && s.converged;
        }
        converged = converged && worst <= 1e-13 * largest;
    }
    set_ = 0;
    for (int a = 0; a < n_; ++a) take(a, found_[a]);
    tally_.note(iterations, 0);
    return converged;
}

std::vector<Fact> MomentObstacle::facts() const {
    const auto conserve = std::count_if(rules_.begin(), rules_.end(),
                                        [](const MomentRule& r) { return r.conserves(); });
    std::vector<Fact> f = {{facts::contact_points, static_cast<double>(n_)},
                           {facts::conserving_contacts, static_cast<double>(conserve)},
                           {facts::smallest_contact_force, tally_.force.least},
                           {facts::largest_contact_force, tally_.force.most},
                           {facts::deepest_penetration, tally_.deepest}};
    const double solves = static_cast<double>(tally_.solves);
    f.push_back({facts::contact_solves, solves});
    f.push_back({facts::contact_iterations_mean,
                 solves > 0 ? static_cast<double>(tally_.iterations) / solves : 0});
    f.push_back({facts::contact_iterations_most, static_cast<double>(tally_.most_iterations)});
    f.push_back({facts::contact_residual, tally_.residual});
    return f;
}

}  // namespace jvari

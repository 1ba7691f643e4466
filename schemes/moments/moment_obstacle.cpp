// Source: docs/two-moments.md, sections 5 to 7.
#include "schemes/moments/moment_obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "schemes/decompositions.hpp"

namespace jvari {

namespace {
constexpr int most_blocks = 60, most_sweeps = 200;
constexpr int few = 4;  // contacts all of whose sets are kept

// Gauss's elimination with pivots, in place: rows with `columns` numbers, the first n for the
// matrix and the others for right sides, which become solutions. False if a pivot is zero.
bool eliminate(double* rows, int n, int columns) noexcept {
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(rows[i * columns + k]) > std::abs(rows[pivot * columns + k])) pivot = i;
        if (!(std::abs(rows[pivot * columns + k]) > 0)) return false;
        if (pivot != k)
            std::swap_ranges(rows + k * columns, rows + (k + 1) * columns, rows + pivot * columns);
        const double scale = 1 / rows[k * columns + k];
        for (int j = k + 1; j < columns; ++j) rows[k * columns + j] *= scale;
        for (int i = k + 1; i < n; ++i) {
            const double factor = rows[i * columns + k];
            for (int j = k + 1; j < columns; ++j)
                rows[i * columns + j] -= factor * rows[k * columns + j];
        }
    }
    for (int k = n - 1; k > 0; --k)
        for (int i = 0; i < k; ++i)
            for (int j = n; j < columns; ++j)
                rows[i * columns + j] -= rows[i * columns + k] * rows[k * columns + j];
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
    const int n = n_, D = 2 * points_;
    if (series && D > 0) ladder_.emplace(*series, span);
    if (!threads.empty()) thread_ = threads.front();
    put_linear_part();
    for (int a = 0; a < n; ++a) {
        rules_.emplace_back(contacts.laws[a], contacts.loss[a], contacts.loss_law[a], own(a), span,
                            n == 1);
        if (rules_[a].is_linear()) linear_ |= std::uint64_t{1} << a;
    }
    if (n > 0) {
        std::vector<ContactLaw> laws;
        std::vector<double> means;
        for (int a = 0; a < n; ++a) {
            laws.push_back(rules_[a].law());
            for (int c = 0; c < n; ++c) means.push_back(T(0, a, 0, c));
        }
        gram_ = ContactGram(laws, means);
    }
    found_.resize(n);
    answers_.resize(n);
    pairs_.assign(static_cast<std::size_t>(8) * n, 0.0);
    active_.reserve(n);
    kept_.resize(n);
    for (auto* v : {&moved_, &spring_, &ends_, &trial_, &step_, &last_, &own_b_, &x_own_, &from_,
                    &last_step_})
        v->assign(D, 0.0);
    b_.assign(2 * static_cast<std::size_t>(D), 0.0);
    for (auto* v : {&next_, &x_before_}) v->assign(x_.size(), 0.0);
    matrix_.assign(static_cast<std::size_t>(2 * n) * (4 * n + 1), 0.0);
    const std::size_t pairs = static_cast<std::size_t>(n) * n;
    sets_.resize(16);
    reduced_.resize(n <= few ? std::size_t{1} << 2 * n : 16);
    for (Kept& s : sets_) s.inverse.assign(4 * pairs, 0.0);
    for (Reduced& r : reduced_)
        if (n > 1) r.less.resize(pairs), r.by.resize(4 * pairs), r.moved.resize(4 * pairs);
    inverses_.assign(static_cast<std::size_t>(4) * n, 0.0);
    for (int a = 0; a < n; ++a)
        for (int k = 0; linear_ >> a & 1 && k < 4; ++k)
            inverses_[4 * a + k] =
                kept(std::uint64_t{1} << a).inverse[(k / 2 * n + a) * 2 * n + k % 2 * n + a];
}

namespace {
using Real = long double;
}

// points_by_: b and the thread's pull, from x and free, through A: b and pull by F and Y_c.
void MomentObstacle::put_points(std::span<const Real> theta, std::span<const Real> G,
                                std::span<const Real> pull_by_free,
                                std::span<const Real> pull_by_stretch) {
    const int P = points_, n = n_, D = 2 * P, c = n, ladder = ladder_ ? D : 0,
              S = ladder + (thread_ ? 1 : 0);
    std::vector<Real> A(static_cast<std::size_t>(D) * D), A_Y(D);
    for (int i = 0; i < 2; ++i)
        for (int p = 0; p < P; ++p) {
            const int row = i * P + p;
            if (p < n) A[row * D + row] = 1;
            for (int l = 0; thread_ && l < 2; ++l) {
                const Real by = p < n ? theta[row * D + l * P + c] : (l == i ? 1 : 0);
                A_Y[row] += by * pull_by_stretch[l];
                for (int j = 0; j < 2; ++j) A[row * D + j * P + c] += by * pull_by_free[2 * l + j];
            }
        }
    points_by_.assign(static_cast<std::size_t>(S + D) * D, 0.0);
    for (int row = 0; row < D; ++row) {
        for (int x = 0; x < ladder; ++x) {
            Real sum = 0;
            for (int f = 0; f < D; ++f) sum += A[row * D + f] * G[f * ladder + x];
            points_by_[x * D + row] = static_cast<double>(sum);
        }
        if (thread_) points_by_[ladder * D + row] = static_cast<double>(A_Y[row]);
        for (int f = 0; f < D; ++f)
            points_by_[(S + f) * D + row] = static_cast<double>(A[row * D + f]);
    }
}

// state_by_: the next x, from x and phi.
void MomentObstacle::put_state(std::span<const Real> theta, std::span<const Real> G) {
    const int P = points_, D = 2 * P, c = n_, ladder = ladder_ ? D : 0,
              S = ladder + (thread_ ? 1 : 0);
    state_by_.assign(static_cast<std::size_t>(S + D) * S, 0.0);
    for (int k = 0; ladder_ && k < P; ++k)
        for (int row = 0; row < 2; ++row) {  // d, v
            const auto& by = ladder_->pattern(k).by[2 * row];
            const int to = row * P + k;
            for (int x = 0; x < 2; ++x)
                state_by_[(x * P + k) * S + to] = by[x] + (x == row ? 1 : 0);
            for (int j = 0; j < 2; ++j)
                for (int p = 0; p < P; ++p)
                    state_by_[(S + j * P + p) * S + to] = by[2 + j] * ladder_->w(k, p);
        }
    if (!thread_) return;
    for (int x = 0; x < ladder; ++x)
        state_by_[x * S + S - 1] = static_cast<double>(G[c * ladder + x]);
    state_by_[ladder * S + S - 1] = 1;
    for (int f = 0; f < D; ++f)
        state_by_[(S + f) * S + S - 1] = static_cast<double>(theta[c * D + f]);
}

// The matrices of a step. F = free + G x, G the ladder's own motion; pull = K_f F_c + K_s Y_c.
void MomentObstacle::put_linear_part() {
    const int P = points_, n = n_, D = 2 * P, c = n, ladder = ladder_ ? D : 0,
              S = ladder + (thread_ ? 1 : 0);
    std::vector<Real> theta(theta_.begin(), theta_.end()), G(static_cast<std::size_t>(D) * ladder);
    for (int k = 0; ladder_ && k < P; ++k)
        for (int i = 0; i < 2; ++i)
            for (int p = 0; p < P; ++p) {
                const auto& by = ladder_->pattern(k).by[i];
                const Real w = ladder_->w(k, p);
                G[(i * P + p) * ladder + k] = w * by[0];
                G[(i * P + p) * ladder + P + k] = w * by[1];
                for (int j = 0; j < 2; ++j)
                    for (int q = 0; q < P; ++q)
                        theta[(i * P + p) * D + j * P + q] += w * by[2 + j] * ladder_->w(k, q);
            }
    std::vector<Real> pull_by_free(4), pull_by_stretch(2), answer(4 * n);
    if (thread_) {
        const double k = thread_->stiffness, r = thread_->damping / span_;
        const Real K[2][2] = {{0.5 * k + r, -0.5 * k}, {0.5 * k, 3 * r}};
        std::vector<Real> one(4);
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                one[2 * i + j] = (i == j) + K[i][0] * theta[c * D + j * P + c] +
                                 K[i][1] * theta[(P + c) * D + j * P + c];
        one = inverse_of(one, 2);
        for (int i = 0; i < 2; ++i) {
            pull_by_stretch[i] = -one[2 * i] * k;
            for (int j = 0; j < 2; ++j) {
                pull_by_free[2 * i + j] = -(one[2 * i] * K[0][j] + one[2 * i + 1] * K[1][j]);
                for (int a = 0; a < n; ++a)
                    for (int l = 0; l < 2; ++l)
                        for (int m = 0; m < 2; ++m)
                            answer[(2 * i + j) * n + a] -=
                                one[2 * i + l] * K[l][m] * theta[(m * P + c) * D + j * P + a];
            }
        }
    }
    pull_by_.assign(answer.begin(), answer.end());
    put_points(theta, G, pull_by_free, pull_by_stretch);
    put_state(theta, G);
    for (int j = 0; j < 2; ++j)
        for (int b = 0; b < n; ++b)
            for (int i = 0; i < 2; ++i)
                for (int a = 0; a < n; ++a) {
                    Real sum = theta[(i * P + a) * D + j * P + b];
                    for (int l = 0; thread_ && l < 2; ++l)
                        sum += theta[(i * P + a) * D + l * P + c] * answer[(2 * l + j) * n + b];
                    T_.push_back(static_cast<double>(sum));
                }
    x_.assign(S, 0.0);
}

void MomentObstacle::begin(const double* reading, const double*, const double* force) {
    if (ladder_) ladder_->rest(force, x_.data());
    const auto at = [&](int p) {
        return reading[p] + (ladder_ ? ladder_->yields(x_.data(), p) : 0);
    };
    for (int a = 0; a < n_; ++a) {
        at_[a] = {};
        at_[a].eta = contacts_.heights[a] - at(a);
    }
    if (thread_) x_.back() = at(n_) - thread_->height;
    x_before_ = x_;
    std::fill(last_.begin(), last_.end(), 0.0);
    set_ = 0;
}

void MomentObstacle::start_from(const MomentObstacle& before) noexcept {
    if (!ladder_) return;
    const auto yields = [&](int p) { return ladder_->yields(x_.data(), p); };
    for (int p = 0; p < points_; ++p) spring_[p] = yields(p);
    std::copy_n(before.x_.begin(), 2 * points_, x_.begin());
    for (int a = 0; a < n_; ++a) at_[a].eta += spring_[a] - yields(a);
    if (thread_) x_.back() += yields(n_) - spring_[n_];
}

double MomentObstacle::potential(const double*, int) const {
    double sum = ladder_ ? ladder_->stored(x_.data()) : 0;
    for (int a = 0; a < n_; ++a) sum += rules_[a].law().potential(at_[a].eta);
    if (thread_) sum += 0.5 * thread_->stiffness * x_.back() * x_.back();
    return sum;
}

double MomentObstacle::loss() const {
    double lost = ladder_ ? ladder_->lost(x_before_.data(), last_.data()) : 0;
    for (int a = 0; a < n_; ++a) lost += lost_by(a, 0);
    if (thread_ && thread_->damping > 0) {  // r_c/H (r_0^2 + 3 r_1^2), r_1 from phi_c1
        const double r = thread_->damping / span_, r_0 = x_.back() - x_before_.back(),
                     r_1 = -(last_.back() + 0.5 * thread_->stiffness * r_0) / (3 * r);
        lost += r * (r_0 * r_0 + 3 * r_1 * r_1);
    }
    return lost / span_;
}

void MomentObstacle::take(int a, const MomentContact& s) noexcept {
    Point& p = at_[a];
    moved_[a] = p.eta - s.to;
    p = {s.to, p.eta, s.from, s.lost_by_ends, s.lost};
    if (s.touches && rules_[a].is_linear()) set_ |= std::uint64_t{1} << a;
    if (s.phi_0 != 0 || s.phi_1 != 0) tally_.note(s.phi_0, std::max({p.eta_before, p.eta, s.from}));
}

bool MomentObstacle::alone(const double* b, double* force) noexcept {
    if (rules_[0].stays_out(at_[0].eta, b[0], b[points_])) {
        force[0] = force[points_] = 0;
        take_out(0, b[0]);
        return true;
    }
    MomentContact& s = found_[0];
    rules_[0].solve(own(0), at_[0].eta, b[0], b[points_], s);
    if (!s.converged) return by_constant_forces(b, force);
    force[0] = s.phi_0, force[points_] = s.phi_1;
    take(0, s);
    tally_.note(s.iterations, s.residual);
    return true;
}

// Inverse for the linear contacts in full contact: c (phi_0 + phi_1) + (T phi)_0 = E_1 and c (phi_0
// - phi_1) - (T phi)_1 = E_0.
void MomentObstacle::keep(std::uint64_t set, Kept& s) noexcept {
    s.set = set;
    std::fill(s.inverse.begin(), s.inverse.end(), 0.0);
    int size = 0;
    for (int a = 0; a < n_; ++a)
        if (set >> a & 1) kept_[size++] = a;
    const int m = 2 * size, columns = 2 * m;
    double* rows = matrix_.data();
    std::fill_n(rows, m * columns, 0.0);
    for (int x = 0; x < size; ++x) {
        const int a = kept_[x];
        const double c = rules_[a].c();
        double *first = rows + x * columns, *second = rows + (size + x) * columns;
        for (int y = 0; y < size; ++y)
            for (int j = 0; j < 2; ++j) {
                first[j * size + y] = T(0, a, j, kept_[y]);
                second[j * size + y] = -T(1, a, j, kept_[y]);
            }
        first[x] += c, first[size + x] += c;
        second[x] += c, second[size + x] -= c;
        first[m + x] = second[m + size + x] = 1;
    }
    eliminate(rows, m, columns);
    const auto place = [&](int i) { return i / size * n_ + kept_[i % size]; };
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j)
            s.inverse[place(j) * 2 * n_ + place(i)] = rows[i * columns + m + j];
}

// Solves a step in which contacts change: those that misfit by their own equations, together; the
// others in full contact and eliminated, or out. Others that misfit then join them.
template <int few>
bool MomentObstacle::with_change(const InFull& before, std::uint64_t misfits, const double* b,
                                 const double* ends, double* force) noexcept {
    for (std::uint64_t own = misfits, more = 0;; own |= more) {
        more = together<few>(before, own, b, ends, force);
        if (more == 0) return true;
        if ((more & ~own) == 0) return by_constant_forces(b, force);
    }
}

// Responses to forces of the contacts `active_`, the contacts `full` eliminated.
void MomentObstacle::reduce(std::uint64_t own, std::uint64_t full) noexcept {
    Reduced& R = place_of(own ^ full << std::min(n_, few), reduced_);
    reduced_now_ = &R;
    if (R.own == own && R.full == full) return;
    R.own = own, R.full = full;
    const int n = n_, D = 2 * n, m = static_cast<int>(active_.size());
    for (int j = 0; j < m; ++j)
        for (int l = 0; l < 2; ++l) {
            const int a = active_[j], column = 2 * j + l;
            double *by = R.by.data() + column * D, *moved = R.moved.data() + column * D,
                   *change = trial_.data();  // change of the ends
            for (int c = 0; c < n; ++c) change[c] = -T(0, c, l, a), change[n + c] = T(1, c, l, a);
            if (full) product_of_pairs<0>(kept(full).inverse.data(), change, by);
            else std::fill_n(by, D, 0.0);
            product_of_pairs<0>(T_.data(), by, moved);
            for (int k = 0; k < D; ++k) moved[k] += T_[(l * n + a) * D + k];
            for (int i = 0; i < m; ++i) {
                MomentMatrix& less = R.less[i * m + j];
                (l == 0 ? less.m00 : less.m01) = moved[active_[i]];
                (l == 0 ? less.m10 : less.m11) = moved[n + active_[i]];
            }
        }
}

// Solves a step with the contacts `own` by their own equations, the others of the set in full
// contact. Returns the others that misfit, 0 for a solution, or all contacts if there is none.
template <int few>
std::uint64_t MomentObstacle::together(const InFull& before, std::uint64_t own, const double* b,
                                       const double* ends, double* force) noexcept {
    const int n = few > 0 ? few : n_, D = 2 * n;
    const std::uint64_t full = before.set & ~own;
    active_.clear();
    for (int a = 0; a < n; ++a)
        if (own >> a & 1) active_.push_back(a);
    const int m = static_cast<int>(active_.size());
    reduce(own, full);
    double *others = trial_.data(), *r = pairs_.data() + 3 * D;  // first without forces of own
    if (full != 0 && full == before.set) {
        std::copy_n(before.phi, D, others);
        std::copy_n(before.r, D, r);
    } else {
        std::fill_n(others, D, 0.0);
        std::fill_n(r, D, 0.0);
        if (full) {
            product_of_pairs<few>(kept(full).inverse.data(), ends, others);
            product_of_pairs<few>(T_.data(), others, r);
        }
        for (int c = 0; c < n; ++c) r[c] += b[c], r[n + c] += b[points_ + c];
    }
    for (int i = 0; i < m; ++i) {  // a first guess: the pushing forces of full contact
        const int a = active_[i];
        own_b_[2 * i] = r[a], own_b_[2 * i + 1] = r[n + a];
        const double F = x_own_[2 * i] = std::max(before.phi[a], 0.0);
        x_own_[2 * i + 1] = std::clamp(before.phi[n + a], -F, F);
    }
    const int iterations = newton();
    if (iterations < 0) return ~std::uint64_t{0} >> (most_contacts - n);
    for (int i = 0; i < m; ++i)
        x_own_[2 * i] = found_[i].phi_0, x_own_[2 * i + 1] = found_[i].phi_1;
    if (full) add_product<2 * few>(reduced_now_->by.data(), x_own_.data(), 2 * m, others, D);
    add_product<2 * few>(reduced_now_->moved.data(), x_own_.data(), 2 * m, r, D);
    std::uint64_t misfits = 0;
    for (int c = 0; c < n; ++c)
        misfits |= std::uint64_t{!(own >> c & 1) && !fits(c, full >> c & 1, others, r)} << c;
    if (misfits) return misfits;
    set_ = full;
    for (int c = 0; c < n; ++c)
        if (!(own >> c & 1)) take_as(c, full >> c & 1, others, r, force);
    for (int i = 0; i < m; ++i) {
        const int a = active_[i];
        force[a] = found_[i].phi_0, force[points_ + a] = found_[i].phi_1;
        take(a, found_[i]);
    }
    if (m == 1) tally_.note(found_[0].iterations, found_[0].residual);
    else tally_.note(std::max(iterations, 1), 0);
    return 0;
}

#define JVARI_CHANGE(few)                                                                       \
    template bool MomentObstacle::with_change<few>(const InFull&, std::uint64_t, const double*, \
                                                   const double*, double*) noexcept;
JVARI_CHANGE(0)
JVARI_CHANGE(1)
JVARI_CHANGE(2)
JVARI_CHANGE(3)
JVARI_CHANGE(4)
JVARI_CHANGE(5)
#undef JVARI_CHANGE

// Solves an active contact for itself under the forces x_own_ of the others, into found_.
void MomentObstacle::solve_own(int i) noexcept {
    const int m = static_cast<int>(active_.size()), a = active_[i];
    double b_0 = own_b_[2 * i], b_1 = own_b_[2 * i + 1];
    for (int j = 0; j < m; ++j) {
        if (j == i) continue;
        const MomentMatrix& T = less(i, j);
        b_0 += T.m00 * x_own_[2 * j] + T.m01 * x_own_[2 * j + 1];
        b_1 += T.m10 * x_own_[2 * j] + T.m11 * x_own_[2 * j + 1];
    }
    rules_[a].solve(less(i, i), at_[a].eta, b_0, b_1, found_[i]);
}

// Solves each active contact for itself. Returns the residual of phi = S(phi): the sum of squares,
// and the largest against the largest force.
MomentObstacle::Rest MomentObstacle::look() noexcept {
    Rest rest;
    double largest = 0;
    for (int i = 0; i < static_cast<int>(active_.size()); ++i) {
        solve_own(i);
        const MomentContact& s = found_[i];
        const double d_0 = step_[2 * i] = s.phi_0 - x_own_[2 * i],
                     d_1 = step_[2 * i + 1] = s.phi_1 - x_own_[2 * i + 1];
        rest.squares += d_0 * d_0 + d_1 * d_1;
        rest.relative = std::max({rest.relative, std::abs(d_0), std::abs(d_1)});
        largest = std::max({largest, std::abs(s.phi_0), std::abs(s.phi_1)});
    }
    rest.relative = rest.relative > 0 ? rest.relative / largest : 0;
    return rest;
}

// Newton's step for phi = S(phi), from the residuals in step_ into step_: (1 - S' T) step =
// residual, S' = answer(). False if the matrix is singular.
bool MomentObstacle::newton_step() noexcept {
    const int m = static_cast<int>(active_.size());
    for (int i = 0; i < m; ++i)
        answers_[i] = found_[i].phi_0 == 0 && found_[i].phi_1 == 0
                          ? MomentMatrix{}
                          : rules_[active_[i]].answer(less(i, i), found_[i]);
    if (m == 2) return newton_step_of_two();
    const int size = 2 * m, columns = size + 1;
    for (int i = 0; i < m; ++i) {
        double *first = matrix_.data() + 2 * i * columns, *second = first + columns;
        for (int j = 0; j < m; ++j) {
            const bool same = i == j;
            const MomentMatrix by = same ? MomentMatrix{} : times(answers_[i], less(i, j));
            first[2 * j] = same - by.m00, first[2 * j + 1] = -by.m01;
            second[2 * j] = -by.m10, second[2 * j + 1] = same - by.m11;
        }
        first[size] = step_[2 * i], second[size] = step_[2 * i + 1];
    }
    if (!eliminate(matrix_.data(), size, columns)) return false;
    for (int i = 0; i < size; ++i) step_[i] = matrix_[i * columns + size];
    return true;
}

// newton_step() of two, by blocks: (1 - A B) step_0 = rest_0 + A rest_1, step_1 = rest_1 + B
// step_0.
bool MomentObstacle::newton_step_of_two() noexcept {
    double* s = step_.data();
    const MomentMatrix A = times(answers_[0], less(0, 1)), B = times(answers_[1], less(1, 0)),
                       both = times(A, B), one{1 - both.m00, -both.m01, -both.m10, 1 - both.m11};
    const double det = one.m00 * one.m11 - one.m01 * one.m10,
                 s_0 = s[0] + A.m00 * s[2] + A.m01 * s[3], s_1 = s[1] + A.m10 * s[2] + A.m11 * s[3];
    if (!(std::abs(det) > 0)) return false;
    s[0] = (one.m11 * s_0 - one.m01 * s_1) / det;
    s[1] = (one.m00 * s_1 - one.m10 * s_0) / det;
    s[2] += B.m00 * s[0] + B.m01 * s[1];
    s[3] += B.m10 * s[0] + B.m11 * s[1];
    return true;
}

// Newton's steps with a search along each, then one contact after another with half of each change.
// Returns the iterations, or -1 without a solution.
int MomentObstacle::newton() noexcept {
    constexpr double enough = 1e-13;
    const int m = static_cast<int>(active_.size()), D = 2 * m;
    if (m == 1) {
        solve_own(0);
        return found_[0].converged ? 0 : -1;
    }
    int iterations = 0, halved = 0;
    double squares = std::numeric_limits<double>::infinity();
    bool solved = false;
    for (; iterations < most_blocks; ++iterations) {
        const Rest rest = look();
        solved = rest.relative <= enough;
        if (solved) break;
        if (rest.squares >= squares && halved < 6) {
            ++halved;
            for (int i = 0; i < D; ++i) last_step_[i] *= 0.5, x_own_[i] = from_[i] + last_step_[i];
            continue;
        }
        halved = 0;
        squares = rest.squares;
        if (!newton_step()) break;
        for (int i = 0; i < D; ++i)
            from_[i] = x_own_[i], last_step_[i] = step_[i], x_own_[i] += step_[i];
    }
    for (int sweep = 0; sweep < most_sweeps && !solved; ++sweep, ++iterations) {
        for (int i = 0; i < m; ++i) {
            solve_own(i);
            x_own_[2 * i] += 0.5 * (found_[i].phi_0 - x_own_[2 * i]);
            x_own_[2 * i + 1] += 0.5 * (found_[i].phi_1 - x_own_[2 * i + 1]);
        }
        solved = look().relative <= enough;
    }
    for (int i = 0; i < m; ++i) solved = solved && found_[i].converged;
    return solved ? iterations : -1;
}

bool MomentObstacle::by_constant_forces(const double* b, double* force) noexcept {
    for (int a = 0; a < n_; ++a) trial_[a] = at_[a].eta, ends_[a] = -b[a];
    const GramSolution s = gram_.solve(trial_.data(), ends_.data(), step_.data(), force);
    set_ = 0;
    ++constant_;
    for (int a = 0; a < n_; ++a) {
        force[points_ + a] = 0;
        MomentContact one;
        const ContactLaw& law = rules_[a].law();
        one.phi_0 = force[a], one.from = at_[a].eta, one.to = at_[a].eta - step_[a];
        one.touches = one.to > 0;
        if (one.touches) {  // by its energy: a stiff contact's depth is far below the rounding of r
            const double V = law.potential(at_[a].eta) - force[a] * step_[a];
            one.to = std::pow(std::max(V, 0.0) * (law.alpha + 1) / law.k, 1 / (law.alpha + 1));
        }
        take(a, one);
    }
    tally_.note(s.iterations, s.residual);
    return s.converged;
}

std::vector<Fact> MomentObstacle::facts() const {
    const auto conserve = std::count_if(rules_.begin(), rules_.end(),
                                        [](const MomentRule& r) { return r.conserves(); });
    std::vector<Fact> f = {{facts::contact_points, static_cast<double>(n_)},
                           {facts::conserving_contacts, static_cast<double>(conserve)},
                           {facts::constant_force_steps, static_cast<double>(constant_)},
                           {facts::smallest_contact_force, tally_.force.least},
                           {facts::largest_contact_force, tally_.force.most},
                           {facts::deepest_penetration, tally_.deepest}};
    if (contacts_.any_rigid())
        f.push_back({facts::rigid_stiffness, std::accumulate(rules_.begin(), rules_.end(), 0.0,
                                                             [](double k, const MomentRule& r) {
                                                                 return std::max(k, r.law().k);
                                                             })});
    const double solves = static_cast<double>(tally_.solves);
    f.push_back({facts::contact_solves, solves});
    f.push_back({facts::contact_iterations_mean,
                 solves > 0 ? static_cast<double>(tally_.iterations) / solves : 0});
    f.push_back({facts::contact_iterations_most, static_cast<double>(tally_.most_iterations)});
    f.push_back({facts::contact_residual, tally_.residual});
    return f;
}

}  // namespace jvari

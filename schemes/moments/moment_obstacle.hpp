// Solves a step's contacts and thread whose forces are lines in the step (moment_contact.hpp), with
// the ladder in series: the counterpart of obstacle.hpp for two moments. Arrays over the points
// have the means first, then the first moments.
//
//     r = free + Theta phi,   phi_c = -k_c (Y_c, 0) - K_c r_c of the thread, eliminated         (5)
//     K_c = [[k_c/2 + r_c/H, -k_c/2], [k_c/2, 3 r_c/H]]
//
// Everything except the contacts is linear. With x the ladder's state and the stretch Y_c of the
// thread, one matrix makes b for each contact and the thread's pull from x and free alone. Other
// matrices make phi_c and the next x.
//
// Several contacts (docs/two-moments.md, section 7):
//   1. one contact alone, by its own equation, the others out (tried_alone in few_contacts.hpp);
//   2. the contacts that touched after the last step are in full contact, the others out: one
//      matrix, whose inverse is kept;
//   3. contacts that contradict this are solved by their own equations, together, with the others
//      eliminated: one by its closed form, several by Newton's steps.
// If no solution is found, even for one contact alone, forces are constant in the step
// (contact_gram.hpp).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "schemes/contact/contact_gram.hpp"
#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/contact/obstacle.hpp"
#include "schemes/contact/products.hpp"
#include "schemes/moments/exact_ladder.hpp"
#include "schemes/moments/moment_contact.hpp"

namespace jvari {

class MomentObstacle {
public:
    static constexpr int most_contacts = 64;

    // theta: row-major over the points' moments [m/N]; span: H [s]
    MomentObstacle(const Contacts&, const std::vector<Thread>&, std::span<const double> theta,
                   double span, const MissingMatrix* series);

    int contacts() const { return contacts_.count(); }
    int points() const { return points_; }
    int dofs() const { return 0; }  // beyond the string's own state
    void clear() { tally_ = {}, constant_ = 0; }
    void begin(const double* reading, const double* moving, const double* force);
    bool is_like(const MomentObstacle& other) const {
        return contacts() == other.contacts() && points() == other.points() &&
               ladder_.has_value() == other.ladder_.has_value();
    }
    void start_from(const MomentObstacle& before) noexcept;

    // Solves like Obstacle, for readings whose `free` has two moments per point. Allocates nothing.
    bool solve(const ReadingsBeforeStep& at, double* force, bool = false) noexcept {
        return step<0, false, false>(at.free, force);
    }
    // few: number of points, if known at compile time, followed by flags for a thread and a ladder
    template <int few, bool thread, bool series>
    [[gnu::always_inline]] bool step(const double* free, double* force) noexcept;
    const double* moved() const { return moved_.data(); }
    double lost_by(int a, double) const noexcept {  // by a contact in the last step [J]
        const Point& p = at_[a];
        return p.lost_by_ends ? rules_[a].lost(p.eta_before, p.from) : p.lost;
    }

    double potential(const double*, int = 0) const;  // [J]
    double loss() const;                             // in the last step [W]
    const double* forces(int) noexcept {             // in the series springs [N]
        if (ladder_) ladder_->forces(x_.data(), spring_.data());
        return spring_.data();
    }
    std::vector<Fact> facts() const;
    bool has_series() const { return ladder_.has_value(); }

private:
    struct Point {                 // a contact
        double eta = 0;            // penetration [m]
        double eta_before = 0;     // at the beginning of the last step
        double from = 0;           // e_0 in the last step,
        bool lost_by_ends = true;  // by rule D without contact loss; otherwise
        double lost = 0;           // [J]
    };
    struct Kept {  // a set of linear contacts in full contact
        std::uint64_t set = 0;
        // phi_0 for all contacts, then phi_1, from E_1 for all, then E_0: 2n x 2n, by columns;
        // zeros in rows and columns of the others
        std::vector<double> inverse;
    };
    struct InFull {  // forces and r of all contacts with a set in full contact, the others out
        std::uint64_t set;
        const double *phi, *r;
    };
    struct Reduced {  // m contacts by their own equations, those in full contact eliminated
        std::uint64_t own = 0, full = 0;
        std::vector<double> by, moved;   // phi and r of all, by forces of those m: 2n x 2m
        std::vector<MomentMatrix> less;  // r of those m, m x m
    };
    // Place of a set in `some`, as many as a power of 2.
    template <class Some>
    static auto& place_of(std::uint64_t set, Some& some) {
        return some[(set ^ (set >> 7) ^ (set >> 19)) & (some.size() - 1)];
    }
    double T(int i, int a, int j, int b) const {  // between contacts, the thread eliminated
        return T_[(j * n_ + b) * 2 * n_ + i * n_ + a];
    }
    MomentMatrix between(int a, int b) const {
        return {T(0, a, 0, b), T(0, a, 1, b), T(1, a, 0, b), T(1, a, 1, b)};
    }
    MomentMatrix own(int a) const { return between(a, a); }
    template <int few>
    [[gnu::always_inline]] bool one(const double* b, double* force) noexcept;
    bool alone(const double* b, double* force) noexcept;
    template <int few, bool thread>
    [[gnu::always_inline]] bool several(const double* b, double* force) noexcept;
    const Kept& kept(std::uint64_t set) noexcept {
        Kept& s = place_of(set, sets_);
        if (s.set != set) keep(set, s);
        return s;
    }
    void keep(std::uint64_t set, Kept&) noexcept;
    template <int few, bool thread>
    [[gnu::always_inline]] bool only(int a, std::uint64_t touch, const double* b,
                                     const double* ends, double* phi, double* r,
                                     double* force) noexcept;
    // to = M x, with two numbers for each contact
    template <int few>
    [[gnu::always_inline]] void product_of_pairs(const double* M, const double* x,
                                                 double* to) const noexcept {
        product<2 * few>(M, x, 2 * (few > 0 ? few : n_), to, 2 * n_);
    }
    bool fits(int a, bool in, const double* phi, const double* r) const noexcept {
        const double eta = at_[a].eta;
        return in ? phi[a] > std::abs(phi[n_ + a]) : eta - r[a] <= 0 && eta + r[n_ + a] <= 0;
    }
    void take_as(int a, bool in, const double* phi, const double* r, double* force) noexcept {
        force[a] = phi[a], force[points_ + a] = phi[n_ + a];
        if (!in) return take_out(a, r[a]);
        const double c = rules_[a].c();
        take_linear(a, phi[a], c * (phi[a] - phi[n_ + a]), c * (phi[a] + phi[n_ + a]));
    }
    template <int few>
    bool with_change(const InFull&, std::uint64_t misfits, const double* b, const double* ends,
                     double* force) noexcept;
    void reduce(std::uint64_t own, std::uint64_t full) noexcept;
    const MomentMatrix& less(int i, int j) const {
        return reduced_now_->less[i * static_cast<int>(active_.size()) + j];
    }
    template <int few>
    std::uint64_t together(const InFull&, std::uint64_t own, const double* b, const double* ends,
                           double* force) noexcept;
    struct Rest {
        double squares = 0, relative = 0;
    };
    void solve_own(int i) noexcept;
    Rest look() noexcept;
    bool newton_step() noexcept;
    bool newton_step_of_two() noexcept;
    int newton() noexcept;
    bool by_constant_forces(const double* b, double* force) noexcept;
    void take(int a, const MomentContact&) noexcept;
    void take_linear(int a, double phi_0, double from, double to) noexcept {
        Point& p = at_[a];
        moved_[a] = p.eta - to;
        p = {to, p.eta, from, true, 0};
        if (phi_0 != 0) tally_.note(phi_0, std::max({p.eta_before, p.eta, from}));
    }
    void take_out(int a, double moved) noexcept {
        Point& p = at_[a];
        moved_[a] = moved;
        const double lost =
            p.eta <= 0 || rules_[a].conserves() ? 0 : rules_[a].law().potential(p.eta);
        p = {p.eta - moved, p.eta, p.eta, false, lost};
    }

    void put_linear_part();
    void put_points(std::span<const long double> theta, std::span<const long double> G,
                    std::span<const long double> pull_by_free,
                    std::span<const long double> pull_by_stretch);
    void put_state(std::span<const long double> theta, std::span<const long double> G);

    Contacts contacts_;
    int n_, points_;
    double span_;
    std::vector<double> theta_, T_;  // T_ by columns
    std::vector<MomentRule> rules_;
    std::vector<Point> at_;
    std::optional<Thread> thread_;
    std::optional<ExactLadder> ladder_;
    // d and v in the ladder, then the thread's stretch Y_c - h_c; at the beginning of the last step
    std::vector<double> x_, x_before_;
    // By columns: b for the contacts and the thread's pull, from x, then from free; the next x,
    // from x, then from phi.
    std::vector<double> points_by_, state_by_;
    std::vector<double> pull_by_;   // phi_c from the contacts' phi, 2 x 2n
    std::vector<double> last_;      // phi in the last step
    std::vector<double> inverses_;  // Kept's, for each linear contact alone; zeros for others
    ContactTally tally_;
    std::vector<double> b_, next_, moved_, spring_;  // workspaces; r_0; C^-1 D
    std::vector<double> pairs_, ends_, trial_, step_, matrix_;
    // Contacts solved together by their own equations: in this order the free motion with those in
    // full contact eliminated, the forces, and Newton's steps.
    std::vector<int> active_;
    std::vector<MomentContact> found_;
    std::vector<MomentMatrix> answers_;
    std::vector<double> own_b_, x_own_, from_, last_step_;
    ContactGram gram_;
    long constant_ = 0;  // steps with constant forces
    std::vector<int> kept_;
    std::uint64_t set_ = 0, linear_ = 0;  // touching linear contacts; all linear contacts
    std::vector<Kept> sets_;
    std::vector<Reduced> reduced_;
    const Reduced* reduced_now_ = nullptr;
};

// Inline for the kernels that make whole steps.
template <int few, bool thread, bool series>
[[gnu::always_inline]] inline bool MomentObstacle::step(const double* free,
                                                        double* force) noexcept {
    constexpr int D = few > 0 ? 2 * few : 0, S = few > 0 ? 2 * few * series + thread : 0;
    const int P = few > 0 ? few : points_, n = few > 0 ? few - thread : n_, c = n,
              states = few > 0 ? S : static_cast<int>(x_.size());
    const bool has_thread = few > 0 ? thread : thread_.has_value();
    double local[D > 0 ? 2 * D : 1], state[S > 0 ? S : 1];
    double *b = few > 0 ? local : b_.data(), *by_state = b + 2 * P,
           *next = few > 0 ? state : next_.data();
    const double* x = x_.data();
    if (states == 0) {
        for (int i = 0; i < 2 * P; ++i) b[i] = free[i];
    } else {  // first all that can be computed before the sums of the modes
        product<S>(state_by_.data(), x, states, next, states);
        product<D>(points_by_.data(), x, states, by_state, 2 * P);
        if (has_thread)
            product<D, true>(points_by_.data() + states * 2 * P, free, 2 * P, b, 2 * P, by_state);
        else  // the matrix is the identity
            for (int i = 0; i < 2 * P; ++i) b[i] = by_state[i] + free[i];
    }
    bool converged = true;
    if (n == 1) converged = one<few>(b, force);
    else if (n > 1) converged = several<few - (few > 0 && thread), thread>(b, force);
    if (has_thread) {
        double pull_0 = b[c], pull_1 = b[P + c];
        for (int a = 0; a < n; ++a) {
            pull_0 += pull_by_[a] * force[a] + pull_by_[n + a] * force[P + a];
            pull_1 += pull_by_[2 * n + a] * force[a] + pull_by_[3 * n + a] * force[P + a];
        }
        force[c] = pull_0, force[P + c] = pull_1;
        next[states - 1] += free[c];
    }
    if (states > 0) {
        bool forced = has_thread;
        for (int i = 0; i < 2 * P; ++i) forced = forced || force[i] != 0;
        if (forced) add_product<S>(state_by_.data() + states * states, force, 2 * P, next, states);
        std::memcpy(x_before_.data(), x, sizeof(double) * states);
        std::memcpy(x_.data(), next, sizeof(double) * states);
        for (int i = 0; i < 2 * P; ++i) last_[i] = force[i];
    }
    return converged;
}

template <int few>
[[gnu::always_inline]] inline bool MomentObstacle::one(const double* b, double* force) noexcept {
    const int P = few > 0 ? few : points_;
    Point& at = at_[0];
    const double E_1 = at.eta - b[0], E_0 = at.eta + b[P];
    if (linear_) {
        if (E_0 <= 0 && E_1 <= 0) {
            force[0] = force[P] = 0;
            moved_[0] = b[0];
            at = {E_1, at.eta, E_0, true, 0};
            return true;
        }
        const double phi_0 = inverses_[0] * E_1 + inverses_[2] * E_0,
                     phi_1 = inverses_[1] * E_1 + inverses_[3] * E_0;
        if (phi_0 > std::abs(phi_1)) {
            force[0] = phi_0, force[P] = phi_1;
            const double c = rules_[0].c(), to = c * (phi_0 + phi_1);
            moved_[0] = at.eta - to;
            at = {to, at.eta, c * (phi_0 - phi_1), true, 0};
            tally_.note(phi_0, std::max(at.eta_before, to));
            tally_.note(0, 0);
            return true;
        }
    }
    return alone(b, force);
}

template <int few, bool thread>
[[gnu::always_inline]] inline bool MomentObstacle::several(const double* b,
                                                           double* force) noexcept {
    const int n = few > 0 ? few : n_, P = few > 0 ? few + thread : points_;
    double local[few > 0 ? 6 * few : 1];
    double *ends = few > 0 ? local : pairs_.data(), *phi = ends + 2 * n, *r = phi + 2 * n;
    std::uint64_t touch = 0;
    for (int a = 0; a < n; ++a) {
        ends[a] = at_[a].eta - b[a], ends[n + a] = at_[a].eta + b[P + a];
        touch |= std::uint64_t{ends[a] > 0 || ends[n + a] > 0} << a;
    }
    if (touch == 0) {
        for (int a = 0; a < n; ++a) force[a] = force[P + a] = 0, take_out(a, b[a]);
        set_ = 0;
        return true;
    }
    if (const int one = tried_alone(touch, set_, ends, n); one >= 0)
        return only<few, thread>(one, touch, b, ends, phi, r, force);
    product_of_pairs<few>(kept(set_).inverse.data(), ends, phi);
    product_of_pairs<few>(T_.data(), phi, r);
    for (int a = 0; a < n; ++a) r[a] += b[a], r[n + a] += b[P + a];
    std::uint64_t misfits = 0;
    for (int a = 0; a < n; ++a) misfits |= std::uint64_t{!fits(a, set_ >> a & 1, phi, r)} << a;
    if (misfits != 0) return with_change<std::max(few, 0)>({set_, phi, r}, misfits, b, ends, force);
    for (int a = 0; a < n; ++a) take_as(a, set_ >> a & 1, phi, r, force);
    tally_.note(0, 0);
    return true;
}

// Solves contact a by its own equation, the others out, or with those that do not stay out.
template <int few, bool thread>
[[gnu::always_inline]] inline bool MomentObstacle::only(int a, std::uint64_t touch, const double* b,
                                                        const double* ends, double* phi, double* r,
                                                        double* force) noexcept {
    const int n = few > 0 ? few : n_, P = few > 0 ? few + thread : points_;
    const double* I = inverses_.data() + 4 * a;
    MomentContact& own_step = found_[a];
    double phi_0 = I[0] * ends[a] + I[2] * ends[n + a], phi_1 = I[1] * ends[a] + I[3] * ends[n + a];
    const bool full = phi_0 > std::abs(phi_1);
    const std::uint64_t one = std::uint64_t{1} << a;
    if (!full) {
        rules_[a].solve(own(a), at_[a].eta, b[a], b[P + a], own_step);
        phi_0 = own_step.phi_0, phi_1 = own_step.phi_1;
    }
    const double *by_0 = T_.data() + a * 2 * n, *by_1 = T_.data() + (n + a) * 2 * n;
    std::uint64_t misfits = 0;
    for (int c = 0; c < n; ++c) {  // stores to places known when compiled
        r[c] = b[c] + (by_0[c] * phi_0 + by_1[c] * phi_1);
        r[n + c] = b[P + c] + (by_0[n + c] * phi_0 + by_1[n + c] * phi_1);
        phi[c] = c == a ? phi_0 : 0;
        phi[n + c] = c == a ? phi_1 : 0;
        misfits |= std::uint64_t{c != a && !fits(c, false, phi, r)} << c;
        force[c] = phi[c], force[P + c] = phi[n + c];
    }
    if (!full && !own_step.converged) misfits = touch;
    if (misfits != 0)
        return with_change<std::max(few, 0)>({full ? one : 0, phi, r},
                                             full ? misfits : misfits | one, b, ends, force);
    for (int c = 0; c < n; ++c)
        if (c != a) take_out(c, r[c]);
    set_ = 0;
    if (full) {
        const double c = rules_[a].c();
        take_linear(a, phi_0, c * (phi_0 - phi_1), c * (phi_0 + phi_1));
        set_ = one;
        tally_.note(0, 0);
    } else {
        take(a, own_step);
        tally_.note(own_step.iterations, own_step.residual);
    }
    return true;
}

}  // namespace jvari

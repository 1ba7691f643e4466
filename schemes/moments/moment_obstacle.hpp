// A step's contacts and thread where their forces are lines in it (moment_contact.hpp), with the
// ladder in series: what obstacle.hpp is to steps of one moment. Arrays over the points have the
// means first, then the first moments.
//
//     r = free + Theta phi,   phi_c = -k_c (Y_c, 0) - K_c r_c of the thread, eliminated         (5)
//     K_c = [[k_c/2 + r_c/H, -k_c/2], [k_c/2, 3 r_c/H]]
//
// Several contacts (docs/two-moments.md, section 7):
//   1. the contacts that touched after the last step are in full contact, the others out: one
//      matrix, whose inverse is kept;
//   2. where one contact does not agree, its own equation with the others eliminated;
//   3. else Newton's steps on all of them, each contact solved for itself.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/contact/obstacle.hpp"
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
    int dofs() const;  // beyond what follows from the string's state
    void clear() { tally_ = {}; }
    void begin(const double* reading, const double* moving, const double* force);
    bool is_like(const MomentObstacle& other) const {
        return contacts() == other.contacts() && points() == other.points() &&
               ladder_.has_value() == other.ladder_.has_value();
    }
    void start_from(const MomentObstacle& before) noexcept;

    // As Obstacle's, of readings whose `free` has two moments a point. Allocates nothing.
    bool solve(const ReadingsBeforeStep& at, double* force, bool = false) noexcept {
        return step<0, false>(at.free, force);
    }
    template <int few, bool thread>
    [[gnu::always_inline]] bool step(const double* free, double* force) noexcept;
    const double* moved() const { return moved_.data(); }

    double potential(const double*, int = 0) const;  // [J]
    double loss() const;                             // in the last step [W]
    const double* forces(int) noexcept {  // of the springs in series [N]
        if (ladder_) ladder_->forces(spring_.data());
        return spring_.data();
    }
    std::vector<Fact> facts() const;
    bool any_force(const double* force) const noexcept {
        for (int a = 0; a < contacts(); ++a)
            if (force[a] != 0 || force[points_ + a] != 0) return true;
        return false;
    }

private:
    struct Point {                               // a contact
        double eta = 0, stored = 0;              // penetration [m]; V of a rigid barrier [J]
        double eta_before = 0, stored_before = 0;  // at the beginning of the last step
        double from = 0, force_from = 0;         // e_0 [m] and V'(e_0) [N] of the last step,
        bool closed = true;                      // where that had a closed form; else
        double lost = 0;                         // [J]
    };
    struct Kept {  // a set of linear contacts in full contact
        std::uint64_t set = 0;
        std::vector<int> contacts;
        std::vector<double> inverse;  // of E_1, E_0 of each: phi_0, phi_1 of each
        int size = 0;                 // contacts
    };
    double T(int i, int a, int j, int b) const {  // between contacts, the thread eliminated
        return T_[((i * n_ + a) * 2 + j) * n_ + b];
    }
    MomentMatrix own(int a) const { return {T(0, a, 0, a), T(0, a, 1, a), T(1, a, 0, a), T(1, a, 1, a)}; }
    template <int few>
    [[gnu::always_inline]] bool one(const double* b, double* force) noexcept;
    bool alone(const double* b, double* force) noexcept;
    bool several(const double* b, double* force) noexcept;
    const Kept& kept(std::uint64_t set) noexcept;
    bool by_set(const Kept&, const double* b, double* force) noexcept;
    bool with_one(std::uint64_t others, int a, const double* b, double* force) noexcept;
    bool by_newton(const double* b, double* force) noexcept;
    bool in_turn(const double* b, double* force, int iterations) noexcept;
    void moved_by_others(int a, const double* b, const double* force, double& b_0,
                         double& b_1) const noexcept;
    void take(int a, const MomentContact&) noexcept;
    void take_linear(int a, double phi_0, double phi_1, double from, double to) noexcept;

    Contacts contacts_;
    int n_, points_;
    double span_;
    std::vector<double> theta_, T_;
    std::vector<MomentRule> rules_;
    std::vector<Point> at_;
    std::optional<Thread> thread_;
    double stretch_ = 0, stretch_before_ = 0;  // Y_c - h_c [m]
    double moved_thread_ = 0, pull_1_ = 0;     // r_c0 and phi_c1 in the last step
    double pull_by_free_[2][2] = {}, pull_by_stretch_[2] = {};
    std::vector<double> answer_;  // of phi_c to the contacts' phi, 2 x 2n [1]
    std::optional<ExactLadder> ladder_;
    double inverse_[4] = {};  // of one linear contact in full contact
    ContactTally tally_;
    std::vector<double> f_, moved_, spring_;  // workspaces: free moments; r_0; C^-1 D
    std::vector<double> ends_, trial_, matrix_;
    std::vector<MomentContact> found_;
    std::vector<int> active_;
    std::uint64_t set_ = 0, linear_ = 0;  // touching linear contacts; all linear contacts
    std::vector<Kept> sets_;
};

// Inline for the kernels that make whole steps. few: points, where known.
template <int few, bool thread>
[[gnu::always_inline]] inline bool MomentObstacle::step(const double* free,
                                                        double* force) noexcept {
    const int P = few > 0 ? few : points_, n = few > 0 ? few - thread : n_, c = n;
    const bool has_thread = few > 0 ? thread : thread_.has_value();
    double local[few > 0 ? 2 * few : 1];
    double* f = few > 0 ? local : f_.data();
    for (int i = 0; i < 2 * P; ++i) f[i] = free[i];
    if (ladder_) ladder_->add_free<few>(f);
    double pull_0 = 0, pull_1 = 0;
    if (has_thread) {
        pull_0 = pull_by_free_[0][0] * f[c] + pull_by_free_[0][1] * f[P + c] +
                 pull_by_stretch_[0] * stretch_;
        pull_1 = pull_by_free_[1][0] * f[c] + pull_by_free_[1][1] * f[P + c] +
                 pull_by_stretch_[1] * stretch_;
        moved_thread_ = f[c];
        for (int i = 0; i < 2; ++i)
            for (int a = 0; a < n; ++a) {
                const double* row = theta_.data() + (i * P + a) * 2 * P;
                f[i * P + a] += row[c] * pull_0 + row[P + c] * pull_1;
            }
    }
    bool converged = true;
    if (n == 1) converged = one<few>(f, force);
    else if (n > 1) converged = several(f, force);
    if (has_thread) {
        for (int a = 0; a < n; ++a) {
            pull_0 -= answer_[a] * force[a] + answer_[n + a] * force[P + a];
            pull_1 -= answer_[2 * n + a] * force[a] + answer_[3 * n + a] * force[P + a];
        }
        force[c] = pull_0, force[P + c] = pull_1;
        const double* row = theta_.data() + c * 2 * P;
        for (int i = 0; i < 2 * P; ++i) moved_thread_ += row[i] * force[i];
        pull_1_ = pull_1;
        stretch_before_ = stretch_;
        stretch_ += moved_thread_;
    }
    if (ladder_) ladder_->step<few>(force);
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
            at = {E_1, 0, at.eta, at.stored, E_0, 0, true, 0};
            return true;
        }
        const double phi_0 = inverse_[0] * E_1 + inverse_[1] * E_0,
                     phi_1 = inverse_[2] * E_1 + inverse_[3] * E_0;
        if (phi_0 > std::abs(phi_1)) {
            force[0] = phi_0, force[P] = phi_1;
            const double c = rules_[0].c(), to = c * (phi_0 + phi_1);
            moved_[0] = at.eta - to;
            at = {to, 0.5 * (phi_0 + phi_1) * to, at.eta, at.stored, c * (phi_0 - phi_1),
                  phi_0 - phi_1, true, 0};
            tally_.note(phi_0, std::max(at.eta_before, to));
            tally_.note(0, 0);
            return true;
        }
    }
    return alone(b, force);
}

}  // namespace jvari

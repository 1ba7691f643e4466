// One step of a string's contacts and thread, given what every scheme has at hand: the reading of each point at the older level, the
// force-free increment of each reading over the step, and the compliances between the points.
//
//     r = free + Theta F;   contacts: F_a = -[V_a(eta_a - r_a) - V_a(eta_a)]/r_a, eta = h - older   (contact_gram.hpp)
//                           thread:   F_c = -k_c (older_c + r_c/2 - h_c) - r_c (damping)/span
//
// span is the time between the older and the newer level: dt in two-point schemes (van Walstijn et al. 2016, eqs 44-48), 2 dt in
// three-point ones, where the thread so sees the mean of the two outer levels and stays stable at any stiffness. The thread is eliminated
// (eliminated_thread.hpp).
//
// Where contacts lose energy (Hunt-Crossley, Issanchou et al. 2016, eq 24), each pulls by D_a r_a more, D_a = beta_a V_a'(eta_a)/span:
// known before the step, and never negative. Then r = (I + Theta D)^-1 (free + Theta F) is the same equation with other compliances, solved
// so only while a lossy contact is closed. It takes sum D_a r_a^2.
//
// What the string lacks at its points stands in series with them (compliance.hpp): a compliance C, beside it dampers R. It moves by D, and
// by the rule at midpoints F = P + (D+ - D)/2 C^-1 + R (D+ - D)/span with P = C^-1 D the force of the spring. So with
// W = (R C/span + 1/2)^-1 and K = C W,
//     D+ = D + K (F - P),   P+ = P + W (F - P),   points at reading + C P,   r = free - K P + (Theta + K) F,
// the equation above with Theta + K for Theta. P' C P/2 is stored, and (D+ - D)' R (D+ - D)/span lost.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.hpp"
#include "schemes/contact/contact_gram.hpp"
#include "schemes/contact/eliminated_thread.hpp"
#include "schemes/contact/residual.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

class ObstacleStep {
public:
    ObstacleStep() = default;
    // theta [m/N]: row-major over the points, the contacts first and then the thread where there is one.
    ObstacleStep(std::span<const ContactLaw> laws, std::span<const double> heights, const std::optional<Thread>& thread,
                 std::span<const double> theta, double span);

    void lose(std::span<const double> beta);  // Hunt-Crossley beta of each contact [s/m], 0: it loses nothing; with nothing in series

    int contacts() const { return contacts_; }
    int coupled() const { return gram_.coupled(); }
    int points() const { return contacts_ + (thread_.law() ? 1 : 0); }

    // older and free [m] in, force on the string [N] out, one per point. False where the contacts did not converge. Allocates nothing.
    bool solve(const double* older, const double* free, double* force) noexcept;

    // At the readings of one level [J]; level: 0 the one that the next step starts from, 1 the one after it (with something in series).
    double potential(const double* reading, int level = 0) const;
    double loss(
        double r_c) const;  // of the last step [W]: of the thread, whose reading moved by r_c, of lossy contacts, of what is in series

    void put_in_series(const MissingMatrix&, int levels);  // levels: how many of them a step spans
    void begin(const double* reading);                     // at rest at t = 0
    void follow(const ObstacleStep& first);                // after `first` made the first step, of one level
    void forces(int level, double* force) const;           // of each point at that level, of what is in series

    struct Tally {  // over the solves since clear()
        ForceRange force;
        double deepest = 0, residual = 0;
        long solves = 0, iterations = 0;
        int most_iterations = 0;
    };
    const Tally& tally() const { return tally_; }
    std::vector<Fact> facts() const;           // of the tally
    static constexpr int dofs() { return 0; }  // it carries no state
    void clear() { tally_ = {}; }

private:
    int contacts_ = 0;
    ThreadAmongContacts thread_;
    ContactGram gram_;
    std::vector<ContactLaw> laws_;
    std::vector<double> heights_, eta_, b_, r_;
    double span_ = 1;
    Tally tally_;

    bool solve_points(const double* older, const double* free, double* force) noexcept;
    struct Lossy {
        std::vector<double> beta, drag;            // [s/m], D [N/m]
        std::vector<double> theta, damped;         // of the contacts, the thread eliminated: as it is, and with D
        std::vector<double> matrix, root, across;  // workspaces: L, S, X
        std::vector<double> b, off;                // b without D; by how much the readings miss the forces, on the closed contacts
        std::vector<int> closed;
        double lost = 0;  // in the last step [J]
    };
    std::optional<Lossy> lossy_;
    bool damp() noexcept;
    void settle(double* force) noexcept;
    bool solve_in_series(const double* older, const double* free, double* force) noexcept;

    struct Series : Residual {
        std::array<std::vector<double>, 2> P;  // at the two levels [N]
        std::vector<double> older, free;       // of the points where they touch [m]
        double lost = 0;                       // in the last step [J]
        double thread_moved = 0;               // in it [m]
    };
    int levels_ = 1;
    std::optional<Series> series_;
    std::vector<double> theta_;  // of all points [m/N]
};

}  // namespace jvari

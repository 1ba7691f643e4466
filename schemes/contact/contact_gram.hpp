// Solves several contacts at once: the vector form of the contact equation in contact.hpp,
//
//     r + b = Theta F(r),   F_a(r_a) = -[V_a(eta_a - r_a) - V_a(eta_a)]/r_a >= 0
//
// with Theta the compliances between the contacts (a Gram matrix: symmetric, positive
// semi-definite, perhaps singular). Each F_a falls with r_a, so with r = -b + Theta f the solution
// is the only minimum of the convex merit f' Theta f/2 - sum_a int F_a dr_a. With
// Force::of_the_ends F_a is V_a'(eta_a - r_a) instead, which depends on the new depths alone: the
// force of a contact with Theta in series. Contacts that Theta does not couple fall apart into
// scalar solves (all contacts, if Theta is diagonal). Among coupled contacts, those touching at the
// beginning of the step are assumed to stay in contact and the others to stay out. If all but at
// most one satisfy this assumption, and all except this one are linear without losses, the forces
// follow from one factored matrix, which is kept. Otherwise Newton steps on the active set follow,
// each with a line search on the merit's slope. With losses F_a is the StepLoss force
// (contact.hpp), which falls with r_a too.
//
// Newton fails if a step leads through forces k Theta times larger than the solution's, because
// their difference has no digits left. For strings this begins at k Theta = 1e18. For random
// singular Theta with both signs, which strings do not have, it begins at 1e11, in a few draws out
// of a hundred.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "schemes/contact/contact.hpp"
#include "schemes/contact/scaled_system.hpp"

namespace jvari {

struct GramSolution {
    int iterations = 0;  // Newton iterations, the maximum over groups of coupled contacts
    double residual =
        // worst residual: for a lone contact the one in ContactSolution; for coupled ones the error
        // of r relative to |eta| + |b| + |Theta| f
        0;
    bool converged = true;
};

// F(r) and dF/dr <= 0 for one contact at r = eta - depth, limits at r -> 0 taken explicitly.
struct MeanForce {
    double value = 0;  // [N]
    double slope = 0;  // [N/m]
};
MeanForce mean_force(const ContactLaw&, double eta, double depth);

class ContactGram {
public:
    enum class Force { mean_of_the_step, of_the_ends };
    ContactGram() = default;
    // theta: n x n, row-major [m/N]; share: weight of the older end
    ContactGram(std::span<const ContactLaw> laws, std::span<const double> theta,
                Force = Force::mean_of_the_step, double share = 0);
    // Sets the losses from this step on, one for each contact; none: nothing is lost
    void lose(std::span<const StepLoss> loss) { loss_.assign(loss.begin(), loss.end()); }

    int count() const { return static_cast<int>(laws_.size()); }
    std::span<const double> theta() const { return theta_; }
    // size of the largest group of contacts coupled by Theta; a step costs up to its cube
    int coupled() const { return largest_; }

    // Sets other compliances with the same coupling pattern. Allocates nothing.
    void set(std::span<const double> theta) noexcept {
        std::copy(theta.begin(), theta.end(), theta_.begin());
        for (Closed& kept : closed_) kept.set = 0;
    }

    // eta [m] and b [m] in, r [m] and the mean forces [N] out; n of each. Allocates nothing.
    // elastic: without the losses.
    GramSolution solve(const double* eta, const double* b, double* r, double* force,
                       bool elastic = false) noexcept;
    // sum of kappa G r^2, or of the whole spring work for a clipped contact, in the last solve [J]
    double lost() const { return lost_; }

private:
    struct Group {  // contacts coupled to each other: order_[first ... first + count)
        int first, count;
    };
    struct Closed {             // linear contacts in full contact, F = k (eta - r/2)
        std::uint64_t set = 0;  // by position in the group
        ScaledSystem system;    // I + (k/2)^1/2 Theta (k/2)^1/2 for the set
    };
    bool solve_by_set(std::size_t group, const double* eta, const double* b, double* r,
                      double* force, GramSolution&) noexcept;
    GramSolution solve_group(const Group&, const double* eta, const double* b, double* r,
                             double* force) noexcept;
    struct Fit {
        // number of contacts that contradict the assumption; one among them, in the group
        int misfits = 0, misfit = -1;
    };
    // empty if its equations are not solved to rounding
    std::optional<Fit> fit(std::size_t group, std::uint64_t closed, int one, const double* eta,
                           const double* b, double* r, double* force, GramSolution&) noexcept;
    const Closed& closed(std::size_t group, std::uint64_t set) noexcept;
    bool newton_step(const int* set, int n) noexcept;
    ContactSolution alone(int a, double eta, double b) const noexcept;
    ContactSolution spring_alone(int a, double eta, double b, double theta) const noexcept;
    ContactSolution losing_alone(int a, double eta, double b) const noexcept;
    ContactSolution pulling_alone(int a, double eta, double b) const noexcept;
    bool loses(int a) const noexcept { return losing_ && loss_[a].kappa != 0; }
    MeanForce force_at(int a, double eta, double depth) const noexcept;
    MeanForce spring_at(int a, double eta, double depth) const noexcept;
    double lost_by(int a, double eta, double r, double force) const noexcept;

    std::vector<ContactLaw> laws_;
    std::vector<double> theta_;
    bool of_the_ends_ = false, losing_ = false;
    double share_ = 0, lost_ = 0;
    std::vector<StepLoss> loss_;
    std::vector<int> order_;
    std::vector<Group> groups_;
    // size of the largest group
    int largest_ = 0;
    std::vector<double> depth_, mean_, spring_, slope_, defect_, dr_, df_, root_;  // workspaces
    ScaledSystem system_;
    std::vector<int> active_;
    static constexpr std::size_t closed_sets = 8;  // for each group
    std::vector<Closed> closed_;
    std::vector<double> half_root_, give_;  // for each contact: (k/2)^1/2, 2/k
};

[[gnu::always_inline]] inline ContactSolution ContactGram::spring_alone(
    int a, double eta, double b, double theta) const noexcept {
    if (!of_the_ends_) return solve_contact(laws_[a], eta, b, theta);
    const double old = share_ * laws_[a].force(eta);
    const double depth = depth_in_series(laws_[a], eta + b - theta * old, (1 - share_) * theta);
    const double force = (1 - share_) * laws_[a].force(depth) + old;
    return {theta * force - b, force};
}

}  // namespace jvari

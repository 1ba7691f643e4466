// The forces of modal_spatial_newton: what barrier, thread and pluck do to the string in a step, given the levels at the reads.
//
// Step n knows level n-1, n and the force-free level n+1 of every read (contact points first, then the thread), and finds the forces of all
// ports and the true level n+1. Energies are those of these parts alone; the string's are modal.
#pragma once

#include <vector>

#include "scenes/scene.hpp"
#include "schemes/contact/obstacle_step.hpp"
#include "schemes/scheme.hpp"
#include "schemes/spatial/spatial_forms.hpp"
#include "schemes/spatial/spatial_ports.hpp"

namespace jvari {

class SpatialForces {
public:
    // missing: in series with contacts and thread, compliance=matched; these take the steps of obstacle_step.hpp then.
    SpatialForces(const String&, const std::vector<ContactPoint>&, const LinearUpdate&, double dt,
                  const std::optional<MissingMatrix>& missing = {}, bool on_body = false);

    // t = 0 at rest: `now` and the motion without force `free` are filled. From rest both neighbours of level 0 carry half of F^0 and the
    // contact force is that at level 1: the equations of a step with u- = u+ and half the compliance.
    void begin() noexcept;
    void shift() noexcept;           // level n+1 becomes n; then `free` is filled, then
    Outcome solve(long n) noexcept;  // force, coming

    // Or on a moving body, whose port is the last that is read: the pluck's part, then what was solved for outside, of points and body.
    // Then the energies of the points are not here.
    Outcome pluck(long n) noexcept;
    void put(const double* points, double body, double share) noexcept;  // share: 1/2 in the first step

    double bridge() const;  // [N]
    double thread() const;
    double stored() const;               // (V^n + V^{n+1})/2 and the thread's likewise [J]
    double dissipated() const;           // by contact loss and thread in this step [J]
    double supplied() const;             // by the pluck, on points that it moves by way of what is in series [J]
    double on_tap(std::size_t k) const;  // of what is in series, at level n
    int pluck_port() const { return plucks_.empty() ? -1 : plucks_.front().port; }
    void add_facts(std::vector<Fact>&) const;

    std::vector<double> older, now, free, coming;  // levels n-1, n, n+1 without the forces of step n, n+1; of each read [m]
    std::vector<double> force;                     // of each port [N]

private:
    struct Contact {
        ContactLaw law;
        double height;  // [m]
        double theta;   // increment of the point per force on it [m/N], the thread's yielding included
        double drag;    // contact_loss/(2 dt) [1/m]: the loss force is drag V'(eta) r
    };
    struct Coil {  // the thread: u_c+ = free + theta F_c + cross F_b
        Thread law;
        int port;
        double theta, cross;  // [m/N]; cross to the contact point, 0 without one
        double yield;         // B = k_c/2 + r_c/(2 dt) [N/m]
        double recoil;        // -dF_c/dF_b
    };
    struct Finger {  // the pluck
        Pluck law;
        int port;
        std::vector<double> reach;  // increment of each read per force [m/N]
    };
    struct Effort {
        double solves = 0, iterations = 0, most = 0, residual = 0, deepest = 0;
        ForceRange force;
    };
    std::vector<Contact> contacts_;
    std::vector<Coil> threads_;  // one or none, as plucks_
    std::vector<Finger> plucks_;
    struct Series {
        MissingMatrix missing;
        ObstacleStep step, start;
        std::vector<double> theta;              // of all reads [m/N]
        mutable std::vector<double> a, b, now;  // workspaces, one per read
    };
    void begin_in_series() noexcept;
    Outcome solve_in_series(long n) noexcept;
    void move(const std::vector<double>& theta, double share) noexcept;  // every read by the forces: `coming`
    double pluck_at(long n) const;                                       // [N]
    double pluck_on(std::size_t z, long n) const { return series_->missing.pluck.empty() ? 0 : series_->missing.pluck[z] * pluck_at(n); }
    std::optional<Series> series_;
    std::vector<double> theta_;  // on a moving body: of all reads [m/N]
    long n_ = 0;
    double dt_, own_theta_ = 0;  // own: of the contact point, without a yielding thread
    Effort effort_;
};

}  // namespace jvari

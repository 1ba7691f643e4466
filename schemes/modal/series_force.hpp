// The points' forces of an explicit scheme with a compliance in series (contact/series_points.hpp), for modal_three_point.hpp: taken at the
// instant of the step, the thread's own state moved by half a step before and half a step after.
#pragma once

#include <array>
#include <vector>

#include "schemes/contact/matching_facts.hpp"
#include "schemes/contact/series_points.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/modal/modal_string.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

struct SeriesForce {
    static constexpr bool in_series = true;
    static constexpr int dofs = 0;
    SeriesPoints points;
    MissingCompliance C;
    double limit = 0;  // [N/m]

    struct Moving {                        // what a step changes
        double Y = 0, Y_now = 0;           // the thread's state after half a step more, and at the step; less h_c [m]
        double y_b = 0, y_c = 0, F_e = 0;  // at the step, the pluck's part of C in them
        SeriesPoints::Forces force{};      // at the step
        double least_force = 0, most_force = 0;
        ImpactShare impacts;

        // Always inlined, as SeriesPoints::instant is.
        [[gnu::always_inline]] void act(const SeriesPoints& p, const MissingCompliance& missing, double b, double c, double pluck,
                                        bool at_start) {
            F_e = pluck;
            y_b = b + missing.be * pluck;
            y_c = c + missing.ce * pluck;
            const SeriesPoints::Instant i = p.instant(y_b, y_c, Y, at_start);
            Y_now = i.Y_now;
            force = i.force;
            Y = i.Y_after;
            least_force = force.b < least_force ? force.b : least_force;
            most_force = force.b > most_force ? force.b : most_force;
            impacts.take(force.b);
        }
    };
    Moving now;
    bool probed = true;               // energy is asked for
    double lost = 0, lost_after = 0;  // by the thread: up to the step, since the last row; and in the half step after it [J]

    void begin(double y_c0) {
        now.Y = points.r_c > 0 ? y_c0 - points.h_c : 0;
        probed = true;
    }
    void act(double b, double c, double pluck, bool at_start) {
        const double before = now.Y;
        now.act(points, C, b, c, pluck, at_start);
        if (!probed) return;
        lost += lost_after + points.energy(now.y_b, now.y_c, before) - energy();
        lost_after = energy() - points.energy(now.y_b, now.y_c, now.Y);
    }
    double energy() const { return points.energy(now.y_b, now.y_c, now.Y_now); }
    double on_tap(std::size_t k) const { return C.on_tap(k, now.force.b, now.force.c, now.F_e); }
    bool solved() const { return true; }
    std::vector<Fact> facts() const {
        std::vector<Fact> f = {
            {facts::smallest_contact_force, now.least_force},
            {facts::largest_contact_force, now.most_force},
            {facts::deepest_penetration, now.most_force > 0 ? std::pow(now.most_force / points.law.law.k, 1 / points.law.law.alpha) : 0},
            {facts::series_compliance, points.law.S},
            {facts::stable_stiffness_limit, limit}};
        for (const Fact& fact : matching_facts(points, now.impacts)) f.push_back(fact);
        return f;
    }
};

// The factor, less 1, by which what lasts in contact (exponent 1) and the thread could be stiffer before the highest root passes z = -1;
// NaN where there is no such contact, or no such scheme.
double series_margin(const Descriptor&, const Scene&, const Settings&, ModalArray (*gain_of)(const ModalString&));

// The explicit scheme with these gains (modal_three_point.hpp) and what is missing of its compliance in series.
std::unique_ptr<Scheme> explicit_in_series(const Descriptor&, const Scene&, ModalString, const ModalArray& gain);

}  // namespace jvari

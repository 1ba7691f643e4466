// Contacts of one string: one row from touching a barrier or a mass to letting go. A scheme reports
// them step by step and the exact reference from event to event, only if a run asks for them
// (Block::impacts).
#pragma once

#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

struct BarrierOf {  // names a barrier by its string in the scheme
    int string = 0, barrier = 0;
    // number of barriers on that string; a scheme may have one for each profile point
    int barriers = 1;
};

struct Impact {
    int barrier = 0;            // barrier on the string, or the mass, numbered behind the barriers
    double start = 0, end = 0;  // [s]
    double largest_force = 0;   // sum over all points on the barrier [N]
    double impulse = 0;         // [N s]
    // Speeds towards the barrier before the contact, and away from it after [m/s]. NaN if not seen:
    // the contact is on at t = 0 or at the end, or the string moves the other way in the adjacent
    // step.
    double speed_in = 0, speed_out = 0;
    double energy_lost = 0;  // by contact loss; energy stored in a spring is not lost [J]
};

class Impacts {
public:
    explicit Impacts(const String&);  // a string in the scene

    // Adds a part of a contact during which the barrier touched all the time.
    void add(const Impact& part);

    struct Step {  // one step of a scheme, on one contact
        // end of the step, time that the step counts for, time in which the string moved by `moved`
        // [s]
        double to, lasts, span;
        double force, moved, lost;  // [N], [m], [J]
    };
    void step(const BarrierOf& of, int a, const Step&);

    const std::vector<Impact>& all() const { return all_; }
    bool reported = false;  // true after a scheme has reported its contacts

private:
    struct Point {
        double speed = 0;  // in the last step
        bool known = false, touches = false;
    };
    struct Last {  // a barrier's last row, and the force at all its points in the step to `until`
        int row = -1;
        double force = 0, until = -1;
    };
    int barrier_of(const BarrierOf&) const;

    std::vector<char> profile_;  // for each barrier: whether it is a profile
    std::vector<Impact> all_;
    std::vector<Last> last_;  // for each barrier
    std::vector<Point> points_;
};

}  // namespace jvari

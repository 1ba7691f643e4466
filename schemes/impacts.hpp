// What the contacts of one string do: one row from touching a barrier or a mass to letting go of
// it. A scheme tells it step by step, the exact reference from event to event, and only where a run
// asks (Block::impacts).
#pragma once

#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

struct BarrierOf {  // which barrier of which string of the scheme
    int string = 0, barrier = 0;
    // barriers of that string, where a scheme may have one for each point of a profile
    int barriers = 1;
};

struct Impact {
    int barrier = 0;            // of the string, or the mass behind its barriers
    double start = 0, end = 0;  // [s]
    double largest_force = 0;   // of all points of the barrier together [N]
    double impulse = 0;         // [N s]
    double speed_in = 0;        // towards the barrier, before; NaN: it began in contact
    double speed_out = 0;       // away from it, after; NaN: not seen [m/s]
    // work of the string on the barrier, both ways, and what was stored where it began in contact;
    // NaN: not known [J]
    double energy_lost = 0;
};

class Impacts {
public:
    explicit Impacts(const String&);  // of the scene

    // a part of a contact in which the barrier touched all the time
    void add(const Impact& part);

    // A step of a scheme, which ends at `to` and stands for `lasts` [s]: the force on contact a,
    // the way that it moved in `span` [s], and of the first step what it had stored before [J].
    void step(const BarrierOf& of, int a, double to, double lasts, double span, double force,
              double moved, double stored);

    const std::vector<Impact>& all() const { return all_; }
    bool told = false;  // by a scheme that tells of its contacts

private:
    struct Point {
        double speed = 0, force = 0;  // in the last step
        bool known = false;
    };
    struct Last {  // of a barrier: its row, and the force of all points in the step to `until`
        int row = -1;
        double force = 0, until = -1;
    };
    int barrier_of(const BarrierOf&) const;

    std::vector<char> profile_;  // of each barrier: whether it is one
    std::vector<Impact> all_;
    std::vector<Last> last_;  // of each barrier
    std::vector<Point> points_;
};

}  // namespace jvari

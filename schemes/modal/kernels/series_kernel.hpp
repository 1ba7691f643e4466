// The rows of an explicit scheme with a compliance in series (modal_three_point.hpp, series_force.hpp) while nobody asks for its energy:
// taps, steps and forces of a whole block in one function, compiled once per instruction set. The same sums in the same order as one step
// at a time, so the same bits.
#pragma once

#include "schemes/modal/series_force.hpp"

namespace jvari {

struct SeriesRows {
    struct Compliances {  // between bridge, thread and plucking finger, times dt^2: what a newton moves in a step [m/N]
        double bb = 0, bc = 0, cc = 0, be = 0, ce = 0;
    };
    struct State {
        long step = 0;
        double y_b = 0, y_c = 0;              // at the step [m]
        double F_b = 0, F_c = 0, F_e = 0;     // of the step [N]
        double impulse_b = 0, impulse_c = 0;  // sums of F over the interval of a row [N]
    };

    const ModalString* string = nullptr;
    const double* q = nullptr;  // of the modes at the step
    SeriesForce* contact = nullptr;
    ModalPass* pass = nullptr;
    const Compliances* theta = nullptr;
    State* state = nullptr;
};
using SeriesAdvance = Status (*)(SeriesRows&, const Block&);
SeriesAdvance series_advance(bool barrier, bool thread);

}  // namespace jvari

// What can be left out of a scene, or made plainer, part by part: one list for everybody who asks which parts matter.
//
// The filters of a body are no part: they shape what is heard, and nothing that a scheme computes depends on them. Its modes are left as
// they are.
//
// Keys are those of scene files, so that a reduction can be told to a reader. The list is ordered so that any of its reductions can be
// applied in turn: first what changes a value, then what empties a part, then what shortens an array, its last entry first. So each key
// means what it means in the scene that the list was made of.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

enum class Part {
    contact_stiffness,  // a tenth, a hundredth
    exponent,           // of a contact: 1
    contact_loss,
    footprint,     // of a barrier or a thread: a point
    damping_term,  // one of several terms of a law
    damping,
    bending_stiffness,
    thread,
    initial_shape,  // where there is a pluck
    pluck,          // where there is an initial shape
    polarisation,
    tap,  // where there is another
    barrier,
    string  // where there is another; with its taps
};

struct Reduction {
    Part part;
    std::string key;      // "string.0.damping.sigma3"
    std::string becomes;  // "0"; "" where it goes
    std::function<void(Scene&)> apply;
    std::string said() const { return becomes.empty() ? key + " left out" : key + " = " + becomes; }
};

// Of what is there: none leaves the scene as it is. A contact of exponent 1 in place of another has the same force at `penetration` [m].
std::vector<Reduction> reductions_of(const Scene&, double penetration = 1);

// Taps of forces that nothing makes any more, but for the one named `kept`.
void remove_idle_taps(Scene&, const std::string& kept = "");

}  // namespace jvari

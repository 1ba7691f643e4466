// Lists the parts of a scene that can be left out or simplified.
//
// The body is kept: its filters change only the sound at the taps, and its modes stay unchanged.
//
// Keys are the keys in scene files. Any subset of the reductions can be applied in list order:
// first changed values, then removed parts, then entries removed from arrays, last entry first. So
// each key keeps its meaning.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace jvari {

enum class Part {
    contact_stiffness,  // becomes a tenth or a hundredth
    exponent,           // sets a contact's exponent to 1
    contact_loss,
    footprint,     // shrinks a footprint under a barrier or a thread to a point
    damping_term,  // one among several terms in a law
    damping,
    bending_stiffness,
    thread,
    initial_shape,  // if there is a pluck too
    pluck,          // if there is an initial shape too
    polarisation,
    tap,  // if there is another
    barrier,
    mass,   // with its taps
    string  // with its taps, if there is another string
};

struct Reduction {
    Part part;
    std::string key;      // "string.0.damping.sigma3"
    std::string becomes;  // "0"; "" if the part is left out
    std::function<void(Scene&)> apply;
    std::string description() const {
        return becomes.empty() ? key + " left out" : key + " = " + becomes;
    }
};

// Returns all reductions that apply to this scene. If a contact's exponent becomes 1, its force is
// kept at the penetration `penetration` [m].
std::vector<Reduction> reductions_of(const Scene&, double penetration = 1);

// Removes force taps for contacts that no longer exist, except the tap `kept`.
void remove_idle_taps(Scene&, const std::string& kept = "");

}  // namespace jvari

// Places the obstacles on the string in modal_spatial_newton.
#pragma once

#include <vector>

#include "schemes/modal/three_point_modes.hpp"

namespace jvari {

// N - 1 from the settings, or by default the modes below min(20 kHz, rate/2). The default is raised
// until a point barrier lies on a node (to 4 times this number at most; beyond, the barrier acts
// through its modal weights) and a profile barrier has 8 nodes.
int intervals_for(const String&, const Settings&);

// Adds the contacts on p.string() by points and ports. Nodes are not coupled to each other, since
// their weights are orthogonal; all other ports are. Throws Refusal for two contacts on one node.
void place_contacts(ThreePointProblem& p);

std::vector<double> node_weights(int intervals, int node);  // sin(j pi node/N), j = 1 .. N-1

// The string in modal_spatial_newton.
ThreePointProblem spatial_problem(const Descriptor&, const Scene&, const Settings&);

}  // namespace jvari

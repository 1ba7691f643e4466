// Where obstacles meet the string in modal_spatial_newton.
#pragma once

#include <string>
#include <vector>

#include "scenes/modes.hpp"
#include "schemes/contact/contact.hpp"
#include "schemes/modal/three_point_modes.hpp"
#include "schemes/scheme.hpp"

namespace jvari {

struct ContactPoint {
    ContactLaw law;           // [N/m^alpha]; a stiffness density K on a node is K dx
    double height = 0;        // [m]
    double contact_loss = 0;  // Hunt-Crossley beta [s/m]
    double position = 0;      // [m]
};

struct SpatialPorts {
    std::vector<ContactPoint> points;
    std::vector<Port> ports;  // of each
};

// N - 1 of the settings, or by default the modes below min(20 kHz, rate/2), raised until a point barrier lies on a node (to 4 times as
// many at most: beyond, it acts through its modal weights) and a profile barrier has 8 nodes.
int intervals_for(const String&, const Settings&);

// Throws Refusal where contact points are coupled and may not be: nodes are not (their weights are orthogonal), all else is.
SpatialPorts spatial_ports(const String&, const Modes&, int intervals, const std::string& scene, bool coupled_may_be);

std::vector<double> node_weights(int intervals, int node);  // sin(j pi node/N), j = 1 .. N-1

// The string of modal_spatial_newton.
ThreePointProblem spatial_problem(const Descriptor&, const Scene&, const Settings&);

}  // namespace jvari

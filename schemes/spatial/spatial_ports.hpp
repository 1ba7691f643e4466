// Where forces meet the string in modal_spatial_newton: the contact points of the barriers, the thread, the pluck.
#pragma once

#include <string>
#include <vector>

#include "scenes/modes.hpp"
#include "schemes/contact/contact.hpp"
#include "schemes/scheme.hpp"
#include "schemes/spatial/spatial_forms.hpp"

namespace jvari {

struct ContactPoint {
    ContactLaw law;           // [N/m^alpha]; a stiffness density K on a node is K dx
    double height = 0;        // [m]
    double contact_loss = 0;  // Hunt-Crossley beta [s/m]
    double position = 0;      // [m]
};

// Ports in order: one per contact point, the thread's, that of a moving body where there is one, the pluck's.
struct SpatialPorts {
    std::vector<ContactPoint> points;
    std::vector<Port> ports;
};

// N - 1 of the settings, or by default the modes below min(20 kHz, rate/2), raised until a point barrier lies on a node (to 4 times as
// many at most: beyond, it acts through its modal weights) and a profile barrier has 8 nodes.
int intervals_for(const String&, const Settings&);

// Throws Refusal where contact points are coupled and may not be: nodes are not (their weights are orthogonal), all else is.
SpatialPorts spatial_ports(const String&, const Modes&, int intervals, const std::string& scene, bool coupled_may_be, bool on_body = false);

}  // namespace jvari

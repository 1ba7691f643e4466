#include "schemes/modal/series_force.hpp"

#include "schemes/modal/modal_three_point.hpp"

namespace jvari {

std::unique_ptr<Scheme> explicit_in_series(const Descriptor& descriptor, const Scene& scene, ModalString string, const ModalArray& gain) {
    const String& s = scene.strings.front();
    std::vector<double> own;
    double yielding = 0;
    for (int i = 0; i < string.count; ++i) {
        own.push_back(gain[i] / string.num[i]);  // q under a steady force on the mode: d = 0
        if (!string.g_b.empty()) yielding += string.g_b[i] * string.g_b[i] * gain[i] / string.den[i];
    }
    SeriesForce force;
    force.C = modal_compliance(descriptor, scene, ModeBasis(s, string.count, 0), own);
    force.points = SeriesPoints(s.barriers.empty() ? nullptr : &string.barrier, string.h_b, string.k_c, string.r_c, string.h_c, force.C);
    force.points.set_time(0.5 * string.dt);
    force.limit = yielding > 0 ? 1 / yielding : 0;  // a root at z = -1: lasting contact, without the thread
    const ModalArray inertia(string.count, string.mass);
    return std::make_unique<ModalThreePoint<SeriesForce>>(std::move(string), gain, inertia, force);
}

}  // namespace jvari

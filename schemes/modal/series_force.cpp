#include "schemes/modal/series_force.hpp"

#include <cmath>
#include <limits>

#include "schemes/modal/modal_three_point.hpp"

namespace jvari {

namespace {
SeriesForce series_force(const Descriptor& descriptor, const Scene& scene, const ModalString& string, const ModalArray& gain) {
    const String& s = scene.strings.front();
    std::vector<double> own;
    double yielding = 0;
    for (int i = 0; i < string.count; ++i) {
        own.push_back(gain[i] / string.num[i]);  // q under a steady force on the mode: d = 0
        if (!string.g_b.empty()) yielding += string.g_b[i] * string.g_b[i] * gain[i] / string.den[i];
    }
    SeriesForce force;
    force.C = modal_compliance(descriptor, scene, modes_of(s, string.count), own);
    force.points = SeriesPoints(s.barriers.empty() ? nullptr : &string.barrier, string.h_b, string.k_c, string.r_c, string.h_c, force.C);
    force.points.set_time(0.5 * string.dt);
    force.now.impacts = ImpactShare(string.dt);
    force.limit = yielding > 0 ? 1 / yielding : 0;  // a root at z = -1: lasting contact, without the thread
    return force;
}
}  // namespace

double series_margin(const Descriptor& descriptor, const Scene& scene, const Settings& settings,
                     ModalArray (*gain_of)(const ModalString&)) try {
    const ModalString string = modal_string(descriptor, scene, settings);
    const ModalArray gain = gain_of(string);
    const SeriesPoints p = series_force(descriptor, scene, string, gain).points;
    if (!p.barrier || p.law.law.alpha != 1) return std::numeric_limits<double>::quiet_NaN();
    double bb = 0, bc = 0, cc = 0;  // compliances at z = -1 [m/N]
    for (int i = 0; i < string.count; ++i) {
        const double b = string.g_b[i], c = p.thread ? string.g_c[i] : 0, yielding = gain[i] / string.den[i];
        bb += b * b * yielding;
        bc += b * c * yielding;
        cc += c * c * yielding;
    }
    // The thread's state, which two half steps draw after a string that alternates: Y = on_b y_b + on_c y_c.
    const double k = p.law.both, stiff = p.e * p.e * k + p.stiff_cc, kappa = stiff + p.k_c;
    const double kept = p.r_c > 0 ? std::exp(-0.5 * kappa * string.dt / p.r_c) : 1, drawn = (1 - kept) * (1 - kept) / (1 + kept * kept);
    const double on_b = p.r_c > 0 ? -drawn * p.e * k / kappa : 0, on_c = p.r_c > 0 ? drawn * stiff / kappa : 0;
    // F_b = -(K_bb y_b + K_bc y_c), F_c likewise; the highest root passes -1 where an eigenvalue of the compliances times K passes 1.
    const double K_bb = k * (1 + p.e * on_b), K_bc = k * p.e * (on_c - 1);
    const double K_cb = -stiff * on_b - p.e * k, K_cc = stiff * (1 - on_c);
    const double trace = bb * K_bb + bc * (K_bc + K_cb) + cc * K_cc;
    const double det = (bb * cc - bc * bc) * (K_bb * K_cc - K_bc * K_cb);
    return 2 / (trace + std::sqrt(trace * trace - 4 * det)) - 1;
} catch (const Refusal&) {
    return std::numeric_limits<double>::quiet_NaN();
}

std::unique_ptr<Scheme> explicit_in_series(const Descriptor& descriptor, const Scene& scene, ModalString string, const ModalArray& gain) {
    const SeriesForce force = series_force(descriptor, scene, string, gain);
    const ModalArray inertia(string.count, string.mass);
    return std::make_unique<ModalThreePoint<SeriesForce>>(std::move(string), gain, inertia, force);
}

}  // namespace jvari

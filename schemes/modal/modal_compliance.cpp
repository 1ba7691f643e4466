// Source: docs/compliance-matching.md; C_scheme is a sum over modes, since each scheme here steps them one by one.
#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

MissingCompliance modal_compliance(const Descriptor& descriptor, const Scene& scene, const ModeBasis& modes, std::span<const double> own) {
    const String& s = scene.strings.front();
    const Sites sites = sites_of(scene);
    std::vector<std::vector<double>> g, w;
    for (const Footprint& f : sites.forces) g.push_back(modes.footprint(f.position, f.width));
    for (const Reading& r : sites.readings) w.push_back(r.nut_force ? modes.nut_force(s) : modes.footprint(r.at.position, r.at.width));
    return missing_compliance(descriptor.name, s, sites, scene.taps.size(), [&](int r, int f) {
        double sum = 0;
        for (int i = 0; i < modes.count(); ++i) sum += w[r][i] * g[f][i] * own[i];
        return sum;
    });
}

}  // namespace jvari

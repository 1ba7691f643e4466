// Source: docs/compliance-matching.md; C_scheme is a sum over modes, since each scheme here steps
// modes separately.
#include "schemes/modal/modal_compliance.hpp"

#include "schemes/modal/modal_string.hpp"

namespace jvari {

MissingMatrix modal_missing_matrix(const Descriptor& descriptor, const Scene& scene,
                                   const Modes& modes, std::optional<double> step,
                                   std::span<const double> own) {
    const String& s = scene.strings.front();
    const Sites sites = sites_of(scene);
    std::vector<std::vector<double>> g, w;
    for (const Footprint& f : sites.forces) g.push_back(footprint_weights(modes, f));
    for (const Reading& r : sites.readings) w.push_back(reading_weights(r, modes, s));
    return missing_matrix(descriptor.name, s, sites, scene.taps.size(), modes.count(), step,
                          [&](int r, int f) {
                              double sum = 0;
                              for (int i = 0; i < modes.count(); ++i)
                                  sum += w[r][i] * g[f][i] * own[i];
                              return sum;
                          });
}

double relative_compliance(const Modes& modes, const String& s, std::span<const double> own) {
    const Footprint b = footprints_of(s).front();
    const auto g = footprint_weights(modes, b.position, b.width);
    double sum = 0;
    for (int i = 0; i < modes.count(); ++i) sum += g[i] * g[i] * own[i];
    return sum / static_compliance(modes, g);
}

Yield yield_of(std::span<const double> own, const std::optional<MissingMatrix>& series) {
    return series ? Yield{own, series->C, series->pluck} : Yield{own, {}, {}};
}

void put_start(StringPoints& p, const String& s, const Modes& modes, const ModalStart& start) {
    p.start_force = start.force;
    std::vector<Footprint> points = footprints_of(s);
    if (s.thread) points.push_back({s.thread->position, s.thread->width});
    for (const Footprint& f : points) {
        const auto g = footprint_weights(modes, f);
        p.start_velocity.push_back(modal_dot(g, start.velocity));
    }
}

}  // namespace jvari

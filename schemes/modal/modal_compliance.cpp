// Source: docs/compliance-matching.md; C_scheme is a sum over modes, since each scheme here steps them one by one.
#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

ModalCompliance modal_compliance(const Descriptor& descriptor, const Scene& scene, const Modes& modes, std::span<const double> own) {
    const String& s = scene.strings.front();
    std::vector<Footprint> forces;
    std::vector<int> part;  // 0 barrier, 1 thread, 2 pluck
    if (!s.barriers.empty()) {
        const auto& b = std::get<LumpedBarrier>(s.barriers.front());
        forces.push_back({b.position, b.width});
        part.push_back(0);
    }
    if (s.thread) {
        forces.push_back({s.thread->position, s.thread->width});
        part.push_back(1);
    }
    const int points = static_cast<int>(forces.size());
    if (s.pluck) {
        forces.push_back({s.pluck->position, s.pluck->width});
        part.push_back(2);
    }
    std::vector<Reading> readings;
    std::vector<std::vector<double>> g, w;
    for (const Footprint& f : forces) g.push_back(footprint_weights(modes, f.position, f.width));
    for (int p = 0; p < points; ++p) {
        readings.push_back({forces[p]});
        w.push_back(g[p]);
    }
    std::vector<std::size_t> tap_of;
    for (std::size_t k = 0; k < scene.taps.size(); ++k) {
        const Tap& tap = scene.taps[k];
        const bool nut = tap.quantity == Quantity::nut_force;
        if (!nut && tap.quantity != Quantity::displacement) continue;
        readings.push_back({{tap.position, 0}, nut});
        w.push_back(nut ? nut_force_weights(modes, s) : displacement_weights(modes, tap.position));
        tap_of.push_back(k);
    }
    const auto C = missing_compliance(s, readings, forces, [&](int r, int f) {
        double sum = 0;
        for (int i = 0; i < modes.count(); ++i) sum += w[r][i] * g[f][i] * own[i];
        return sum;
    });
    const int columns = static_cast<int>(forces.size());
    refuse_soft(descriptor.name, C, points, columns);

    ModalCompliance m;
    m.taps.resize(scene.taps.size());
    double* const cell[3][3] = {{&m.points.bb, &m.points.bc, &m.points.be}, {nullptr, &m.points.cc, &m.points.ce}, {}};
    for (int f = 0; f < columns; ++f) {
        for (int p = 0; p < points; ++p)
            if (double* to = cell[part[p]][part[f]]) *to = C[p * columns + f];
        for (std::size_t k = 0; k < tap_of.size(); ++k) m.taps[tap_of[k]][part[f]] = C[(points + k) * columns + f];
    }
    return m;
}

}  // namespace jvari

#include "reference/in_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "schemes/decompositions.hpp"
#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

namespace {
constexpr int most_contacts = 8;  // lumped contacts and a thread

// M = C^-1 E C^-1 follows from the cut modes' admittance C - s^2 E + ... The damper R is the wave
// resistance if the string is ideal and the point far from its ends. At a contact R is eight times
// larger, which hardly matters for the motion. The larger R is, the faster is the motion that a
// closed contact leaves, R (M^-1 + G) with G = sum of g^2/m over the kept modes, and
// touching_set.hpp splits that motion off. At least sqrt(M/C) keeps spring and mass from creeping.
void put_ladder(InSeries& series, const std::vector<double>& E, std::span<const Footprint> points,
                const Modes& kept) {
    constexpr double wave = 8 / std::numbers::pi, apart = 8 * wave;  // x omega_M
    const int n = series.points, all = series.states = 2 * n;
    const auto& stiff = series.stiff = inverse_of(series.C.C, n);
    const auto mass = product_of(product_of(stiff, E, n), stiff, n), lighter = inverse_of(mass, n);
    std::vector<double> yields(mass.size());  // R^-1
    for (int a = 0; a < n; ++a) {
        const auto g = footprint_weights(kept, points[a]);
        const double G = std::inner_product(g.begin(), g.end(), g.begin(), 0.0) / kept.mass,
                     light = lighter[a * n + a];
        const double rate = (a < series.C.contacts ? apart : wave) * kept.omega0.back();
        yields[a * n + a] = std::min((light + G) / rate, std::sqrt(light * series.C.C[a * n + a]));
    }
    const auto creep = product_of(yields, stiff, n), swing = product_of(lighter, stiff, n),
               loss = product_of(product_of(mass, yields, n), mass, n);
    for (auto* m : {&series.A, &series.energy, &series.loss})
        m->assign(static_cast<std::size_t>(all) * all, 0.0);
    series.B = yields;  // and lighter below it
    series.B.insert(series.B.end(), lighter.begin(), lighter.end());
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            const int at = a * n + b, first = a * all + b, second = (n + a) * all + n + b;
            series.A[first] = -creep[at];
            series.A[first + n] = a == b;
            series.A[second - n] = -swing[at];
            series.energy[first] = stiff[at];
            series.energy[second] = mass[at];
            series.loss[second] = loss[at];
        }
}
}  // namespace

std::optional<InSeries> in_series(const Descriptor& descriptor, const Scene& scene,
                                  const Modes& modes, const Settings& settings) {
    if (choice_option(settings, compliance_option) != "matched") return {};
    const String& s = scene.strings.front();
    const auto refuse = [&](const char* what) {
        throw Refusal(std::string(descriptor.name) + ": compliance=matched " + what);
    };
    for (const Barrier& barrier : s.barriers)
        if (!std::holds_alternative<LumpedBarrier>(barrier))
            refuse("takes lumped barriers and a thread; points of a profile are not solved for");
    std::vector<double> own;
    for (double omega : modes.omega0) own.push_back(1 / (modes.mass * omega * omega));
    InSeries series;
    const Modes kept = modes_of(s, modes.count());
    series.C = modal_missing_matrix(descriptor, scene, kept, std::nullopt, own);
    series.points = series.C.contacts + (series.C.thread ? 1 : 0);
    if (series.points > most_contacts) refuse("takes few contacts");
    if (series.points == 0) return series;
    const Sites sites = sites_of(scene);
    const CutModes cut =
        cut_modes(s, std::span(sites.forces).first(series.points), kept.count(), HUGE_VAL);
    const auto positive = [&](const std::vector<double>& m) {
        return symmetric_parts(m, series.points).value.front() > 0;
    };
    const auto nothing = [&] {
        refuse("needs modes that are left out: nothing is missing at a contact or at the thread");
    };
    if (cut.E.empty() || !positive(series.C.C) || !positive(cut.E)) nothing();
    put_ladder(series, cut.E, std::span(sites.forces).first(series.points), kept);
    return series;
}

double series_rate(const InSeries& s) {
    if (s.states == 0) return 0;
    std::vector<long double> A;  // by columns; rates from the transposed matrix round differently
    for (int column = 0; column < s.states; ++column)
        for (int row = 0; row < s.states; ++row) A.push_back(s.A[row * s.states + column]);
    long double fastest = 0;
    for (const auto& rate : eigenpairs_of(A, s.states).value)
        fastest = std::max(fastest, std::abs(rate));
    return static_cast<double>(fastest);
}

void add_series(const Block& out, int row, const InSeries& series, const double* z,
                double F_e) noexcept {
    double P[most_contacts] = {};
    for (int a = 0; a < series.points; ++a)
        for (int b = 0; b < series.points; ++b) P[a] += series.stiff[a * series.points + b] * z[b];
    for (int k = 0; k < out.taps; ++k)
        out.tap[k * out.stride + row] += series.C.on_tap(static_cast<std::size_t>(k), P, F_e);
}

}  // namespace jvari

#include "reference/in_series.hpp"

#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"
#include "schemes/symmetric.hpp"

namespace jvari {

namespace {
constexpr int most_points = 8;  // lumped contacts and a thread

void put_spring_and_damper(InSeries& series, const SymmetricParts& C) {
    const int n = series.states = series.points;
    for (auto* m : {&series.A, &series.B, &series.stiff, &series.loss}) m->assign(n * n, 0.0);
    for (int a = 0; a < n; ++a) {
        const double R = series.C.radiation[a];
        series.B[a * n + a] = 1 / R;
        series.loss[a * n + a] = R;
        for (int b = 0; b < n; ++b) {
            for (int k = 0; k < n; ++k) series.stiff[a * n + b] += C.vector[k * n + a] * C.vector[k * n + b] / C.value[k];
            series.A[a * n + b] = -series.stiff[a * n + b] / R;
        }
    }
    series.energy = series.stiff;
}
}  // namespace

std::optional<InSeries> in_series(const Descriptor& descriptor, const Scene& scene, const Modes& modes, const Settings& settings) {
    if (choice_option(settings, compliance_option) != "matched") return {};
    const String& s = scene.strings.front();
    const auto refuse = [&](const char* what) { throw Refusal(std::string(descriptor.name) + ": compliance=matched " + what); };
    for (const Barrier& barrier : s.barriers) {
        const auto* lumped = std::get_if<LumpedBarrier>(&barrier);
        if (!lumped) refuse("takes lumped barriers and a thread; points of a profile are not solved for");
        if (lumped->contact_loss != 0) refuse("leaves contact loss out");
    }
    std::vector<double> own;
    for (double omega : modes.omega0) own.push_back(1 / (modes.mass * omega * omega));
    InSeries series;
    series.C = modal_missing_matrix(descriptor, scene, modes_of(s, modes.count()), own);
    series.points = series.C.contacts + (series.C.thread ? 1 : 0);
    if (series.points > most_points) refuse("takes few contacts");
    if (series.points == 0) return series;
    const SymmetricParts parts = symmetric_parts(series.C.C, series.points);
    if (!(parts.value.front() > 0)) refuse("needs modes that are left out: nothing is missing at a contact or at the thread");
    put_spring_and_damper(series, parts);
    return series;
}

void add_series(const Block& out, int row, const InSeries& series, const double* z, double F_e) noexcept {
    double P[most_points] = {};
    for (int a = 0; a < series.points; ++a)
        for (int b = 0; b < series.points; ++b) P[a] += series.stiff[a * series.points + b] * z[b];
    for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] += series.C.on_tap(static_cast<std::size_t>(k), P, F_e);
}

}  // namespace jvari

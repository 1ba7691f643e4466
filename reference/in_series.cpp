#include "reference/in_series.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

namespace {
constexpr int most_contacts = 8;  // lumped contacts and a thread

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// M = C^-1 E C^-1 is what the cut modes' admittance C - s^2 E + ... asks for. The damper R is the
// wave resistance where the string is ideal and far from its ends. At a contact it is eight times
// as large, which hardly matters for the motion: the larger it is, the faster is what a closed
// contact leaves of it, R (M^-1 + G) with G = sum of g^2/m over the modes kept, and
// touching_set.hpp splits that off. sqrt(M/C) at least keeps spring and mass from creeping.
void put_ladder(InSeries& series, const Matrix& stiff, const Matrix& E,
                std::span<const Footprint> points, const Modes& kept) {
    constexpr double wave = 8 / std::numbers::pi, apart = 8 * wave;  // x omega_M
    const Eigen::Index n = series.points;
    series.states = 2 * series.points;
    const Matrix mass = stiff * E * stiff, lighter = mass.inverse();
    Matrix yields = Matrix::Zero(n, n);  // R^-1
    for (Eigen::Index a = 0; a < n; ++a) {
        const auto g = footprint_weights(kept, points[a].position, points[a].width);
        const double G = std::inner_product(g.begin(), g.end(), g.begin(), 0.0) / kept.mass;
        const double rate = (a < series.C.contacts ? apart : wave) * kept.omega0.back();
        yields(a, a) =
            std::min((lighter(a, a) + G) / rate, std::sqrt(lighter(a, a) * series.C.C[a * n + a]));
    }
    Matrix A(2 * n, 2 * n), B(2 * n, n), S = Matrix::Zero(2 * n, 2 * n), Q = S;
    A << -yields * stiff, Matrix::Identity(n, n), -lighter * stiff, Matrix::Zero(n, n);
    B << yields, lighter;
    S.topLeftCorner(n, n) = stiff;
    S.bottomRightCorner(n, n) = mass;
    Q.bottomRightCorner(n, n) = mass * yields * mass;
    const auto put = [](const Matrix& m, std::vector<double>& out) {
        out.assign(m.data(), m.data() + m.size());
    };
    put(A, series.A), put(B, series.B), put(stiff, series.stiff), put(S, series.energy),
        put(Q, series.loss);
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
    if (needed_by(scene).has(Feature::contact_loss)) refuse("leaves contact loss out");
    std::vector<double> own;
    for (double omega : modes.omega0) own.push_back(1 / (modes.mass * omega * omega));
    InSeries series;
    const Modes kept = modes_of(s, modes.count());
    series.C = modal_missing_matrix(descriptor, scene, kept, 0, own);
    series.points = series.C.contacts + (series.C.thread ? 1 : 0);
    if (series.points > most_contacts) refuse("takes few contacts");
    if (series.points == 0) return series;
    const Matrix C = Eigen::Map<const Matrix>(series.C.C.data(), series.points, series.points);
    const Sites sites = sites_of(scene);
    const CutModes cut =
        cut_modes(s, std::span(sites.forces).first(series.points), kept.count(), HUGE_VAL);
    const auto positive = [](const Matrix& m) {
        return Eigen::LLT<Matrix>(m).info() == Eigen::Success;
    };
    const auto nothing = [&] {
        refuse("needs modes that are left out: nothing is missing at a contact or at the thread");
    };
    if (cut.E.empty()) nothing();
    const Matrix E = Eigen::Map<const Matrix>(cut.E.data(), series.points, series.points);
    if (!positive(C) || !positive(E)) nothing();
    put_ladder(series, C.inverse(), E, std::span(sites.forces).first(series.points), kept);
    return series;
}

double series_rate(const InSeries& s) {
    if (s.states == 0) return 0;
    using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    const Long A = Eigen::Map<const Matrix>(s.A.data(), s.states, s.states).cast<long double>();
    return static_cast<double>(
        Eigen::EigenSolver<Long>(A, false).eigenvalues().cwiseAbs().maxCoeff());
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

#include "reference/in_series.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "schemes/making.hpp"
#include "schemes/modal/modal_compliance.hpp"

namespace jvari {

namespace {
constexpr int most_points = 8;  // lumped contacts and a thread

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What the points see of the modes: E = sum of g g'/(m omega^4) over those that are cut off, G = sum of g_a^2/m over those kept.
struct CutModes {
    Matrix E;
    Eigen::VectorXd G;
    double last = 0;  // kept [rad/s]
};

CutModes cut_modes(const String& s, std::span<const Footprint> points, int kept) {
    constexpr int further = 8;  // times as many modes: what is beyond adds 1/500 of E
    const auto* table = std::get_if<TableDamping>(&s.damping);
    const Modes modes = modes_of(s, table ? static_cast<int>(table->frequency_hz.size()) : further * kept);
    const auto n = static_cast<Eigen::Index>(points.size());
    CutModes cut{Matrix::Zero(n, n), Eigen::VectorXd::Zero(n), modes.omega0[kept - 1]};
    Matrix g(n, modes.count());
    for (Eigen::Index a = 0; a < n; ++a) {
        const auto weights = footprint_weights(modes, points[a].position, points[a].width);
        g.row(a) = Eigen::Map<const Eigen::RowVectorXd>(weights.data(), modes.count());
    }
    for (int i = modes.count() - 1; i >= 0; --i) {
        const double square = modes.omega0[i] * modes.omega0[i];
        if (i < kept) cut.G += g.col(i).cwiseAbs2() / modes.mass;
        else cut.E += g.col(i) * g.col(i).transpose() / (modes.mass * square * square);
    }
    return cut;
}

// M = C^-1 E C^-1 is what the cut modes' admittance C - s^2 E + ... asks for. The damper R is the wave resistance where the string is ideal
// and far from its ends. At a contact it is eight times as large, which hardly matters for the motion: the larger it is, the faster is what
// a closed contact leaves of it, R (M^-1 + G), beside the modes, and touching_set.hpp splits it off. sqrt(M/C) at least keeps spring and
// mass from creeping.
void put_ladder(InSeries& series, const Matrix& stiff, const CutModes& cut) {
    constexpr double wave = 8 / std::numbers::pi, apart = 8 * wave;  // x omega_M
    const Eigen::Index n = series.points;
    series.states = 2 * series.points;
    const Matrix mass = stiff * cut.E * stiff, lighter = mass.inverse();
    Matrix yields = Matrix::Zero(n, n);  // R^-1
    for (Eigen::Index a = 0; a < n; ++a) {
        const double rate = (a < series.C.contacts ? apart : wave) * cut.last;
        yields(a, a) = std::min((lighter(a, a) + cut.G(a)) / rate, std::sqrt(lighter(a, a) * series.C.C[a * n + a]));
    }
    Matrix A(2 * n, 2 * n), B(2 * n, n), S = Matrix::Zero(2 * n, 2 * n), Q = S;
    A << -yields * stiff, Matrix::Identity(n, n), -lighter * stiff, Matrix::Zero(n, n);
    B << yields, lighter;
    S.topLeftCorner(n, n) = stiff;
    S.bottomRightCorner(n, n) = mass;
    Q.bottomRightCorner(n, n) = mass * yields * mass;
    const auto put = [](const Matrix& m, std::vector<double>& out) { out.assign(m.data(), m.data() + m.size()); };
    put(A, series.A), put(B, series.B), put(stiff, series.stiff), put(S, series.energy), put(Q, series.loss);
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
    const Matrix C = Eigen::Map<const Matrix>(series.C.C.data(), series.points, series.points);
    const Sites sites = sites_of(scene);
    const CutModes cut = cut_modes(s, std::span(sites.forces).first(series.points), modes.count());
    const auto positive = [](const Matrix& m) { return Eigen::LLT<Matrix>(m).info() == Eigen::Success; };
    if (!positive(C) || !positive(cut.E)) refuse("needs modes that are left out: nothing is missing at a contact or at the thread");
    put_ladder(series, C.inverse(), cut);
    return series;
}

void add_series(const Block& out, int row, const InSeries& series, const double* z, double F_e) noexcept {
    double P[most_points] = {};
    for (int a = 0; a < series.points; ++a)
        for (int b = 0; b < series.points; ++b) P[a] += series.stiff[a * series.points + b] * z[b];
    for (int k = 0; k < out.taps; ++k) out.tap[k * out.stride + row] += series.C.on_tap(static_cast<std::size_t>(k), P, F_e);
}

}  // namespace jvari

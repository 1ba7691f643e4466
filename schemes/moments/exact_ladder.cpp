// Exponentials by scaling and squaring (Moler & Van Loan 2003); the loss by the same doubling.
#include "schemes/moments/exact_ladder.hpp"

#include <cmath>

namespace jvari {

namespace {
using Real = long double;
constexpr int states = 6;
using Square = std::array<std::array<Real, states>, states>;

Square times(const Square& a, const Square& b) {
    Square c{};
    for (int i = 0; i < states; ++i)
        for (int k = 0; k < states; ++k)
            for (int j = 0; j < states; ++j) c[i][j] += a[i][k] * b[k][j];
    return c;
}

struct Doubled {
    Square step;  // exp(A H)
    Square loss;  // int over the step of y q q' y, as a form of y at its beginning
};
// Taylor's series of a short step, then steps of twice the length.
Doubled exponential(const Square& A, const std::array<Real, states>& q, Real H) {
    Real norm = 0;
    for (const auto& row : A)
        for (const Real x : row) norm = std::max(norm, std::fabs(x) * H);
    int doublings = 4;
    for (; norm > 1; norm /= 2) ++doublings;
    const Real h = std::ldexp(H, -doublings);
    // y(t) = sum of (A t)^n y/n!, so the loss is the sum over m and n of h/(m+n+1) times
    // ((A h)'^m q/m!) (q' (A h)^n/n!)
    Doubled all{};
    Square term{};
    for (int i = 0; i < states; ++i) term[i][i] = all.step[i][i] = 1;
    constexpr int terms = 16;
    std::array<std::array<Real, states>, terms> rows{};  // q' (A h)^n/n!
    for (int n = 0; n < terms; ++n) {
        for (int j = 0; j < states; ++j)
            for (int i = 0; i < states; ++i) rows[n][j] += q[i] * term[i][j];
        term = times(term, A);
        for (auto& row : term)
            for (Real& x : row) x *= h / static_cast<Real>(n + 1);
        for (int i = 0; i < states; ++i)
            for (int j = 0; j < states; ++j) all.step[i][j] += term[i][j];
    }
    for (int m = 0; m < terms; ++m)
        for (int n = 0; n < terms; ++n)
            for (int i = 0; i < states; ++i)
                for (int j = 0; j < states; ++j)
                    all.loss[i][j] += rows[m][i] * rows[n][j] * h / static_cast<Real>(m + n + 1);
    for (int k = 0; k < doublings; ++k) {
        Square turned{};
        for (int i = 0; i < states; ++i)
            for (int j = 0; j < states; ++j) turned[i][j] = all.step[j][i];
        const Square later = times(turned, times(all.loss, all.step));
        for (int i = 0; i < states; ++i)
            for (int j = 0; j < states; ++j) all.loss[i][j] += later[i][j];
        all.step = times(all.step, all.step);
    }
    return all;
}

// The variables (d, v tau, c u_0, c u_1 P_1, mean of d so far, 2 c u_1), tau^2 = c M: the norm of A
// is a number of decays or turns. mass 0: a damper to the ground alone.
void put_step(ExactLadder::Pattern& s, double resistance, double span) {
    enum { d, v, mean, ramp, integral, rate };
    const Real R = resistance, c = s.c, H = span, tau = s.mass > 0 ? std::sqrt(c * s.mass) : 1;
    Square A{};
    A[d][d] = -1 / (R * c), A[d][mean] = A[d][ramp] = 1 / (R * c);
    if (s.mass > 0) A[d][v] = A[v][mean] = A[v][ramp] = 1 / tau, A[v][d] = -1 / tau;
    A[integral][d] = A[ramp][rate] = 1 / H;
    std::array<Real, states> q{};  // of c u - d
    q[d] = -1, q[mean] = q[ramp] = 1;
    const Doubled all = exponential(A, q, H);
    std::array<std::array<Real, states>, 4> from{};  // by d, v, u_0, u_1
    from[0][d] = 1, from[1][v] = tau, from[2][mean] = c;
    from[3][ramp] = -c, from[3][rate] = 2 * c;
    const auto ends = [&](int row, int x) {
        Real sum = 0;
        for (int j = 0; j < states; ++j) sum += all.step[row][j] * from[x][j];
        return sum;
    };
    for (int x = 0; x < 4; ++x) {
        const Real at = x == 0 ? 1 : 0, end = ends(d, x);
        s.by[0][x] = static_cast<double>(end - at);
        s.by[1][x] = static_cast<double>(end + at - 2 * ends(integral, x));
        s.by[2][x] = static_cast<double>(ends(v, x) / tau - (x == 1 ? 1 : 0));
        for (int y = 0; y < 4; ++y) {
            Real sum = 0;
            for (int i = 0; i < states; ++i)
                for (int j = 0; j < states; ++j) sum += from[x][i] * all.loss[i][j] * from[y][j];
            s.loss[x][y] = static_cast<double>(sum / (R * c * c));
        }
    }
}
}  // namespace

ExactLadder::ExactLadder(const MissingMatrix& m, double span)
    : points_(m.points()), patterns_(points_), w_(m.ladder.V.size()), V_(m.ladder.V) {
    const int n = points_;
    for (int k = 0; k < n; ++k) {
        Pattern& s = patterns_[static_cast<std::size_t>(k)];
        std::vector<double> yield(n);  // C V_k
        for (int p = 0; p < n; ++p)
            for (int q = 0; q < n; ++q) yield[p] += m.C[p * n + q] * V_[k * n + q];
        for (int p = 0; p < n; ++p) s.c += V_[k * n + p] * yield[p];
        s.mass = m.ladder.mass[k];
        if (!(s.c > 0 && m.ladder.resistance[k] > 0)) {  // stands still
            s = {};
            s.c = 1;
            continue;
        }
        for (int p = 0; p < n; ++p) w_[k * n + p] = yield[p] / s.c;
        put_step(s, m.ladder.resistance[k], span);
    }
}

void ExactLadder::add_compliance(std::vector<double>& theta) const {
    const int n = points_, all = 2 * n;
    for (std::size_t k = 0; k < patterns_.size(); ++k)
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                for (int p = 0; p < n; ++p)
                    for (int q = 0; q < n; ++q)
                        theta[(i * n + p) * all + j * n + q] +=
                            w(k, p) * patterns_[k].by[i][2 + j] * w(k, q);
}

void ExactLadder::rest(const double* force) noexcept {
    for (std::size_t k = 0; k < patterns_.size(); ++k) {
        Pattern& s = patterns_[k];
        double u = 0;
        for (int p = 0; p < points_; ++p) u += w(k, p) * force[p];
        s.d = s.c * u;
        s.v = 0;
        s.before = {};
    }
}

void ExactLadder::start_from(const ExactLadder& before) noexcept {
    for (std::size_t k = 0; k < patterns_.size(); ++k)
        patterns_[k].d = before.patterns_[k].d, patterns_[k].v = before.patterns_[k].v;
}

void ExactLadder::forces(double* out) const noexcept {
    for (int p = 0; p < points_; ++p) {
        out[p] = 0;
        for (std::size_t k = 0; k < patterns_.size(); ++k)
            out[p] += V_[k * points_ + p] * patterns_[k].d / patterns_[k].c;
    }
}

double ExactLadder::stored() const noexcept {
    double sum = 0;
    for (const Pattern& s : patterns_) sum += 0.5 * (s.d * s.d / s.c + s.mass * s.v * s.v);
    return sum;
}

double ExactLadder::lost() const noexcept {
    double sum = 0;
    for (const Pattern& s : patterns_)
        for (int x = 0; x < 4; ++x)
            for (int y = 0; y < 4; ++y) sum += s.before[x] * s.loss[x][y] * s.before[y];
    return sum;
}

}  // namespace jvari

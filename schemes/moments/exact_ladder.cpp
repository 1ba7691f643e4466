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
    Square loss;  // int y q q' y over the step, a form in y at its beginning
};
// Taylor's series for a short step, then steps of doubled length.
Doubled exponential(const Square& A, const std::array<Real, states>& q, Real H) {
    Real norm = 0;
    for (const auto& row : A)
        for (const Real x : row) norm = std::max(norm, std::fabs(x) * H);
    int doublings = 4;
    for (; norm > 1; norm /= 2) ++doublings;
    const Real h = std::ldexp(H, -doublings);
    // y(t) = sum of (A t)^n y/n!, so the loss is the sum over m and n of h/(m+n+1) times ((A h)'^m
    // q/m!) (q' (A h)^n/n!)
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

// Uses the variables (d, v tau, c u_0, c u_1 P_1, mean of d so far, 2 c u_1), tau^2 = c M: the norm
// of A is a number of decays or turns. mass 0: a damper to the ground alone.
void put_step(ExactLadder::Pattern& s, double resistance, double span) {
    enum { d, v, mean, ramp, integral, rate };
    const Real R = resistance, c = s.c, H = span, tau = s.mass > 0 ? std::sqrt(c * s.mass) : 1;
    Square A{};
    A[d][d] = -1 / (R * c), A[d][mean] = A[d][ramp] = 1 / (R * c);
    if (s.mass > 0) A[d][v] = A[v][mean] = A[v][ramp] = 1 / tau, A[v][d] = -1 / tau;
    A[integral][d] = A[ramp][rate] = 1 / H;
    std::array<Real, states> q{};  // for c u - d
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
    : points_(m.points()), patterns_(points_), w_(m.ladder.V.size()), push_(m.ladder.V) {
    const int n = points_;
    for (int k = 0; k < n; ++k) {
        Pattern& s = patterns_[static_cast<std::size_t>(k)];
        std::vector<double> yield(n);  // C V_k
        for (int p = 0; p < n; ++p)
            for (int q = 0; q < n; ++q) yield[p] += m.C[p * n + q] * m.ladder.V[k * n + q];
        for (int p = 0; p < n; ++p) s.c += m.ladder.V[k * n + p] * yield[p];
        s.mass = m.ladder.mass[k];
        if (!(s.c > 0 && m.ladder.resistance[k] > 0)) {  // stands still
            s = {};
            s.c = 1;
            continue;
        }
        for (int p = 0; p < n; ++p) w_[k * n + p] = yield[p] / s.c, push_[k * n + p] /= s.c;
        put_step(s, m.ladder.resistance[k], span);
    }
}

void ExactLadder::rest(const double* force, double* x) const noexcept {
    for (int k = 0; k < points_; ++k) {
        double u = 0;
        for (int p = 0; p < points_; ++p) u += w(k, p) * force[p];
        x[k] = pattern(k).c * u;
        x[points_ + k] = 0;
    }
}

double ExactLadder::yields(const double* x, int p) const noexcept {
    double sum = 0;
    for (int k = 0; k < points_; ++k) sum += w(k, p) * x[k];
    return sum;
}

void ExactLadder::forces(const double* x, double* out) const noexcept {
    for (int p = 0; p < points_; ++p) {
        out[p] = 0;
        for (int k = 0; k < points_; ++k) out[p] += push_[k * points_ + p] * x[k];
    }
}

double ExactLadder::stored(const double* x) const noexcept {
    double sum = 0;
    for (int k = 0; k < points_; ++k) {
        const double d = x[k], v = x[points_ + k];
        sum += 0.5 * (d * d / pattern(k).c + pattern(k).mass * v * v);
    }
    return sum;
}

double ExactLadder::lost(const double* x, const double* force) const noexcept {
    double sum = 0;
    for (int k = 0; k < points_; ++k) {
        double y[4] = {x[k], x[points_ + k], 0, 0};
        for (int p = 0; p < points_; ++p) {
            y[2] += w(k, p) * force[p];
            y[3] += w(k, p) * force[points_ + p];
        }
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) sum += y[i] * pattern(k).loss[i][j] * y[j];
    }
    return sum;
}

}  // namespace jvari

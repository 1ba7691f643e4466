#include "reference/window_energies.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "reference/touching_set.hpp"

namespace jvari {

namespace {
using Complex = std::complex<double>;

constexpr double rounding = 1e-15, of_tolerance = 1e-3;  // of an integral, relative
constexpr double longest = 2.5;                          // growth over a piece, in powers of e
constexpr double fast = 10;  // |lambda| x piece from which on a Legendre series against e^(lambda t) keeps its digits

// int_0^z e^x dx/z
Complex mean_exponential(Complex z) {
    if (std::abs(z) > 0.5) return (std::exp(z) - 1.0) / z;
    Complex term = 1, sum = 1;
    for (int n = 2; n < 20; ++n) sum += term *= z / double(n);
    return sum;
}
// Of f^2 where f grows by e^growth: n!^4/((2n + 1)(2n)!^3) (2 growth)^2n
double gauss_error(int n, double growth) {
    return std::exp(4 * std::lgamma(n + 1) - 3 * std::lgamma(2 * n + 1) + 2 * n * std::log(2 * growth)) / (2 * n + 1);
}
}  // namespace

WindowEnergies::WindowEnergies(MacroWindow& w, const Modes& modes, double tolerance)
    : window_(&w), allowed_(std::max(rounding, of_tolerance * tolerance)) {
    const int M = w.osc.padded;
    const Springs& s = w.springs;
    const double seconds = w.seconds();
    for (int n = 2; n <= most_nodes; ++n) {
        const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> table(
            gsl_integration_glfixed_table_alloc(n), gsl_integration_glfixed_table_free);
        Rule rule{n, {}, {}};
        for (int q = 0; q < n; ++q) gsl_integration_glfixed_point(0, 1, q, &rule.node[q], &rule.weight[q], table.get());
        rules_.push_back(rule);
    }
    const Rule& finest = rules_.back();
    legendre_.resize(most_nodes, most_nodes);
    for (int q = 0; q < most_nodes; ++q)
        for (int j = 0; j < most_nodes; ++j) legendre_(j, q) = (2 * j + 1) * finest.weight[q] * std::legendre(j, 2 * finest.node[q] - 1);

    const auto row = [&](const std::vector<double>& rows, int a) {
        return Eigen::Map<const Eigen::VectorXd>(rows.data() + static_cast<long>(a) * M, M);
    };
    loss_ = Eigen::VectorXd::Zero(M + 1);
    for (int i = 0; i < modes.count(); ++i) loss_[i] = 2 * modes.mass * modes.sigma[i] / seconds;
    thread_ = pluck_ = Eigen::VectorXd::Zero(M);
    if (w.threaded() && !w.series()) {  // in series the thread moves otherwise than its point
        thread_ = row(s.weights, w.contacts);
        loss_[M] = s.r[w.contacts] / w.osc.rate / seconds;
    }
    if (s.forces > s.points) pluck_ = row(s.gains, s.points) * (modes.mass * w.osc.rate * w.osc.rate);
    moments_.assign(static_cast<std::size_t>(w.contacts + 1) * w.stride, 0.0);
    y_.assign(M, 0.0);
    u_ = lost_ = Eigen::VectorXd::Zero(M + 1);
    const int most_pairs = std::max(1, w.contacts);
    lost_to_ = gained_by_ = Eigen::MatrixXcd::Zero(most_nodes, most_pairs);
}

WindowEnergies::Pairs WindowEnergies::pairs_of(const TouchingSet& set) {
    MacroWindow& w = *window_;
    const int M = w.osc.padded, P = set.pairs();
    Pairs p;
    p.rates.assign(set.rates(), set.rates() + P);
    p.moments = Eigen::MatrixXd::Zero(static_cast<long>(w.contacts + 1) * w.stride, 2 * P);
    p.velocity = Eigen::MatrixXd::Zero(M + 1, 2 * P);
    const std::vector<double> rest(M, 0.0);
    w.open(rest.data(), rest.data(), false, 0);  // the thread alone acts then: what it does is taken off
    std::vector<double> y(M);
    Eigen::VectorXd alone(M), u(M);
    w.state_at(1, moments_.data(), rest.data(), rest.data(), y.data(), alone.data());
    for (int k = 0; k < P; ++k) {
        for (std::size_t i = 0; i < set.points().size(); ++i) {
            Complex moment = set.pair_force(static_cast<int>(i), k);
            for (int n = 0; n < w.terms; ++n) {
                moment /= p.rates[k];
                p.moments(set.points()[i] * w.stride + n, 2 * k) = moment.real();
                p.moments(set.points()[i] * w.stride + n, 2 * k + 1) = moment.imag();
            }
        }
        for (int part = 0; part < 2; ++part) {
            w.state_at(1, p.moments.col(2 * k + part).data(), rest.data(), rest.data(), y.data(), u.data());
            p.velocity.col(2 * k + part).head(M) = u - alone;
            p.velocity(M, 2 * k + part) = thread_.dot(u - alone);
        }
    }
    const auto W = [&](int k) { return (p.velocity.col(2 * k) + Complex(0, 1) * p.velocity.col(2 * k + 1)).eval(); };
    p.product = p.product_of_conjugate = Eigen::MatrixXcd::Zero(P, P);
    p.pluck = Eigen::VectorXcd::Zero(P);
    for (int k = 0; k < P; ++k) {
        for (int l = 0; l < P; ++l) {
            p.product(k, l) = (W(k).array() * W(l).array() * loss_.array()).sum();
            p.product_of_conjugate(k, l) = (W(k).array() * W(l).conjugate().array() * loss_.array()).sum();
        }
        p.pluck[k] = (W(k).head(M).array() * pluck_.array()).sum();
    }
    return p;
}

int WindowEnergies::plan(const Stretch& s) noexcept {
    const double whole = s.to - s.from;
    const double smooth = std::max(s.growth, window_->push_growth());
    double slowest = HUGE_VAL, fastest = smooth;
    for (const Complex& rate : s.pairs.rates) {
        slowest = std::min(slowest, std::abs(rate));
        fastest = std::max(fastest, std::abs(rate));
    }
    const auto cut = [&](double growth) { return std::max(1, static_cast<int>(std::ceil(whole * growth / longest))); };
    int pieces = cut(smooth);
    split_ = !s.pairs.rates.empty() && slowest * whole / pieces > fast;
    if (!split_) pieces = cut(fastest);
    length_ = whole / pieces;
    rule_ = &rules_.back();
    for (auto r = rules_.rbegin(); !split_ && r != rules_.rend() && gauss_error(r->nodes, fastest * length_) < allowed_; ++r) rule_ = &*r;
    return pieces;
}

void WindowEnergies::add_node(const Stretch& s, int q, double at, Sums& sums) noexcept {
    MacroWindow& w = *window_;
    const int M = w.osc.padded, P = split_ ? static_cast<int>(s.pairs.rates.size()) : 0;
    const double weight = length_ * rule_->weight[q];
    Eigen::Map<Eigen::VectorXd> moments(moments_.data(), static_cast<long>(moments_.size()));
    for (int k = 0; k < P; ++k) {  // what is left of them is slow
        const Complex z = s.beta[k] * std::exp(s.pairs.rates[k] * (at - s.from));
        moments -= z.real() * s.pairs.moments.col(2 * k) - z.imag() * s.pairs.moments.col(2 * k + 1);
    }
    w.state_near(at, moments_.data(), s.y, s.u, y_.data(), u_.data());
    if (loss_[M] > 0) u_[M] = thread_.dot(u_.head(M));
    lost_ = loss_.cwiseProduct(u_);
    sums.dissipated += weight * lost_.dot(u_);
    const MacroWindow::Push pluck = w.push_at(at);
    sums.supplied += weight * pluck.force * pluck_.dot(u_.head(M));
    for (int k = 0; k < P; ++k) {
        lost_to_(q, k) = 2.0 * Complex(lost_.dot(s.pairs.velocity.col(2 * k)), lost_.dot(s.pairs.velocity.col(2 * k + 1)));
        gained_by_(q, k) = pluck.force * s.pairs.pluck[k];
    }
    if (w.series()) {
        const auto p = w.series_power(y_.data(), pluck);
        sums.supplied += weight * p.supplied;
        sums.dissipated += weight * p.dissipated;
    }
}

// int e^(lambda (t - from)) P_j dt of a piece: by parts, exact; P_j^(m)(1) = (j + m)!/(2^m m! (j - m)!).
void WindowEnergies::add_pairs(const Stretch& s, double start, Sums& sums) noexcept {
    const int P = static_cast<int>(s.pairs.rates.size());
    for (int k = 0; k < P; ++k) {
        const Complex rate = s.pairs.rates[k], z = 0.5 * rate * length_;
        const Complex first = std::exp(rate * (start - s.from)), last = std::exp(rate * (start + length_ - s.from));
        Complex lost = 0, gained = 0;
        for (int j = 0; j < most_nodes; ++j) {
            Complex lost_j = 0, gained_j = 0, integral = 0, power = z;
            for (int q = 0; q < most_nodes; ++q) {
                lost_j += legendre_(j, q) * lost_to_(q, k);
                gained_j += legendre_(j, q) * gained_by_(q, k);
            }
            double derivative = 1;
            for (int m = 0; m <= j; ++m, power *= z) {
                integral += derivative * ((m % 2 ? -1.0 : 1.0) * last - (j % 2 ? -1.0 : 1.0) * first) / power;
                derivative *= 0.5 * (j + m + 1) * (j - m) / (m + 1);
            }
            lost += lost_j * integral;
            gained += gained_j * integral;
        }
        sums.dissipated += 0.5 * length_ * (s.beta[k] * lost).real();
        sums.supplied += 0.5 * length_ * (s.beta[k] * gained).real();
        for (int l = 0; l < P; ++l) {
            const auto integral = [&](Complex a, Complex b) {  // of e^((a + b)(t - from))
                return std::exp((a + b) * (start - s.from)) * mean_exponential((a + b) * length_) * length_;
            };
            const Complex other = s.pairs.rates[l];
            sums.dissipated +=
                0.5 * (s.beta[k] * s.beta[l] * s.pairs.product(k, l) * integral(rate, other) +
                       s.beta[k] * std::conj(s.beta[l]) * s.pairs.product_of_conjugate(k, l) * integral(rate, std::conj(other)))
                          .real();
        }
    }
}

}  // namespace jvari

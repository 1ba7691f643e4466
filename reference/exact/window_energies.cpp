#include "reference/exact/window_energies.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "reference/gauss_legendre.hpp"

namespace jvari {

namespace {
using Complex = std::complex<double>;

constexpr double rounding = 1e-15, of_tolerance = 1e-3;  // for an integral, relative
constexpr double longest = 2.5;                          // growth over a piece, in powers of e
// |lambda| x piece above which a Legendre series against e^(lambda t) keeps its digits
constexpr double fast = 10;

// int_0^z e^x dx/z
Complex mean_exponential(Complex z) {
    if (std::abs(z) > 0.5) return (std::exp(z) - 1.0) / z;
    Complex term = 1, sum = 1;
    for (int n = 2; n < 20; ++n) sum += term *= z / double(n);
    return sum;
}
double legendre(int n, double x) {
    double p = 1, before = 0;
    for (int j = 0; j < n; ++j)
        before = std::exchange(p, ((2 * j + 1) * x * p - j * before) / (j + 1));
    return p;
}
// f may grow by so much for the error of f^2 by n nodes, n!^4/((2n + 1)(2n)!^3) (2 growth)^2n, to
// be `allowed`.
double growth_for(int n, double allowed) {
    return 0.5 * std::exp((std::log(allowed * (2 * n + 1)) - 4 * std::lgamma(n + 1) +
                           3 * std::lgamma(2 * n + 1)) /
                          (2 * n));
}
}  // namespace

WindowEnergies::WindowEnergies(MacroWindow& w, const Modes& modes, double tolerance) : window_(&w) {
    const int M = w.osc.padded;
    const Springs& s = w.springs;
    const double seconds = w.seconds();
    for (int n = 2; n <= most_nodes; ++n) {
        Rule rule{n, growth_for(n, std::max(rounding, of_tolerance * tolerance)), {}, {}};
        gauss_legendre(std::span(rule.node).first(n), std::span(rule.weight).first(n));
        rules_.push_back(rule);
    }
    const Rule& finest = rules_.back();
    for (int j = 0; j < most_nodes; ++j)
        for (int q = 0; q < most_nodes; ++q)
            legendre_.push_back((2 * j + 1) * finest.weight[q] *
                                legendre(j, 2 * finest.node[q] - 1));

    for (int i = 0; i < modes.count(); ++i)
        loss_.push_back(2 * modes.mass * modes.sigma[i] / seconds);
    loss_ = w.osc.pad(loss_);
    const auto row = [&](const std::vector<double>& rows, int a, double factor) {
        const auto first = rows.begin() + static_cast<long>(a) * M;
        return w.osc.pad({first, first + M}, factor);
    };
    thread_ = pluck_ = y_ = u_ = lost_ = std::vector<double>(M, 0.0);
    if (w.threaded()) {
        thread_ = row(s.weights, w.contacts, 1);
        thread_loss_ = s.r[w.contacts] / w.osc.rate / seconds;
    }
    if (s.forces > s.points) pluck_ = row(s.gains, s.points, modes.mass * w.osc.rate * w.osc.rate);
    moments_.assign(static_cast<std::size_t>(w.contacts + 1) * w.stride, 0.0);
    force_.assign(w.contacts + 2, 0.0);
    if (w.series()) {
        speed_.assign(w.series()->states, 0.0);
        for (double q : w.series()->loss) series_loss_.push_back(q / seconds);
    }
    // with something in series two pairs each
    lost_to_.assign(static_cast<std::size_t>(2 * w.contacts + 1) * most_nodes, 0.0);
    gained_by_ = lost_to_;
    split_.reserve(2 * w.contacts + 1);
}

Complex WindowEnergies::Pairs::against(const std::vector<double>& row, int pair,
                                       const Oscillators& osc) const {
    const double* re = velocity.data() + static_cast<long>(2 * pair) * osc.padded;
    return {dot(osc, row.data(), re), dot(osc, row.data(), re + osc.padded)};
}

WindowEnergies::Pairs WindowEnergies::pairs_of(const TouchingSet& set) {
    MacroWindow& w = *window_;
    const int M = w.osc.padded, P = set.pairs();
    const std::size_t row = moments_.size();
    Pairs p;
    p.rates.assign(set.rates(), set.rates() + P);
    p.moments.assign(2 * P * row, 0.0);
    if (P == 0) return p;
    const std::vector<double> rest(M, 0.0);
    std::vector<double> y(M), alone(M), u(M);
    const int states = static_cast<int>(speed_.size());
    w.open(rest.data(), rest.data(), false, 0,
           // only the thread acts then: its effect is subtracted
           std::vector<double>(states).data());
    w.state_at(1, p.moments.data(), rest.data(), rest.data(), y.data(), alone.data());
    const std::vector<double> z_alone(w.series_state(), w.series_state() + states);
    const double thread_alone = w.thread_force();
    p.force.assign(static_cast<std::size_t>(P) * w.springs.points, 0.0);
    for (int k = 0; k < P; ++k) {
        for (std::size_t i = 0; i < set.points().size(); ++i) {
            Complex moment = set.pair_force(static_cast<int>(i), k);
            double* m =
                p.moments.data() + 2 * k * row + static_cast<long>(set.points()[i]) * w.stride;
            for (int n = 0; n < w.terms; ++n) {
                moment /= p.rates[k];
                m[n] = moment.real();
                m[row + n] = moment.imag();
            }
        }
        std::vector<Complex> z(states);
        Complex thread = 0, *force = p.force.data() + k * w.springs.points;
        for (std::size_t i = 0; i < set.points().size(); ++i)
            force[set.points()[i]] = set.pair_force(static_cast<int>(i), k);
        for (const Complex part : {Complex(1, 0), Complex(0, 1)}) {
            const double* m = p.moments.data() + (2 * k + (part.imag() > 0 ? 1 : 0)) * row;
            w.state_at(1, m, rest.data(), rest.data(), y.data(), u.data());
            for (int i = 0; i < M; ++i) u[i] -= alone[i];
            p.velocity.insert(p.velocity.end(), u.begin(), u.end());
            thread += part * dot(w.osc, thread_.data(), u.data());
            if (w.threaded()) force[w.contacts] += part * (w.thread_force() - thread_alone);
            for (int j = 0; j < states; ++j) z[j] += part * (w.series_state()[j] - z_alone[j]);
        }
        for (Complex& x : z) x *= p.rates[k];  // velocities
        if (w.threaded() && states > 0) thread += z[w.contacts];
        p.thread.push_back(thread);
        p.series.insert(p.series.end(), z.begin(), z.end());
    }
    for (int k = 0; k < P; ++k) {
        const auto W = [&](int pair, int i) {
            return Complex(p.velocity[2 * pair * M + i], p.velocity[(2 * pair + 1) * M + i]);
        };
        for (int l = 0; l < P; ++l) {
            Complex product = thread_loss_ * p.thread[k] * p.thread[l],
                    of_conjugate = thread_loss_ * p.thread[k] * std::conj(p.thread[l]);
            for (int i = 0; i < states; ++i)
                for (int j = 0; j < states; ++j) {
                    const Complex lost = series_loss_[i * states + j] * p.series[k * states + i],
                                  other = p.series[l * states + j];
                    product += lost * other;
                    of_conjugate += lost * std::conj(other);
                }
            for (int i = 0; i < M; ++i) {
                product += loss_[i] * W(k, i) * W(l, i);
                of_conjugate += loss_[i] * W(k, i) * std::conj(W(l, i));
            }
            p.product.push_back(product);
            p.product_of_conjugate.push_back(of_conjugate);
        }
        p.pluck.push_back(p.against(pluck_, k, w.osc));
    }
    return p;
}

int WindowEnergies::plan(const Stretch& s) noexcept {
    const double whole = s.to - s.from;
    const double smooth =
        std::max(s.touch ? s.touch->set.growth() : window_->reach, window_->push_growth());
    split_.clear();
    for (int k = 0; s.touch && k < s.touch->set.pairs(); ++k) split_.push_back(k);
    const auto rate = [&](int k) { return std::abs(s.touch->pairs.rates[k]); };
    std::sort(split_.begin(), split_.end(), [&](int a, int b) { return rate(a) > rate(b); });
    const auto cut = [&](double growth) {
        return std::max(1, static_cast<int>(std::ceil(whole * growth / longest)));
    };
    // the slowest pairs stay with the string, until all split pairs are fast against a piece
    double growth = smooth;
    for (; !split_.empty() && !(rate(split_.back()) * whole / cut(growth) > fast);
         split_.pop_back())
        growth = std::max(growth, rate(split_.back()));
    std::sort(split_.begin(), split_.end());
    const int pieces = cut(growth);
    length_ = whole / pieces;
    rule_ = &rules_.back();
    for (auto r = rules_.rbegin();
         split_.empty() && r != rules_.rend() && growth * length_ < r->growth; ++r)
        rule_ = &*r;
    return pieces;
}

void WindowEnergies::add_node(const Stretch& s, int q, double at, Sums& sums) noexcept {
    MacroWindow& w = *window_;
    const int M = w.osc.padded;
    const std::size_t row = moments_.size();
    const double weight = length_ * rule_->weight[q];
    for (const int k : split_) {  // the slow remainder
        const Complex z = s.touch->set.beta(k) * std::exp(s.touch->pairs.rates[k] * (at - s.from));
        const double *re = s.touch->pairs.moments.data() + 2 * k * row, *im = re + row;
        for (std::size_t n = 0; n < row; ++n) moments_[n] -= z.real() * re[n] - z.imag() * im[n];
        for (int a = 0; a < w.contacts; ++a)
            force_[a] -= (z * s.touch->pairs.force[k * w.springs.points + a]).real();
    }
    w.state_near(at, moments_.data(), s.y, s.u, y_.data(), u_.data());
    const int states = static_cast<int>(speed_.size());
    if (w.threaded()) force_[w.contacts] = w.thread_force();
    if (w.series()) w.series_speed(force_.data(), speed_.data());
    for (int i = 0; i < M; ++i) lost_[i] = loss_[i] * u_[i];
    const MacroWindow::Push pluck = w.push_at(at);
    double thread = thread_loss_ > 0 ? dot(w.osc, thread_.data(), u_.data()) : 0;
    if (w.threaded() && states > 0)
        thread += speed_[w.contacts] + w.series()->plucked(w.contacts) * pluck.change;
    sums.dissipated +=
        weight * (dot(w.osc, lost_.data(), u_.data()) + thread_loss_ * thread * thread);
    if (pluck.force != 0)
        sums.supplied += weight * pluck.force * dot(w.osc, pluck_.data(), u_.data());
    for (const int k : split_) {
        const Pairs& p = s.touch->pairs;
        lost_to_[k * most_nodes + q] =
            2.0 * (p.against(lost_, k, w.osc) + thread_loss_ * thread * p.thread[k]);
        gained_by_[k * most_nodes + q] = pluck.force * p.pluck[k];
    }
    for (int i = 0; i < states; ++i)
        for (int j = 0; j < states; ++j) {
            const double lost = series_loss_[i * states + j] * speed_[i];
            sums.dissipated += weight * lost * speed_[j];
            for (const int k : split_)
                lost_to_[k * most_nodes + q] += 2.0 * lost * s.touch->pairs.series[k * states + j];
        }
    // the points move by C_ae F_e too
    for (int a = 0; states > 0 && a < w.springs.points; ++a) {
        const double per_force = -w.series()->plucked(a) * pluck.change;
        sums.supplied += weight * per_force * force_[a];
        for (const int k : split_)
            gained_by_[k * most_nodes + q] +=
                per_force * s.touch->pairs.force[k * w.springs.points + a];
    }
}

// int e^(lambda (t - from)) P_j dt of a piece: by parts, exact; P_j^(m)(1) = (j + m)!/(2^m m! (j -
// m)!).
void WindowEnergies::add_pairs(const Stretch& s, double start, Sums& sums) noexcept {
    const Pairs& p = s.touch->pairs;
    const int P = s.touch->set.pairs();
    for (const int k : split_) {
        const Complex rate = p.rates[k], beta = s.touch->set.beta(k), z = 0.5 * rate * length_;
        const Complex first = std::exp(rate * (start - s.from)),
                      last = std::exp(rate * (start + length_ - s.from));
        Complex lost = 0, gained = 0;
        for (int j = 0; j < most_nodes; ++j) {
            Complex lost_j = 0, gained_j = 0, integral = 0, power = z;
            for (int q = 0; q < most_nodes; ++q) {
                lost_j += legendre_[j * most_nodes + q] * lost_to_[k * most_nodes + q];
                gained_j += legendre_[j * most_nodes + q] * gained_by_[k * most_nodes + q];
            }
            double derivative = 1;
            for (int m = 0; m <= j; ++m, power *= z) {
                integral += derivative *
                            ((m % 2 ? -1.0 : 1.0) * last - (j % 2 ? -1.0 : 1.0) * first) / power;
                derivative *= 0.5 * (j + m + 1) * (j - m) / (m + 1);
            }
            lost += lost_j * integral;
            gained += gained_j * integral;
        }
        sums.dissipated += 0.5 * length_ * (beta * lost).real();
        sums.supplied += 0.5 * length_ * (beta * gained).real();
        for (const int l : split_) {
            const auto integral = [&](Complex a, Complex b) {  // integral of e^((a + b)(t - from))
                return std::exp((a + b) * (start - s.from)) * mean_exponential((a + b) * length_) *
                       length_;
            };
            const Complex other = p.rates[l], beta_l = s.touch->set.beta(l);
            sums.dissipated += 0.5 * (beta * beta_l * p.product[k * P + l] * integral(rate, other) +
                                      beta * std::conj(beta_l) * p.product_of_conjugate[k * P + l] *
                                          integral(rate, std::conj(other)))
                                         .real();
        }
    }
}

}  // namespace jvari

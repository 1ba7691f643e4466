// Sources: Issanchou et al. 2016 (profiles, eq 29), van Walstijn et al. 2016 eqs 54-55 (contact
// stiffness from materials), Steffen 1990, Astronomy & Astrophysics 239, p. 443 (monotone
// interpolation of a table).
#include "scenes/barrier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace jvari {

namespace {
// Interpolates by a cubic between every two rows of a table. Each cubic is monotone: its slope at a
// row belongs to the parabola through the row and its neighbours, is 0 if the heights turn, and at
// most twice a neighbouring secant's. At the table's ends the slope is the secant's.
class MonotoneCubics {
public:
    explicit MonotoneCubics(const TableCurve& c) : x_(c.x), y_(c.height) {
        const std::size_t last = x_.size() - 2;  // last interval
        slope_.push_back(secant(0));
        for (std::size_t i = 1; i <= last; ++i) {
            const double before = secant(i - 1), after = secant(i);
            const double parabola =
                (before * width(i) + after * width(i - 1)) / (width(i - 1) + width(i));
            const double size =
                std::min({2 * std::abs(before), 2 * std::abs(after), std::abs(parabola)});
            slope_.push_back(before * after > 0 ? std::copysign(size, before) : 0.0);
        }
        slope_.push_back(secant(last));
    }
    double operator()(double x) const {  // between the first row and the last
        const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
        const std::size_t i = above - x_.begin() - 1;
        const double h = width(i), s = secant(i), t = x - x_[i];
        const double a = (slope_[i] + slope_[i + 1] - 2 * s) / (h * h),
                     b = (3 * s - 2 * slope_[i] - slope_[i + 1]) / h;
        return y_[i] + t * (slope_[i] + t * (b + t * a));
    }

private:
    double width(std::size_t i) const { return x_[i + 1] - x_[i]; }
    double secant(std::size_t i) const { return (y_[i + 1] - y_[i]) / width(i); }
    const std::vector<double>&x_, &y_;  // from the table, which outlives this object
    std::vector<double> slope_;         // at each row
};

struct HeightAt {
    const std::vector<double>& x;
    std::vector<double> operator()(const FlatCurve&) const {
        return std::vector<double>(x.size(), 0.0);
    }
    std::vector<double> operator()(const LineCurve& c) const {
        std::vector<double> g;
        for (double p : x) g.push_back(c.coefficient * p);
        return g;
    }
    std::vector<double> operator()(const ParabolaCurve& c) const {
        std::vector<double> g;
        for (double p : x) g.push_back(-c.coefficient * p * p);  // (29)
        return g;
    }
    std::vector<double> operator()(const TableCurve& c) const {
        const MonotoneCubics between(c);
        std::vector<double> g;
        // a grid may round past the table's end
        for (double p : x) g.push_back(between(std::clamp(p, c.x.front(), c.x.back())));
        return g;
    }
};
}  // namespace

std::vector<double> heights(const Curve& curve, const std::vector<double>& x) {
    return std::visit(HeightAt{x}, curve);
}

double height(const Curve& curve, double x) { return heights(curve, {x}).front(); }

ProfileNodes nodes_on(const ProfileBarrier& b, double length, int intervals) {
    const double dx = length / intervals, slack = near_node * intervals;
    ProfileNodes nodes{std::max(1, static_cast<int>(std::ceil(b.from / dx - slack))), {}};
    const int last = std::min(intervals - 1, static_cast<int>(std::floor(b.to / dx + slack)));
    for (int i = nodes.first; i <= last; ++i) nodes.x.push_back(std::clamp(i * dx, b.from, b.to));
    return nodes;
}

std::vector<LumpedBarrier> lumped(const ProfileBarrier& b, const std::vector<double>& x,
                                  double spacing) {
    std::vector<LumpedBarrier> points;
    const auto g = heights(b.curve, x);
    for (std::size_t q = 0; q < x.size(); ++q)
        points.push_back(
            {x[q], 0, g[q], {b.stiffness.K * spacing}, b.exponent, b.contact_loss, b.loss_law});
    return points;
}

std::vector<LumpedBarrier> lumped(const ProfileBarrier& b, int parts) {
    std::vector<double> middles;
    const double spacing = (b.to - b.from) / parts;
    for (int q = 0; q < parts; ++q) middles.push_back(b.from + (q + 0.5) * spacing);
    return lumped(b, middles, spacing);
}

std::vector<Barrier> without_profiles(const String& s, const PointsOf& points_of) {
    std::vector<Barrier> all;
    for (const Barrier& barrier : s.barriers) {
        const auto* profile = std::get_if<ProfileBarrier>(&barrier);
        if (!profile) all.push_back(barrier);
        else
            for (const LumpedBarrier& point : points_of(*profile)) all.push_back(point);
    }
    return all;
}

double contact_modulus(double young1, double poisson1, double young2, double poisson2) {
    // (55)
    return 1 /
           ((1 - poisson1 * poisson1) / (2 * young1) + (1 - poisson2 * poisson2) / (2 * young2));
}

// With m w w' = -V'(eta) (1 + beta w), w = eta', the integral of w/(1 + beta w) from -e v to v is
// 0: (1 + e) d = ln((1 + d)/(1 - e d)), d = beta v < 1/e. Near d = 0 both sides agree: bisection.
double loss_for_rebound(double restitution, double speed) {
    const double e = restitution;
    if (e >= 1) return 0;
    // the root lies above the minimum of the difference, at d = (1 - e)/e
    double low = (1 - e) / e, high = 1 / e;
    while (true) {
        const double d = low + 0.5 * (high - low);
        if (!(d > low && d < high)) return d / speed;
        (std::log1p(d) - std::log1p(-e * d) < (1 + e) * d ? low : high) = d;
    }
}

LumpedStiffness contact_stiffness(double contact_modulus, double width) {
    return {std::numbers::pi / 4 * contact_modulus * width};
}

}  // namespace jvari

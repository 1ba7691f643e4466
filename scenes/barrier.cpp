// Sources: Issanchou et al. 2016 (profiles, eq 29), van Walstijn et al. 2016 eqs 54-55 (contact stiffness from materials).
#include "scenes/barrier.hpp"

#include <gsl/gsl_interp.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace jvari {

namespace {
struct HeightAt {
    const std::vector<double>& x;
    std::vector<double> operator()(const FlatCurve&) const { return std::vector<double>(x.size(), 0.0); }
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
        const auto* kind = c.x.size() > 2 ? gsl_interp_steffen : gsl_interp_linear;
        const std::unique_ptr<gsl_interp, decltype(&gsl_interp_free)> spline(gsl_interp_alloc(kind, c.x.size()), gsl_interp_free);
        gsl_interp_init(spline.get(), c.x.data(), c.height.data(), c.x.size());
        std::vector<double> g;
        for (double p : x) {  // a grid may round past the table's end, where GSL would abort; the end's height holds there
            const double within = std::clamp(p, c.x.front(), c.x.back());
            g.push_back(gsl_interp_eval(spline.get(), c.x.data(), c.height.data(), within, nullptr));
        }
        return g;
    }
};
}  // namespace

std::vector<double> heights(const Curve& curve, const std::vector<double>& x) {
    return std::visit(HeightAt{x}, curve);
}

double height(const Curve& curve, double x) {
    return heights(curve, {x}).front();
}

ProfileNodes nodes_on(const ProfileBarrier& b, double length, int intervals) {
    const double dx = length / intervals, slack = near_node * intervals;
    ProfileNodes nodes{std::max(1, static_cast<int>(std::ceil(b.from / dx - slack))), {}};
    const int last = std::min(intervals - 1, static_cast<int>(std::floor(b.to / dx + slack)));
    for (int i = nodes.first; i <= last; ++i) nodes.x.push_back(std::clamp(i * dx, b.from, b.to));
    return nodes;
}

std::vector<double> middles(const ProfileBarrier& b, int count) {
    std::vector<double> x;
    const double spacing = (b.to - b.from) / count;
    for (int q = 0; q < count; ++q) x.push_back(b.from + (q + 0.5) * spacing);
    return x;
}

std::vector<LumpedBarrier> lumped(const ProfileBarrier& b, const std::vector<double>& x, double spacing) {
    std::vector<LumpedBarrier> points;
    const auto g = heights(b.curve, x);
    for (std::size_t q = 0; q < x.size(); ++q) points.push_back({x[q], 0, g[q], {b.stiffness.K * spacing}, b.exponent, b.contact_loss});
    return points;
}

double contact_modulus(double young1, double poisson1, double young2, double poisson2) {
    return 1 / ((1 - poisson1 * poisson1) / (2 * young1) + (1 - poisson2 * poisson2) / (2 * young2));  // (55)
}

LumpedStiffness contact_stiffness(double contact_modulus, double width) {
    return {std::numbers::pi / 4 * contact_modulus * width};
}

}  // namespace jvari

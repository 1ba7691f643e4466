#include "analysis/resonators.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "schemes/trace.hpp"

namespace jvari {

namespace {
constexpr double reluctance = 1e-3;  // to take large gains that cancel each other (Tikhonov), of the norm of a section's response

// The poles' angles w_k, and radii exp(-(w_{k+1} - w_{k-1})/4): half the distance of its neighbours on each side. None rings on after
// `rows`, to a thousandth.
std::vector<Section> poles(double rate, int count, double lowest, double rows) {
    const double first = 2 * std::numbers::pi * lowest / rate, last = 0.9 * std::numbers::pi;
    const double step = count > 1 ? std::pow(last / first, 1.0 / (count - 1)) : last / first;
    std::vector<Section> all;
    for (int k = 0; k < count; ++k) {
        const double w = first * std::pow(step, k), bandwidth = std::max(0.5 * w * (step - 1 / step), 2 * std::log(1000) / rows),
                     radius = std::exp(-bandwidth / 2);
        all.push_back({0, 0, -2 * radius * std::cos(w), radius * radius});
    }
    return all;
}
}  // namespace

Resonators resonators_for(std::span<const double> response, double rate, int count, double lowest) {
    if (count < 1) throw std::invalid_argument("at least one section is expected");
    if (!(rate > 4 * lowest)) throw std::invalid_argument("a rate above four times the lowest section's frequency is expected");
    const auto given = static_cast<Eigen::Index>(response.size()), rows = 2 * given;  // silence after it, too: what rings on would be heard
    if (given < 2 * count + 1) throw std::invalid_argument("a response of more rows than two per section is expected");
    Resonators r{0, poles(rate, count, lowest, static_cast<double>(given))};
    const Eigen::Index unknowns = 2 * count + 1;
    Eigen::MatrixXd impulse = Eigen::MatrixXd::Zero(rows + unknowns, unknowns);
    for (int k = 0; k < count; ++k) {
        double y1 = 0, y2 = 0;
        for (Eigen::Index n = 0; n < rows; ++n) {
            const double y = (n == 0) - r.sections[k].a1 * y1 - r.sections[k].a2 * y2;
            impulse(n, 2 * k) = y;
            impulse(n, 2 * k + 1) = y1;
            y2 = y1;
            y1 = y;
        }
    }
    impulse(0, 2 * count) = 1;
    const Eigen::RowVectorXd scale = impulse.colwise().norm();
    impulse.array().rowwise() /= scale.array();
    impulse.bottomRows(unknowns).diagonal().setConstant(reluctance);
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(rows + unknowns);
    wanted.head(given) = Eigen::Map<const Eigen::VectorXd>(response.data(), given);
    const Eigen::VectorXd b = impulse.householderQr().solve(wanted).array() / scale.transpose().array();
    for (int k = 0; k < count; ++k) r.sections[k].b0 = b[2 * k], r.sections[k].b1 = b[2 * k + 1];
    r.direct = b[2 * count];
    return r;
}

std::vector<double> filtered(const Resonators& r, std::span<const double> signal) {
    std::vector<double> out(signal.size());
    for (std::size_t n = 0; n < signal.size(); ++n) out[n] = r.direct * signal[n];
    for (const Section& s : r.sections) {
        double v1 = 0, v2 = 0;  // v = signal/(1 + a1 z^-1 + a2 z^-2)
        for (std::size_t n = 0; n < signal.size(); ++n) {
            const double v = signal[n] - s.a1 * v1 - s.a2 * v2;
            out[n] += s.b0 * v + s.b1 * v1;
            v2 = v1;
            v1 = v;
        }
    }
    return out;
}

double misfit_db(const Resonators& r, std::span<const double> response) {
    std::vector<double> impulse(response.size(), 0.0);
    impulse.front() = 1;
    return 20 * std::log10(relative_difference(filtered(r, impulse), response));
}

}  // namespace jvari

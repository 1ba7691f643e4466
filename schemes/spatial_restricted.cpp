// The restricted form: modal recursion and synthesis at the reads alone.
#include <Eigen/Core>

#include "schemes/spatial_forms.hpp"

namespace jvari {

namespace {
using In = Eigen::Map<const Eigen::VectorXd>;
using Out = Eigen::Map<Eigen::VectorXd>;
}  // namespace

RestrictedForm::RestrictedForm(const LinearUpdate& update) : update_(update) {
    levels.displacement.resize(update_.modes());
    levels.increment.resize(update_.modes());
}

void RestrictedForm::start(const double* y, const double* free_increment) {
    levels.displacement.assign(y, y + update_.modes());
    levels.increment.assign(free_increment, free_increment + update_.modes());
}

void RestrictedForm::read(double* free) const {
    for (int z = 0; z < update_.reads; ++z)
        free[z] = dot(update_.ports[z].weights, levels.displacement) + dot(update_.ports[z].weights, levels.increment);
}

void RestrictedForm::advance(const double* force, double* free) {
    const int n = update_.modes();
    Out y(levels.displacement.data(), n), d(levels.increment.data(), n);
    for (std::size_t z = 0; z < update_.ports.size(); ++z)
        if (force[z] != 0) d += update_.gain * force[z] * In(update_.ports[z].weights.data(), n);
    y += d;
    d = In(update_.Ct.data(), n).cwiseProduct(d) - In(update_.kappa.data(), n).cwiseProduct(y);
    read(free);
}

void RestrictedForm::to_modal(const std::vector<double>& level, double* modal) const {
    std::copy(level.begin(), level.end(), modal);
}
std::vector<double> RestrictedForm::reading(const std::vector<double>& modal_weights) const {
    return modal_weights;
}

}  // namespace jvari

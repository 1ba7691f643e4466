#include "schemes/grid/grid_scheme.hpp"

namespace jvari {

std::vector<Fact> grid_facts(const GridString& g, const ObstacleStep& obstacle) {
    std::vector<Fact> f = {{"grid_intervals", static_cast<double>(g.grid.intervals), ""},
                           {"loss_fit_sigma0", g.loss.sigma0, "1/s"},
                           {"loss_fit_sigma1", g.loss.sigma1, "m^2/s"},
                           {"loss_fit_sigma2", g.loss.sigma2, "m^4/s"},
                           {"loss_fit_misfit", g.loss.misfit, ""}};
    if (g.narrowest > 0) f.push_back({"narrowest_contact", g.narrowest, "cells"});
    if (obstacle.contacts() > 0) {
        const ObstacleStep::Tally& t = obstacle.tally();
        f.push_back({"smallest_contact_force", t.smallest_force, "N"});
        f.push_back({"deepest_penetration", t.deepest, "m"});
        f.push_back({"contact_points", static_cast<double>(obstacle.contacts()), ""});
        if (obstacle.coupled() > 1) f.push_back({"coupled_contact_points", static_cast<double>(obstacle.coupled()), ""});
        f.push_back({"contact_iterations_mean", t.solves > 0 ? t.iterations / static_cast<double>(t.solves) : 0, ""});
        f.push_back({"contact_iterations_most", static_cast<double>(t.most_iterations), ""});
        f.push_back({"contact_residual", t.residual, ""});
        if (g.compliance > 0) f.push_back({"static_compliance", g.compliance, ""});
    }
    return f;
}

}  // namespace jvari

#include "schemes/grid/grid_scheme.hpp"

namespace jvari {

std::vector<double> compliances(const std::vector<Stencil>& places, const std::vector<Stencil>& responses, double gain, const Grid& grid) {
    const std::size_t all = places.size();
    std::vector<double> theta(all * all), line(grid.intervals + 1);
    for (std::size_t b = 0; b < all; ++b) {
        std::fill(line.begin(), line.end(), 0.0);
        responses[b].add(gain, line.data());
        for (std::size_t a = 0; a < all; ++a) theta[a * all + b] = places[a].read(line.data());
    }
    for (std::size_t a = 0; a < all; ++a)
        for (std::size_t b = 0; b < a; ++b) theta[a * all + b] = theta[b * all + a];
    return theta;
}

std::vector<Fact> grid_facts(const GridString& g, const ObstacleStep& obstacle) {
    std::vector<Fact> f = {{facts::grid_intervals, static_cast<double>(g.grid.intervals)},
                           {facts::loss_fit_sigma0, g.loss.sigma0},
                           {facts::loss_fit_sigma1, g.loss.sigma1},
                           {facts::loss_fit_sigma2, g.loss.sigma2},
                           {facts::loss_fit_misfit, g.loss.misfit}};
    if (g.narrowest > 0) f.push_back({facts::narrowest_contact, g.narrowest});
    if (obstacle.contacts() > 0) {
        const ObstacleStep::Tally& t = obstacle.tally();
        f.push_back({facts::smallest_contact_force, t.force.least});
        f.push_back({facts::largest_contact_force, t.force.most});
        f.push_back({facts::deepest_penetration, t.deepest});
        f.push_back({facts::contact_points, static_cast<double>(obstacle.contacts())});
        if (obstacle.coupled() > 1) f.push_back({facts::coupled_contact_points, static_cast<double>(obstacle.coupled())});
        f.push_back({facts::contact_iterations_mean, t.solves > 0 ? t.iterations / static_cast<double>(t.solves) : 0});
        f.push_back({facts::contact_iterations_most, static_cast<double>(t.most_iterations)});
        f.push_back({facts::contact_residual, t.residual});
        if (g.compliance > 0) f.push_back({facts::static_compliance, g.compliance});
        if (g.series) f.push_back({facts::series_compliance, g.series->C[0]});
        if (g.series) f.push_back({facts::compliance_excess, g.series->excess});
    }
    return f;
}

}  // namespace jvari

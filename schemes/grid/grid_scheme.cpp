#include "schemes/grid/grid_scheme.hpp"

namespace jvari {

std::vector<double> compliances(const std::vector<Stencil>& places,
                                const std::vector<Stencil>& responses, double gain,
                                const Grid& grid) {
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

std::vector<Fact> grid_facts(const GridString& g) {
    std::vector<Fact> f = {{facts::grid_intervals, static_cast<double>(g.grid.intervals)},
                           {facts::loss_fit_sigma0, g.loss.sigma0},
                           {facts::loss_fit_sigma1, g.loss.sigma1},
                           {facts::loss_fit_sigma2, g.loss.sigma2},
                           {facts::loss_fit_misfit, g.loss.misfit}};
    if (g.narrowest > 0) f.push_back({facts::narrowest_contact, g.narrowest});
    if (g.compliance > 0 && !g.on_body) f.push_back({facts::static_compliance, g.compliance});
    return f;
}

}  // namespace jvari

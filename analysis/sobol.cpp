// Left out: scrambling of digits. A study with some hundred points does not need scrambling.
#include "analysis/sobol.hpp"

#include <gsl/gsl_qrng.h>

#include <cmath>
#include <memory>
#include <random>

namespace jvari {

std::vector<std::vector<double>> sobol_points(int dimensions, int number, std::uint64_t seed) {
    std::vector<std::vector<double>> points(static_cast<std::size_t>(number));
    if (dimensions == 0) return points;
    const std::unique_ptr<gsl_qrng, void (*)(gsl_qrng*)> sequence(
        gsl_qrng_alloc(gsl_qrng_sobol, static_cast<unsigned>(dimensions)), gsl_qrng_free);
    std::mt19937_64 random(seed);  // the standard defines its numbers, equal on every machine
    std::vector<double> shift;
    for (int d = 0; d < dimensions; ++d) shift.push_back(std::ldexp(random() >> 11, -53));
    for (auto& point : points) {
        point.resize(shift.size());
        gsl_qrng_get(sequence.get(), point.data());
        for (std::size_t d = 0; d < shift.size(); ++d) {
            point[d] += shift[d];
            point[d] -= std::floor(point[d]);
        }
    }
    return points;
}

}  // namespace jvari

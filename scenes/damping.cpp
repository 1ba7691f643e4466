// Sources: van Walstijn et al. 2016 eq 18; Issanchou et al. 2016 eq 12; Deshmukh &
// Rayavarapu (decay factor per period).
#include "scenes/damping.hpp"

#include <cmath>
#include <numbers>

#include "scenes/columns.hpp"
#include "scenes/scene_file.hpp"
#include "scenes/wording.hpp"

namespace jvari {

using std::numbers::pi;

double decay_rate(const PolynomialDamping& law, double beta) {
    return law.sigma0 + (law.sigma1 + law.sigma3 * beta * beta) * beta;
}

double decay_rate(const QualityFactorDamping& law, const String& s, double nu) {
    const double R =
        2 * pi * law.air_viscosity +
        2 * pi * law.diameter * std::sqrt(pi * law.air_viscosity * law.air_density * nu);
    const double air = R / (2 * pi * s.linear_density * nu);
    const double viscoelastic = 4 * pi * pi * s.linear_density * s.bending_stiffness *
                                law.viscoelastic_angle * nu * nu / (s.tension * s.tension);
    return pi * nu * (air + viscoelastic + law.thermoelastic_loss);  // sigma = pi nu/Q  (12)
}

double decay_rate(const PerPeriodDamping& law, double f1) { return -f1 * std::log(law.factor); }

// ---- Measured modes, from a file.

namespace {
[[noreturn]] void refuse_row(const std::string& path, int line, const std::string& what) {
    throw SceneFileError(path + ":" + std::to_string(line) + ": " + what);
}

// Rows without numbers list the modes one by one. A missing mode doubles one frequency spacing
// relative to the spacing before, or to the first one.
void refuse_gaps(const std::string& path, const std::vector<int>& lines,
                 const std::vector<double>& hertz) {
    constexpr double wide = 1.6;
    const auto spacing = [&](std::size_t k) { return hertz[k] - (k > 0 ? hertz[k - 1] : 0); };
    for (std::size_t k = 1; k < hertz.size(); ++k) {
        const double now = spacing(k), before = spacing(k - 1);
        if (now > wide * before || (k == 1 && now > 0 && wide * now < before))
            refuse_row(
                path, lines[k],
                "frequency_hz: found " + number_text(hertz[k]) + " after " +
                    number_text(hertz[k - 1]) + " and " +
                    (k > 1 ? number_text(hertz[k - 2]) : "0") +
                    ", expected one row for each mode. Is one missing? A column \"mode\" with "
                    "the number of each row's mode says which");
    }
}
}  // namespace

void modes_from(const std::string& path, const std::string& text, const Column& frequency,
                const Column& decay, TableDamping& t) {
    std::vector<double> number, hertz, sigma;
    const ColumnTo columns[] = {
        {frequency, &hertz}, {decay, &sigma}, {{"mode", "mode", mode_number}, &number, true}};
    const std::vector<int> lines = read_columns(path, text, columns);
    if (number.empty()) {
        refuse_gaps(path, lines, hertz);
        t.frequency_hz = hertz;
        t.decay_rate = sigma;
        return;
    }
    for (std::size_t k = 0; k < number.size(); ++k) {
        const double before = k > 0 ? number[k - 1] : 0, m = number[k];
        if (m != std::floor(m) || !(m > before) || (k == 0 && m != 1))
            refuse_row(
                path, lines[k],
                "mode: found " + number_text(m) +
                    (k > 0 ? " after " + number_text(before) + ", expected a higher whole number"
                           : " in the first row, expected 1: the pitch is that of mode 1"));
        const auto squared = [&](std::size_t row) { return std::pow(hertz[row] / number[row], 2); };
        for (double i = before + 1; i < m; ++i) {
            const double bend = (i * i - before * before) / (m * m - before * before),
                         share = (i - before) / (m - before);
            t.filled.push_back(static_cast<int>(i));
            t.frequency_hz.push_back(
                i * std::sqrt(squared(k - 1) + bend * (squared(k) - squared(k - 1))));
            t.decay_rate.push_back(sigma[k - 1] + share * (sigma[k] - sigma[k - 1]));
        }
        t.frequency_hz.push_back(hertz[k]);
        t.decay_rate.push_back(sigma[k]);
    }
}

}  // namespace jvari

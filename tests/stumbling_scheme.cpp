// A plugin for the tests of the command line: taps swing like cos(2 pi 100 t) exp(-3 t) (1 +
// 1/rate), so that the error is first order in the rate; option `fail_at` [s] makes the run diverge
// there. It refuses rates above 150 kHz, and has no thread.
#include <cmath>
#include <numbers>

#include "schemes/making.hpp"
#include "schemes/plugin.hpp"

namespace {
using namespace jvari;
constexpr Option fail_at_option{"fail_at", "1e9", "when the run diverges [s]"};
constexpr Option options[] = {fail_at_option};

class Stumbling final : public Scheme {
public:
    Stumbling(const Settings& s, int per_row)
        : settings_(s), per_row_(per_row), fail_at_(number_option(s, fail_at_option)) {}
    void reset() noexcept override { row_ = 0; }
    Status advance(const Block& out) noexcept override {
        for (int n = 0; n < out.rows; ++n, ++row_) {
            const double t = row_ / settings_.tap_rate, y = std::cos(200 * std::numbers::pi * t) *
                                                            std::exp(-3 * t) *
                                                            (1 + 100 / settings_.sample_rate);
            for (int k = 0; k < out.taps; ++k) out.tap[n + k * out.stride] = 1e-4 * (k + 1) * y;
            for (int k = 0; k < 3 && out.energy; ++k)
                out.energy[n + k * out.stride] = k == 0 ? 1 : 0;
            if (t >= fail_at_) return {Outcome::diverged, row_ * per_row_};
        }
        return {};
    }
    int dofs() const override { return 1; }
    std::vector<Fact> facts() const override {
        return {{facts::smallest_contact_force, -0.5}, {"stumbles", 1, ""}};
    }

private:
    Settings settings_;
    int per_row_;
    double fail_at_;
    long row_ = 0;
};

std::unique_ptr<Scheme> make(const Descriptor&, const Scene&, const Settings& settings) {
    if (settings.sample_rate > 150e3)
        throw Refusal("stumbling has no rates above 150 kHz, only walks");
    return std::make_unique<Stumbling>(settings, steps_per_row(settings));
}

constexpr Descriptor table[] = {{"stumbling", "none: made for a test",
                                 Feature::bending_stiffness | Feature::damping |
                                     Features(Feature::frequency_dependent_damping) |
                                     Features(Feature::initial_shape) | Features(Feature::pluck) |
                                     Features(Feature::lumped_barrier),
                                 Balance::exact, Clock::stepped, make, options}};
}  // namespace

JVARI_PLUGIN(table)

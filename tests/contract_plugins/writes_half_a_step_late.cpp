// From row 1 on its rows show the string half a step before their instants: an error of first order, which falls with the rate.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    Planted(const Scene& scene, const Settings& settings) : Honest(scene, settings), late_(0.5 / settings.sample_rate) {}

protected:
    void spoil(const Block& out, int n) noexcept override {
        for (int k = 0; row_ > 0 && k < out.taps; ++k) {
            const bool velocity = scene_.taps[k].quantity == Quantity::velocity;
            double sum = 0;
            for (std::size_t i = 0; i < y_.size(); ++i) {
                const double acceleration = -modes_.omega0[i] * modes_.omega0[i] * y_[i] - 2 * modes_.sigma[i] * v_[i];
                sum +=
                    weights_[k][i] * (velocity ? v_[i] - late_ * acceleration : y_[i] - late_ * v_[i] + 0.5 * late_ * late_ * acceleration);
            }
            out.tap[n + k * out.stride] = sum;
        }
    }

private:
    double late_;  // [s]
};
}  // namespace

JVARI_PLANTED(writes_half_a_step_late, Planted)

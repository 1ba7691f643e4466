// Below 30 kHz it stores more from its second row on than was ever there.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    Planted(const Scene& scene, const Settings& settings) : Honest(scene, settings), low_(settings.sample_rate < 30e3) {}

protected:
    void spoil(const Block& out, int n) noexcept override {
        if (!low_ || !out.energy || row_ == 0) return;
        out.energy[n] += 1e-3 * start_;
    }

private:
    bool low_;
};
}  // namespace

JVARI_PLANTED(gains_energy_at_a_low_rate, Planted)

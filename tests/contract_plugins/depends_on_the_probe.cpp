// Its output depends on whether its energy is asked for.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block& out, int n) noexcept override {
        for (int k = 0; row_ > 0 && out.energy && k < out.taps; ++k) out.tap[n + k * out.stride] *= 1 + 1e-12;
    }
};
}  // namespace

JVARI_PLANTED(depends_on_the_probe, Planted)

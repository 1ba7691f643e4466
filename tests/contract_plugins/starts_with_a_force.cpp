// It pulls at its nut before it has moved.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block& out, int n) noexcept override {
        for (int k = 0; row_ == 0 && k < out.taps; ++k)
            if (scene_.taps[k].quantity == Quantity::nut_force) out.tap[n + k * out.stride] += 1e-3;
    }
};
}  // namespace

JVARI_PLANTED(starts_with_a_force, Planted)

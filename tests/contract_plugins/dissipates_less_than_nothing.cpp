// A loss feeds energy in, although the ledger closes.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block& out, int n) noexcept override {
        if (!out.energy || row_ != 70) return;
        out.energy[n + out.stride] -= 1e-6 * start_ + out.energy[n + 2 * out.stride];
        out.energy[n + 2 * out.stride] = -1e-6 * start_;
    }
};
}  // namespace

JVARI_PLANTED(dissipates_less_than_nothing, Planted)

// Each row is right to less than rounding is allowed, and all err to the same side.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block& out, int n) noexcept override {
        if (out.energy && row_ > 0) out.energy[n + out.stride] += 0.8e-11 * start_;
    }
};
}  // namespace

JVARI_PLANTED(breaks_its_ledger_in_sum, Planted)

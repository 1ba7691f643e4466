// Energy comes from nowhere in one row and goes there in the next, so that the sum is right.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block& out, int n) noexcept override {
        if (out.energy && (row_ == 70 || row_ == 71)) out.energy[n + out.stride] += (row_ == 70 ? 5e-11 : -5e-11) * start_;
    }
};
}  // namespace

JVARI_PLANTED(breaks_its_ledger_in_a_row, Planted)

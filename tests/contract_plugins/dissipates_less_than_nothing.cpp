// A loss feeds energy in, although the ledger closes.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;
    Status advance(const Block& out) noexcept override {
        const long first = row_;
        const Status status = Honest::advance(out);
        for (int n = 0; n < out.rows; ++n) {
            const long row = first + n;
            if (!out.energy || row != 70) continue;
            out.energy[n + out.stride] -= 1e-6 * start_ + out.energy[n + 2 * out.stride];
            out.energy[n + 2 * out.stride] = -1e-6 * start_;
        }
        return status;
    }
};
}  // namespace

JVARI_PLANTED(dissipates_less_than_nothing, Planted)

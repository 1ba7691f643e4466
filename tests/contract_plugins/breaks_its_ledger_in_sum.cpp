// Each row is right to less than rounding is allowed, and all err to the same side.
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
            if (out.energy && row > 0) out.energy[n + out.stride] += 0.8e-11 * start_;
        }
        return status;
    }
};
}  // namespace

JVARI_PLANTED(breaks_its_ledger_in_sum, Planted)

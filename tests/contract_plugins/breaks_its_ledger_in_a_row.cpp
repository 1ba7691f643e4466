// Energy comes from nowhere in one row and goes there in the next, so that the sum is right.
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
            if (out.energy && (row == 70 || row == 71)) out.energy[n + out.stride] += (row == 70 ? 5e-11 : -5e-11) * start_;
        }
        return status;
    }
};
}  // namespace

JVARI_PLANTED(breaks_its_ledger_in_a_row, Planted)

// It pulls at its nut before it has moved.
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
            for (int k = 0; row == 0 && k < out.taps; ++k)
                if (scene_.taps[k].quantity == Quantity::nut_force) out.tap[n + k * out.stride] += 1e-3;
        }
        return status;
    }
};
}  // namespace

JVARI_PLANTED(starts_with_a_force, Planted)

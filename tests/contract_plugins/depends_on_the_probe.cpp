// Its output depends on whether its energy is asked for.
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
            for (int k = 0; row > 0 && out.energy && k < out.taps; ++k) out.tap[n + k * out.stride] *= 1 + 1e-12;
        }
        return status;
    }
};
}  // namespace

JVARI_PLANTED(depends_on_the_probe, Planted)

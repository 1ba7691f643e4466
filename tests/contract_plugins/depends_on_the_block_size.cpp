// Its output depends on how many rows are asked for at once: a row asked for alone is another.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block& out, int n) noexcept override {
        for (int k = 0; row_ > 0 && out.rows == 1 && k < out.taps; ++k) out.tap[n + k * out.stride] *= 1 + 1e-12;
    }
};
}  // namespace

JVARI_PLANTED(depends_on_the_block_size, Planted)

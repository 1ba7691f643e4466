// The honest scheme under its own name, a third slower: it sums its energy four times more in three
// rows. What `jvari diff` has to find on a real clock (tests/diff_on_the_clock.sh).
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block&, int) noexcept override {
        for (int k = 0; k < (row_ % 3 == 0 ? 2 : 1); ++k) {
            const volatile double sum = stored();
            (void)sum;
        }
    }
};
}  // namespace

JVARI_PLANTED(honest, Planted)

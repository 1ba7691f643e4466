// From row 150 on its first tap is no number.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block& out, int n) noexcept override {
        if (row_ >= 150 && out.taps > 0) out.tap[n] = std::nan("");
    }
};
}  // namespace

JVARI_PLANTED(gives_nan, Planted)

// The honest scheme under its own name, 2 % too loud: what `jvari diff` has to find.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;

protected:
    void spoil(const Block& out, int n) noexcept override {
        for (int k = 0; k < out.taps; ++k) out.tap[n + k * out.stride] *= 1.02;
    }
};
}  // namespace

JVARI_PLANTED(honest, Planted)

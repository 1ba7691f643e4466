// Its velocities outlive a reset.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;
    void reset() noexcept override {
        y_ = shape_;
        before_ = start_;
        row_ = 0;
    }
};
}  // namespace

JVARI_PLANTED(keeps_state_after_a_reset, Planted)

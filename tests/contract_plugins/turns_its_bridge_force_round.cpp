// It says of a bridge that pushes that it pulls.
#include "tests/contract_plugins/spoiled.hpp"

namespace {
using namespace jvari;

class Planted final : public Spoiled {
public:
    Planted(const Scene& scene, const Settings& settings) : Spoiled("modal_two_point", scene, settings) {}

protected:
    double factor(Quantity q) const noexcept override { return q == Quantity::bridge_force ? -1 : 1; }
};
}  // namespace

JVARI_SPOILED(turns_its_bridge_force_round, "modal_two_point", Planted)

// Its nut force is half of the string's.
#include "tests/contract_plugins/spoiled.hpp"

namespace {
using namespace jvari;

class Planted final : public Spoiled {
public:
    Planted(const Scene& scene, const Settings& settings) : Spoiled("modal_two_point", scene, settings) {}

protected:
    double factor(Quantity q) const noexcept override { return q == Quantity::nut_force ? 0.5 : 1; }
};
}  // namespace

JVARI_SPOILED(halves_its_nut_force, "modal_two_point", Planted)

// What drives the body has the sign of what moves the string.
#include "tests/contract_plugins/spoiled.hpp"

namespace {
using namespace jvari;

class Planted final : public Spoiled {
public:
    Planted(const Scene& scene, const Settings& settings) : Spoiled("modal_two_point", scene, settings) {}

protected:
    double factor(Quantity q) const noexcept override { return q == Quantity::driving_force ? -1 : 1; }
};
}  // namespace

JVARI_SPOILED(turns_its_driving_force_round, "modal_two_point", Planted)

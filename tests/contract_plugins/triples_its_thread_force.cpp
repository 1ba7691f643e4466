// Its thread force is three times what moves the string.
#include "tests/contract_plugins/spoiled.hpp"

namespace {
using namespace jvari;

class Planted final : public Spoiled {
public:
    Planted(const Scene& scene, const Settings& settings) : Spoiled("modal_two_point", scene, settings) {}

protected:
    double factor(Quantity q) const noexcept override { return q == Quantity::thread_force ? 3 : 1; }
};
}  // namespace

JVARI_SPOILED(triples_its_thread_force, "modal_two_point", Planted)

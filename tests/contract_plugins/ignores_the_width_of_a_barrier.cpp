// It takes a wide barrier for a point.
#include "tests/contract_plugins/spoiled.hpp"

namespace {
using namespace jvari;

Scene narrow(Scene scene) {
    String& s = scene.strings.front();
    for (Barrier& b : s.barriers)
        if (auto* lumped = std::get_if<LumpedBarrier>(&b)) lumped->width = 0;
    return scene;
}

class Planted final : public Spoiled {
public:
    Planted(const Scene& scene, const Settings& settings) : Spoiled("modal_two_point", narrow(scene), settings) {}
};
}  // namespace

JVARI_SPOILED(ignores_the_width_of_a_barrier, "modal_two_point", Planted)

// It takes a wide thread for a point.
#include "tests/contract_plugins/spoiled.hpp"

namespace {
using namespace jvari;

Scene narrow(Scene scene) {
    String& s = scene.strings.front();
    if (s.thread) s.thread->width = 0;
    return scene;
}

class Planted final : public Spoiled {
public:
    Planted(const Scene& scene, const Settings& settings) : Spoiled("modal_two_point", narrow(scene), settings) {}
};
}  // namespace

JVARI_SPOILED(ignores_the_width_of_a_thread, "modal_two_point", Planted)

// It declares bending stiffness, and steps the string as if it had none.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

Scene limp(Scene scene) {
    scene.strings.front().bending_stiffness = 0;
    return scene;
}

class Planted final : public Honest {
public:
    Planted(const Scene& scene, const Settings& settings) : Honest(limp(scene), settings) {}
};
}  // namespace

JVARI_PLANTED(ignores_a_feature, Planted)

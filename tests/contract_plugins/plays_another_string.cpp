// It plays a string under 1 % more tension, and keeps that string's ledger.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

Scene tighter(Scene scene) {
    scene.strings.front().tension *= 1.01;
    return scene;
}

class Planted final : public Honest {
public:
    Planted(const Scene& scene, const Settings& settings) : Honest(tighter(scene), settings) {}
};
}  // namespace

JVARI_PLANTED(plays_another_string, Planted)

// It declares features, and refuses each scene in a whole sentence.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    Planted(const Scene& scene, const Settings& settings) : Honest(scene, settings) {
        throw Refusal("scene " + scene.name + " is not to the taste of this scheme");
    }
};
}  // namespace

JVARI_PLANTED(refuses_every_scene, Planted)

// A known-bad control under another name: its contacts pull, and no excuse has this name.
#include "tests/contract_plugins/spoiled.hpp"

namespace {
using namespace jvari;

class Planted final : public Spoiled {
public:
    Planted(const Scene& scene, const Settings& settings) : Spoiled("modal_quadratised_two_point_raw", scene, settings) {}
};
}  // namespace

JVARI_SPOILED(pulls, "modal_quadratised_two_point_raw", Planted)

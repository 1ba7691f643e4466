// It starts from the mirror image of the scene's shape.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    Planted(const Scene& scene, const Settings& settings) : Honest(scene, settings) {
        for (std::size_t i = 1; i < shape_.size(); i += 2) shape_[i] = -shape_[i];
        reset();
    }
};
}  // namespace

JVARI_PLANTED(starts_from_another_shape, Planted)

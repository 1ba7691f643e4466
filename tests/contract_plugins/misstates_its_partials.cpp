// It steps the true modes, and says of itself that they are a hundredth of a semitone flat.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;
    std::vector<FreeMode> free_modes() const override {
        std::vector<FreeMode> modes;
        for (int i = 0; i < modes_.count(); ++i)
            modes.push_back({std::sqrt(omega_squared_damped(modes_.omega0[i], modes_.sigma[i])) * std::exp2(-0.01 / 12), modes_.sigma[i]});
        return modes;
    }
};
}  // namespace

JVARI_PLANTED(misstates_its_partials, Planted)

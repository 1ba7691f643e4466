// It steps a second plane of motion that no scene here has.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    Planted(const Scene& scene, const Settings& settings) : Honest(scene, settings), other_(scene, settings) {}
    void reset() noexcept override {
        Honest::reset();
        other_.reset();
    }
    Status advance(const Block& out) noexcept override {
        other_.advance(out);
        return Honest::advance(out);
    }
    int dofs() const override { return Honest::dofs() + other_.dofs(); }

private:
    Honest other_;
};
}  // namespace

JVARI_PLANTED(carries_double_state, Planted)

// It takes memory for each block.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;
    Status advance(const Block& out) noexcept override {
        scratch_ = std::make_unique<double[]>(static_cast<std::size_t>(out.rows));
        return Honest::advance(out);
    }

private:
    std::unique_ptr<double[]> scratch_;
};
}  // namespace

JVARI_PLANTED(allocates_while_stepping, Planted)

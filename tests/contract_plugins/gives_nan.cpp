// From row 150 on its first tap is no number.
#include "tests/contract_plugins/honest.hpp"

namespace {
using namespace jvari;

class Planted final : public Honest {
public:
    using Honest::Honest;
    Status advance(const Block& out) noexcept override {
        const long first = row_;
        const Status status = Honest::advance(out);
        for (int n = 0; n < out.rows; ++n) {
            const long row = first + n;
            if (row >= 150 && out.taps > 0) out.tap[n] = std::nan("");
        }
        return status;
    }
};
}  // namespace

JVARI_PLANTED(gives_nan, Planted)

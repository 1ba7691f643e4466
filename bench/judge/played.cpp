#include "bench/judge/played.hpp"

#include <limits>

namespace jvari::bench::judge {

namespace {
class Played final : public Scheme {
public:
    explicit Played(std::shared_ptr<const Trace> trace) : trace_(std::move(trace)) {}
    void reset() noexcept override { row_ = 0; }
    Status advance(const Block& out) noexcept override {
        for (int n = 0; n < out.rows; ++n, ++row_) {
            const bool there = row_ < trace_->rows;
            for (int k = 0; k < out.taps; ++k)
                out.tap[n + k * out.stride] = there ? trace_->tap[row_ + k * trace_->stride] : std::numeric_limits<double>::quiet_NaN();
            if (!out.energy) continue;
            const bool told = there && !trace_->energy.empty();
            for (int k = 0; k < 3; ++k) out.energy[n + k * out.stride] = told ? trace_->energy[row_ + k * trace_->stride] : 0;
        }
        return {};
    }
    int dofs() const override { return 0; }

private:
    std::shared_ptr<const Trace> trace_;
    long row_ = 0;
};
}  // namespace

std::unique_ptr<Scheme> played(std::shared_ptr<const Trace> trace) {
    return std::make_unique<Played>(std::move(trace));
}

}  // namespace jvari::bench::judge

// Plans of FFTW are estimated, not measured: the same signal gives the same bits in each run.
#include "analysis/squared_transform.hpp"

#include <fftw3.h>

#include <mutex>

namespace jvari {

namespace {
std::mutex planner;  // FFTW plans one at a time; transforms may run side by side
// and other files plan too, under a lock of their own: FFTW is told before main() to lock for
// itself
[[maybe_unused]] const bool locked_for_all = (fftw_make_planner_thread_safe(), true);

struct Free {
    void operator()(void* p) const { fftw_free(p); }
};
}  // namespace

struct SquaredTransform::State {
    explicit State(int rows) : n(rows), in(fftw_alloc_real(n)), out(fftw_alloc_complex(n / 2 + 1)) {
        const std::lock_guard lock(planner);
        plan = fftw_plan_dft_r2c_1d(n, in.get(), out.get(), FFTW_ESTIMATE);
    }
    ~State() {
        const std::lock_guard lock(planner);
        fftw_destroy_plan(plan);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    int n;
    std::unique_ptr<double, Free> in;
    std::unique_ptr<fftw_complex, Free> out;
    fftw_plan plan = nullptr;
};

SquaredTransform::SquaredTransform(int rows) : state_(std::make_unique<State>(rows)) {}
SquaredTransform::~SquaredTransform() = default;

std::span<double> SquaredTransform::rows() {
    return {state_->in.get(), static_cast<std::size_t>(state_->n)};
}

void SquaredTransform::write(double* power) {
    fftw_execute(state_->plan);
    for (int k = 0; k <= state_->n / 2; ++k) {
        const double re = state_->out.get()[k][0], im = state_->out.get()[k][1];
        power[k] = re * re + im * im;
    }
}

}  // namespace jvari

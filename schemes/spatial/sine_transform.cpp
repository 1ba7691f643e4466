// The only file of this folder that sees FFTW.
#include "schemes/spatial/sine_transform.hpp"

#include <fftw3.h>

#include <mutex>

namespace jvari {

namespace {
std::mutex planner;  // FFTW's planner is not reentrant
// and other files plan too, under a lock of their own: FFTW is told before main() to lock for itself
[[maybe_unused]] const bool locked_for_all = (fftw_make_planner_thread_safe(), true);
}  // namespace

// FFTW_ESTIMATE: the plan, and so every rounding, is the same in each run. The vector does not move: the object is not copied.
SineTransform::SineTransform(int intervals) : buffer(intervals - 1, 0.0) {
    const std::lock_guard lock(planner);
    plan_ = fftw_plan_r2r_1d(intervals - 1, buffer.data(), buffer.data(), FFTW_RODFT00, FFTW_ESTIMATE | FFTW_UNALIGNED);
}

SineTransform::~SineTransform() {
    const std::lock_guard lock(planner);
    fftw_destroy_plan(static_cast<fftw_plan>(plan_));
}

void SineTransform::operator()() noexcept {
    fftw_execute(static_cast<fftw_plan>(plan_));
    for (double& x : buffer) x *= 0.5;  // FFTW: 2 sum in_j sin
}

}  // namespace jvari

#include "bench/store/system/time_limit.hpp"

#include <fmt/core.h>

#include <ctime>
#include <utility>

namespace jvari::bench::store {

namespace {
thread_local double waited = 0;  // [s], for programs that have ended
thread_local const WaitsForAnother* waits = nullptr;
}  // namespace

WaitsForAnother::WaitsForAnother() { waits = this; }
WaitsForAnother::~WaitsForAnother() {
    waited += seconds();
    waits = nullptr;
}
double WaitsForAnother::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec) + waited +
           (waits ? waits->seconds() : 0);
}

std::function<void(long, long)> within(double seconds, std::function<void(long, long)> progress) {
    return [seconds, start = processor_seconds(), progress = std::move(progress)](long done,
                                                                                  long rows) {
        progress(done, rows);
        if (processor_seconds() - start > seconds)
            throw PastItsLimit(fmt::format("past its time limit of {} s", seconds));
    };
}

}  // namespace jvari::bench::store

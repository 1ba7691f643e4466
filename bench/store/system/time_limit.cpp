#include "bench/store/system/time_limit.hpp"

#include <fmt/core.h>

#include <ctime>
#include <utility>

namespace jvari::bench::store {

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::function<void(long, long)> within(double seconds, std::function<void(long, long)> progress) {
    return [seconds, start = processor_seconds(), progress = std::move(progress)](long done, long rows) {
        progress(done, rows);
        if (processor_seconds() - start > seconds) throw PastItsLimit(fmt::format("past its time limit of {} s", seconds));
    };
}

}  // namespace jvari::bench::store

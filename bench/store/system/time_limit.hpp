// A limit of a run's own processor time, which does not depend on what else the machine does. Of a
// program that a run waits for (program.hpp) it is the time on the clock.
#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>

namespace jvari::bench::store {

struct PastItsLimit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

double processor_seconds();  // that this thread has computed, and has waited for other programs

class WaitsForAnother {  // one at a time on a thread: its life counts as computing
public:
    WaitsForAnother();
    ~WaitsForAnother();
    WaitsForAnother(const WaitsForAnother&) = delete;
    WaitsForAnother& operator=(const WaitsForAnother&) = delete;
    double seconds() const;

private:
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// `progress`, which throws PastItsLimit once this thread has computed `seconds` more. To be called
// on the thread that it was made on.
std::function<void(long done, long rows)> within(
    double seconds, std::function<void(long done, long rows)> progress);

}  // namespace jvari::bench::store

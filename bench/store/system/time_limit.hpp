// A limit of a run's own processor time, which does not depend on what else the machine does.
#pragma once

#include <functional>
#include <stdexcept>

namespace jvari::bench::store {

struct PastItsLimit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

double processor_seconds();  // that this thread has computed

// `progress`, which throws PastItsLimit once this thread has computed `seconds` more. To be called on the thread that it was made on.
std::function<void(long done, long rows)> within(double seconds, std::function<void(long done, long rows)> progress);

}  // namespace jvari::bench::store

// Independent tasks side by side on a few threads, with one progress line for all of them.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "bench/store/system/listener.hpp"

namespace jvari::bench::store {

struct Cancelled {};  // no std::exception: a task that is no longer wanted has not failed

class Done {  // how much of a task is done, from 0 to 1
public:
    void operator=(double part);  // throws Cancelled
    operator double() const { return part_.load(std::memory_order_relaxed); }
    // The task is begun again after all others, and may then wait for what another process has.
    void postpone() { postponed_ = true; }
    bool may_wait() const { return postponed_; }

private:
    friend class Pool;
    friend class Wait;
    friend void throw_if_cancelled();
    std::atomic<double> part_ = 0;
    const std::atomic<bool>* cancelled_ = nullptr;
    bool postponed_ = false;
    mutable std::mutex mutex_;
    std::optional<std::string> waits_for_;  // "": another thread of this process
};

// work(i, done) for each i below sizes.size(), begun in this order, on `jobs` threads (0: as many
// as there are cores). `sizes`: how long each is expected to take, in any unit, for the progress
// line alone. `name`, where there is one, lets the line say which took longest.
//
// After an exception no further task is begun, and of several exceptions that of the lowest i is
// rethrown, as if the tasks had run one by one. An exception of the listener cancels all tasks.
// A call from within a task runs on the thread of that task, shows nothing, and is cancelled with
// it.
void side_by_side(const std::vector<double>& sizes, int jobs, const Listener&,
                  const std::string& label, const std::function<void(std::size_t i, Done&)>& work,
                  const std::function<std::string(std::size_t i)>& name = {});

int threads_of(int jobs);  // 0: as many as there are cores

void throw_if_cancelled();  // if the task of this thread is no longer wanted

// While one lives this thread waits. Where every task that was begun does, the progress line says
// for which process, and after two seconds a note does.
class Wait {
public:
    Wait();  // for another thread of this process
    ~Wait();
    Wait(const Wait&) = delete;
    Wait& operator=(const Wait&) = delete;
    // for "process 1234 on node7, which runs free_string: modal_two_point"; throws Cancelled
    static void sleep(std::chrono::milliseconds, const std::string& who);
};

}  // namespace jvari::bench::store

// Runs independent tasks in parallel on a few threads, with one progress line for all tasks.
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

struct Cancelled {};  // not a std::exception: an unwanted task has not failed

class Done {  // finished fraction of a task, from 0 to 1
public:
    void operator=(double part);  // throws Cancelled
    operator double() const { return part_.load(std::memory_order_relaxed); }
    // Restarts the task after all others; the task may then wait for another process.
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
    std::optional<std::string> waits_for_;  // "": waits for another thread of this process
};

// Runs work(i, done) for each i below sizes.size(), started in this order, on `jobs` threads (0:
// one per core). `sizes`: the expected durations in any unit, used only for the progress line.
// `name`, if given, names the slowest task in this line.
//
// After an exception no further task starts. The exception with the lowest i is rethrown, like in a
// sequential run. An exception from the listener cancels all tasks. A call from within a task runs
// on the task's thread, shows nothing, and is cancelled together with the task.
void side_by_side(const std::vector<double>& sizes, int jobs, const Listener&,
                  const std::string& label, const std::function<void(std::size_t i, Done&)>& work,
                  const std::function<std::string(std::size_t i)>& name = {});

int threads_of(int jobs);  // 0: one per core

void throw_if_cancelled();  // tests the task of this thread

// Marks this thread waiting. If every started task waits, the progress line names the awaited
// process, and after two seconds a note does.
class Wait {
public:
    Wait();  // waits for another thread of this process
    ~Wait();
    Wait(const Wait&) = delete;
    Wait& operator=(const Wait&) = delete;
    // Waits for a process described as "process 1234 on node7, which runs free_string:
    // modal_two_point"; throws Cancelled.
    static void sleep(std::chrono::milliseconds, const std::string& who);
};

}  // namespace jvari::bench::store

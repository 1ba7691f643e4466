// Handles Ctrl-C and similar signals (SIGINT, SIGTERM, SIGHUP). A file in progress is finished and
// no further file is begun; then the registered functions run. The program ends by the same signal,
// so its caller sees the reason. A second signal ends the program at once.
#pragma once

#include <chrono>
#include <cmath>
#include <functional>
#include <list>
#include <stdexcept>

namespace jvari::bench::store {

// Called once, before any other thread starts. Blocks these signals in this thread, and so in all
// later threads, and waits for them in a thread of its own. A signal that the caller has set to be
// ignored (nohup, a script's job in the background) stays ignored.
void heed_interruptions();

// Delays interruptions during its lifetime. After an interruption, the end or the start of any
// Undisturbed blocks until the program ends. Instances must not be nested.
class Undisturbed {
public:
    Undisturbed();
    ~Undisturbed();
    Undisturbed(const Undisturbed&) = delete;
    Undisturbed& operator=(const Undisturbed&) = delete;
};

// Registers a function that an interruption calls on another thread, the newest first. The function
// may write to a terminal, but not to a file.
class WhenInterrupted {
public:
    explicit WhenInterrupted(std::function<void()>);
    ~WhenInterrupted();
    WhenInterrupted(const WhenInterrupted&) = delete;
    WhenInterrupted& operator=(const WhenInterrupted&) = delete;

private:
    std::list<std::function<void()>>::iterator place_;
};

// ---- Limits a run's own processor time, which does not depend on other programs. While a run
// waits for another program (program.hpp), elapsed time counts instead.

struct PastItsLimit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

double processor_seconds();  // this thread's computing time, plus its waits for other programs [s]

class WaitsForAnother {  // lifetime counts as computing; at most one per thread
public:
    WaitsForAnother();
    ~WaitsForAnother();
    WaitsForAnother(const WaitsForAnother&) = delete;
    WaitsForAnother& operator=(const WaitsForAnother&) = delete;
    double seconds() const;

private:
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Wraps `progress` and throws PastItsLimit once this thread has computed for `seconds` more. After
// `judged_after` more seconds of computing, it also throws if the run would take longer than
// `seconds` at its present pace. Must be called on the thread that created it.
std::function<void(long done, long rows)> within(double seconds,
                                                 std::function<void(long done, long rows)> progress,
                                                 double judged_after = HUGE_VAL);

}  // namespace jvari::bench::store

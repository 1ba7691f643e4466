// Ctrl-C and its like (SIGINT, SIGTERM, SIGHUP): a file that is being written is finished and no
// further one is begun, last words are said, and the program ends by that same signal, so that its
// caller sees why. A second one ends it where it stands.
#pragma once

#include <chrono>
#include <cmath>
#include <functional>
#include <list>
#include <stdexcept>

namespace jvari::bench::store {

// Once, before there is any other thread: blocks these signals in this thread and so in all to
// come, and waits for them in one of its own. A signal that the caller has set to be ignored
// (nohup, a script's job in the background) stays ignored.
void heed_interruptions();

// While one lives an interruption waits. Once there is one, whoever ends an Undisturbed or would
// begin one waits for the program's end. Never one within another.
class Undisturbed {
public:
    Undisturbed();
    ~Undisturbed();
    Undisturbed(const Undisturbed&) = delete;
    Undisturbed& operator=(const Undisturbed&) = delete;
};

// Called by an interruption within its life, on another thread, the newest first. It may write to a
// terminal, not to a file.
class WhenInterrupted {
public:
    explicit WhenInterrupted(std::function<void()>);
    ~WhenInterrupted();
    WhenInterrupted(const WhenInterrupted&) = delete;
    WhenInterrupted& operator=(const WhenInterrupted&) = delete;

private:
    std::list<std::function<void()>>::iterator place_;
};

// ---- A limit of a run's own processor time, which does not depend on what else the machine does.
// Of a program that a run waits for (program.hpp) it is the time on the clock.

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

// `progress`, which throws PastItsLimit once this thread has computed `seconds` more; or, once it
// has computed `judged_after` more, where at this pace its end would take longer than `seconds`. To
// be called on the thread that it was made on.
std::function<void(long done, long rows)> within(double seconds,
                                                 std::function<void(long done, long rows)> progress,
                                                 double judged_after = HUGE_VAL);

}  // namespace jvari::bench::store

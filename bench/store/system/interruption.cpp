#include "bench/store/system/interruption.hpp"

#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <condition_variable>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace jvari::bench::store {

namespace {
struct Heeded {
    std::mutex mutex;  // guards the members below
    std::condition_variable changed;
    int undisturbed = 0;
    bool ending = false;
    std::list<std::function<void()>> last_words;  // newest first
};
Heeded& heeded() {
    // Never destroyed, because an interruption may still arrive after the end of main.
    static Heeded& h = *new Heeded;
    return h;
}

[[noreturn]] void end_by(int signal, const sigset_t& signals) {
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);  // a second signal has its default effect
    Heeded& h = heeded();
    std::unique_lock lock(h.mutex);
    h.ending = true;
    h.changed.wait(lock, [&h] { return h.undisturbed == 0; });
    for (const auto& word : h.last_words) try {
            word();
        } catch (const std::exception&) {  // ignored: the program ends in any case
        }
    raise(signal);
    _exit(128 + signal);  // signals do not end the first process of a container
}
}  // namespace

void heed_interruptions() {
    heeded();
    sigset_t signals;
    sigemptyset(&signals);
    for (const int s : {SIGINT, SIGTERM, SIGHUP})
        if (struct sigaction set{}; sigaction(s, nullptr, &set) == 0 && set.sa_handler != SIG_IGN)
            sigaddset(&signals, s);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([signals] {
        int signal = 0;
        if (sigwait(&signals, &signal) == 0) end_by(signal, signals);
    }).detach();
}

Undisturbed::Undisturbed() {
    Heeded& h = heeded();
    std::unique_lock lock(h.mutex);
    h.changed.wait(lock, [&h] { return !h.ending; });
    ++h.undisturbed;
}

Undisturbed::~Undisturbed() {
    Heeded& h = heeded();
    std::unique_lock lock(h.mutex);
    if (--h.undisturbed == 0) h.changed.notify_all();
    h.changed.wait(lock, [&h] { return !h.ending; });  // never returns
}

WhenInterrupted::WhenInterrupted(std::function<void()> word) {
    const std::lock_guard lock(heeded().mutex);
    place_ = heeded().last_words.insert(heeded().last_words.begin(), std::move(word));
}

WhenInterrupted::~WhenInterrupted() {
    const std::lock_guard lock(heeded().mutex);
    heeded().last_words.erase(place_);
}

namespace {
thread_local double waited = 0;  // [s] waited for programs that have ended
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

std::function<void(long, long)> within(double seconds, std::function<void(long, long)> progress,
                                       double judged_after) {
    return [=, start = processor_seconds(), progress = std::move(progress)](long done, long rows) {
        progress(done, rows);
        const double spent = processor_seconds() - start;
        if (spent > seconds)
            throw PastItsLimit(fmt::format("past its time limit of {} s", seconds));
        if (spent > judged_after &&
            spent * static_cast<double>(rows) > seconds * static_cast<double>(done))
            throw PastItsLimit(
                fmt::format("after {:.0f} s of computing it has {} of {} rows, and "
                            "would take more than {:.0f} s",
                            spent, done, rows, seconds));
    };
}

}  // namespace jvari::bench::store

#include "bench/store/system/side_by_side.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <thread>
#include <utility>

namespace jvari::bench::store {

using namespace std::chrono_literals;

namespace {
thread_local Done* own_task = nullptr;  // task on this thread
}

class Pool {
    using Clock = std::chrono::steady_clock;

public:
    Pool(const std::vector<double>& sizes, const Listener& listener,
         const std::function<void(std::size_t, Done&)>& work,
         const std::function<std::string(std::size_t)>& name)
        : sizes_(sizes),
          listener_(listener),
          work_(work),
          name_(name),
          done_(sizes.size()),
          seconds_(sizes.size()) {
        for (Done& d : done_) d.cancelled_ = own_task ? own_task->cancelled_ : &cancelled_;
    }

    void run_here() {
        for (std::size_t i = 0; i < count(); ++i) work_(i, done_[i]);
    }

    void run(int threads, Progress& progress) {
        std::vector<std::jthread> workers;
        for (std::size_t k = 0; k < std::min<std::size_t>(threads, count()); ++k)
            workers.emplace_back([this] { work(); });
        std::unique_lock lock(mutex_);
        while (finished_ < count() && !failure_) {
            changed_.wait_for(lock, 250ms);
            try {
                show(progress);
            } catch (...) {
                cancelled_ = ended_ = true;
                throw;
            }
        }
    }
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    std::size_t count() const { return sizes_.size(); }
    double now() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    std::optional<std::size_t> next() {
        const std::lock_guard lock(mutex_);
        if (ended_) return {};
        if (next_ < count()) return ++under_way_, next_++;
        if (postponed_.empty()) return {};
        const std::size_t i = postponed_.front();
        postponed_.pop_front();
        return ++under_way_, i;
    }

    void work() {
        while (const std::optional<std::size_t> i = next()) {
            Done& done = done_[*i];
            const bool again = done.postponed_;
            std::exception_ptr thrown;
            seconds_[*i] = -now();
            own_task = &done;
            try {
                work_(*i, done);
            } catch (...) { thrown = std::current_exception(); }
            if (!thrown && !again && done.postponed_) postpone(*i);
            else finish(*i, thrown);
        }
    }

    void postpone(std::size_t i) {
        const std::lock_guard lock(mutex_);
        done_[i].part_ = 0;
        seconds_[i] = 0;
        postponed_.push_back(i);
        --under_way_;
    }

    void finish(std::size_t i, const std::exception_ptr& thrown) {
        done_[i].part_ = 1;
        seconds_[i] = seconds_[i] + now();
        const std::lock_guard lock(mutex_);
        ++finished_;
        --under_way_;
        if (thrown && i < failed_) failed_ = i, failure_ = thrown;
        if (failure_) ended_ = true;
        if (failure_ || finished_ == count()) changed_.notify_all();
    }

    // Returns the process that all tasks in progress wait for; "" if at least one task does not
    // wait.
    std::string awaited() const {
        std::string who;
        std::size_t waiting = 0;
        for (const Done& d : done_) {
            const std::lock_guard lock(d.mutex_);
            waiting += d.waits_for_.has_value();
            if (d.waits_for_ && who.empty()) who = *d.waits_for_;
        }
        return waiting == under_way_ ? who : "";
    }
    void note(const std::string& who) {  // reports each process once
        if (std::exchange(awaited_, who) != who) since_ = Clock::now();
        if (who.empty() || Clock::now() - since_ < 2s || who == noted_) return;
        noted_ = who;
        listener_.note("waiting for " + who);
    }

    void show(Progress& progress) {
        const std::string who = awaited();
        note(who);
        double all = 0, so_far = 0, longest = 0;
        std::size_t slowest = 0;
        const double elapsed = now();
        for (std::size_t i = 0; i < count(); ++i) {
            all += sizes_[i];
            so_far += sizes_[i] * done_[i];
            // Negative while the task runs: minus its start time.
            const double s = seconds_[i], taken = s < 0 ? elapsed + s : s;
            if (taken > longest) longest = taken, slowest = i;
        }
        std::string text = fmt::format("{} of {}", finished_, count());
        if (!who.empty()) text += ", waiting for " + who;
        if (who.empty() && so_far > 0)
            text += fmt::format(", about {:.0f} s left", elapsed * (all - so_far) / so_far);
        if (who.empty() && name_ && longest > 0)
            text += fmt::format("; longest {:.0f} s: {}", longest, name_(slowest));
        progress.show(so_far / all, text);
    }

    const std::vector<double>& sizes_;
    const Listener& listener_;
    const std::function<void(std::size_t, Done&)>& work_;
    const std::function<std::string(std::size_t)>& name_;
    const Clock::time_point start_ = Clock::now();
    std::vector<Done> done_;
    std::vector<std::atomic<double>> seconds_;
    std::atomic<bool> cancelled_ = false;
    std::string awaited_, noted_;
    Clock::time_point since_;
    std::mutex mutex_;  // guards the members below
    std::condition_variable changed_;
    std::deque<std::size_t> postponed_;
    std::size_t next_ = 0, under_way_ = 0, finished_ = 0, failed_ = static_cast<std::size_t>(-1);
    bool ended_ = false;
    std::exception_ptr failure_;
};

int threads_of(int jobs) {
    return jobs > 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void side_by_side(const std::vector<double>& sizes, int jobs, const Listener& listener,
                  const std::string& label, const std::function<void(std::size_t, Done&)>& work,
                  const std::function<std::string(std::size_t)>& name) {
    Pool pool(sizes, listener, work, name);
    if (own_task) return pool.run_here();
    pool.run(threads_of(jobs), *listener.begin(label));
    pool.rethrow();
}

void throw_if_cancelled() {
    if (own_task && *own_task->cancelled_) throw Cancelled{};
}

void Done::operator=(double part) {
    part_.store(part, std::memory_order_relaxed);
    if (cancelled_ && *cancelled_) throw Cancelled{};
}

Wait::Wait() { sleep({}, ""); }
Wait::~Wait() {
    if (!own_task) return;
    const std::lock_guard lock(own_task->mutex_);
    own_task->waits_for_.reset();
}
void Wait::sleep(std::chrono::milliseconds pause, const std::string& who) {
    if (own_task) {
        const std::lock_guard lock(own_task->mutex_);
        own_task->waits_for_ = who;
    }
    std::this_thread::sleep_for(pause);
    throw_if_cancelled();
}

}  // namespace jvari::bench::store

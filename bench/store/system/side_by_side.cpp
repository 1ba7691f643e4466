#include "bench/store/system/side_by_side.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace jvari::bench::store {

using namespace std::chrono_literals;

class Things {
    using Clock = std::chrono::steady_clock;

public:
    Things(const std::vector<double>& sizes, const Listener& listener,
           const std::function<void(std::size_t, Done&)>& work,
           const std::function<std::string(std::size_t)>& name)
        : sizes_(sizes),
          listener_(listener),
          work_(work),
          name_(name),
          done_(sizes.size()),
          seconds_(sizes.size()),
          waits_(sizes.size()) {
        for (Done& d : done_) d.unwanted_ = &unwanted_;
    }

    void run(int jobs, Progress& progress) {
        std::vector<std::jthread> threads;
        for (std::size_t k = 0; k < std::min<std::size_t>(jobs, count()); ++k)
            threads.emplace_back([this] { worker(); });
        std::unique_lock lock(mutex_);
        while (finished_ < count() && !failure_) {
            changed_.wait_for(lock, 250ms);
            try {
                show(progress);
            } catch (...) {
                unwanted_ = ended_ = true;
                changed_.notify_all();
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

    // First what was busy and may be free by now: it is finished with, and what it needs can be let
    // go of.
    std::optional<std::size_t> next() {
        std::unique_lock lock(mutex_);
        while (!ended_) {
            const auto soonest = busy_.begin();
            if (soonest != busy_.end() && soonest->first <= Clock::now())
                return busy_.extract(soonest).mapped();
            if (next_ < count()) return next_++;
            if (soonest == busy_.end()) break;
            const Clock::time_point then = soonest->first;
            changed_.wait_until(lock, then);
        }
        return {};
    }

    void worker() {
        while (const std::optional<std::size_t> i = next()) {
            std::exception_ptr thrown;
            seconds_[*i] = -now();
            try {
                work_(*i, done_[*i]);
            } catch (const Busy& busy) {
                if (!listener_.is_part()) {
                    put_back(*i, busy);
                    continue;
                }
                thrown = std::current_exception();
            } catch (...) { thrown = std::current_exception(); }
            finish(*i, thrown);
        }
    }

    void put_back(std::size_t i, const Busy& busy) {
        constexpr Clock::duration shortest = 20ms, longest = 500ms;
        const std::lock_guard lock(mutex_);
        done_[i].part_ = 0;
        seconds_[i] = 0;
        const auto at = Clock::now();
        Wait& w = waits_[i];
        w.pause = std::clamp(2 * w.pause, shortest, longest);
        if (std::exchange(w.who, busy.who) != busy.who) w.since = at;
        busy_.emplace(at + w.pause, i);
        if (all_wait() && !idle_since_) idle_since_ = at;
    }

    void finish(std::size_t i, const std::exception_ptr& thrown) {
        done_[i].part_ = 1;
        seconds_[i] = seconds_[i] + now();
        const std::lock_guard lock(mutex_);
        ++finished_;
        idle_since_.reset();
        if (thrown && i < failed_) failed_ = i, failure_ = thrown;
        if (failure_) ended_ = true;
        if (failure_ || finished_ == count()) changed_.notify_all();
    }

    bool all_wait() const { return !busy_.empty() && finished_ + busy_.size() == count(); }
    const std::string& longest_awaited() const {
        const auto since = [this](const auto& b) { return waits_[b.second].since; };
        return waits_[std::ranges::min_element(busy_, {}, since)->second].who;
    }
    void tell_for_whom() {  // once, until something is finished
        if (!all_wait() || !idle_since_ || Clock::now() - *idle_since_ < 2s) return;
        idle_since_ = Clock::time_point::max();
        if (std::exchange(told_, longest_awaited()) != longest_awaited())
            listener_.note("waiting for " + told_);
    }

    void show(Progress& progress) {
        tell_for_whom();
        double all = 0, so_far = 0, longest = 0;
        std::size_t slowest = 0;
        const double elapsed = now();
        for (std::size_t i = 0; i < count(); ++i) {
            all += sizes_[i];
            so_far += sizes_[i] * done_[i];
            // negative: when it began
            const double s = seconds_[i], taken = s < 0 ? elapsed + s : s;
            if (taken > longest) longest = taken, slowest = i;
        }
        std::string text = fmt::format("{} of {}", finished_, count());
        if (so_far > 0)
            text += fmt::format(", about {:.0f} s left", elapsed * (all - so_far) / so_far);
        if (name_ && longest > 0)
            text += fmt::format("; longest {:.0f} s: {}", longest, name_(slowest));
        if (all_wait())
            text = fmt::format("{} of {}, waiting for {}", finished_, count(), longest_awaited());
        progress.show(so_far / all, text);
    }

    struct Wait {  // of a thing that is busy
        std::string who;
        Clock::time_point since;
        Clock::duration pause{};
    };
    const std::vector<double>& sizes_;
    const Listener& listener_;
    const std::function<void(std::size_t, Done&)>& work_;
    const std::function<std::string(std::size_t)>& name_;
    const Clock::time_point start_ = Clock::now();
    std::vector<Done> done_;
    std::vector<std::atomic<double>> seconds_;
    std::atomic<bool> unwanted_ = false;
    std::mutex mutex_;  // of what follows
    std::condition_variable changed_;
    std::multimap<Clock::time_point, std::size_t> busy_;  // by when to look again
    std::vector<Wait> waits_;
    std::optional<Clock::time_point> idle_since_;  // nothing that is left could be done here
    std::string told_;
    std::size_t next_ = 0, finished_ = 0, failed_ = static_cast<std::size_t>(-1);
    bool ended_ = false;
    std::exception_ptr failure_;
};

void side_by_side(const std::vector<double>& sizes, int jobs, const Listener& listener,
                  const std::string& label, const std::function<void(std::size_t, Done&)>& work,
                  const std::function<std::string(std::size_t)>& name) {
    Things things(sizes, listener, work, name);
    things.run(
        jobs > 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency())),
        *listener.begin(label));
    things.rethrow();
}

std::unique_ptr<FileLock> lock_once_free(const std::filesystem::path& file,
                                         const std::string& doing, const Listener& listener) {
    std::unique_ptr<FileLock> lock;
    side_by_side({1}, 1, listener, "lock",
                 [&](std::size_t, Done&) { lock = std::make_unique<FileLock>(file, doing); });
    return lock;
}

}  // namespace jvari::bench::store

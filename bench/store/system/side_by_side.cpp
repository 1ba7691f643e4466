#include "bench/store/system/side_by_side.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace jvari::bench::store {

class Things {
public:
    Things(const std::vector<double>& sizes, const std::function<void(std::size_t, Done&)>& work,
           const std::function<std::string(std::size_t)>& name)
        : sizes_(sizes), work_(work), name_(name), done_(sizes.size()), seconds_(sizes.size()) {
        for (Done& d : done_) d.unwanted_ = &unwanted_;
    }

    void run(int jobs, Progress& progress) {
        std::vector<std::jthread> threads;
        for (std::size_t k = 0; k < std::min<std::size_t>(jobs, count()); ++k) threads.emplace_back([this] { worker(); });
        std::unique_lock lock(mutex_);
        while (finished_ < count() && !failure_) {
            changed_.wait_for(lock, std::chrono::milliseconds(250));
            try {
                show(progress);
            } catch (...) {
                unwanted_ = true;
                next_ = count();
                throw;
            }
        }
    }
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

private:
    std::size_t count() const { return sizes_.size(); }
    double now() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

    void worker() {
        for (std::size_t i = next_++; i < count(); i = next_++) {
            std::exception_ptr thrown;
            seconds_[i] = -now();
            try {
                work_(i, done_[i]);
            } catch (...) {
                thrown = std::current_exception();
                next_ = count();
            }
            done_[i].part_ = 1;
            seconds_[i] = seconds_[i] + now();
            const std::lock_guard lock(mutex_);
            ++finished_;
            if (thrown && i < failed_) failed_ = i, failure_ = thrown;
            if (failure_ || finished_ == count()) changed_.notify_one();
        }
    }

    void show(Progress& progress) const {
        double all = 0, so_far = 0, longest = 0;
        std::size_t slowest = 0;
        const double elapsed = now();
        for (std::size_t i = 0; i < count(); ++i) {
            all += sizes_[i];
            so_far += sizes_[i] * done_[i];
            const double s = seconds_[i], taken = s < 0 ? elapsed + s : s;  // negative: when it began
            if (taken > longest) longest = taken, slowest = i;
        }
        const double left = so_far > 0 ? elapsed * (all - so_far) / so_far : 0;
        std::string text = fmt::format("{} of {}, about {:.0f} s left", finished_, count(), left);
        if (name_ && longest > 0) text += fmt::format("; longest {:.0f} s: {}", longest, name_(slowest));
        progress.show(so_far / all, text);
    }

    const std::vector<double>& sizes_;
    const std::function<void(std::size_t, Done&)>& work_;
    const std::function<std::string(std::size_t)>& name_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::vector<Done> done_;
    std::vector<std::atomic<double>> seconds_;
    std::atomic<std::size_t> next_ = 0;
    std::atomic<bool> unwanted_ = false;
    std::mutex mutex_;  // of what follows
    std::condition_variable changed_;
    std::size_t finished_ = 0, failed_ = static_cast<std::size_t>(-1);
    std::exception_ptr failure_;
};

void side_by_side(const std::vector<double>& sizes, int jobs, const Listener& listener, const std::string& label,
                  const std::function<void(std::size_t, Done&)>& work, const std::function<std::string(std::size_t)>& name) {
    Things things(sizes, work, name);
    things.run(jobs > 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency())), *listener.begin(label));
    things.rethrow();
}

}  // namespace jvari::bench::store

#include "bench/store/side_by_side.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace jvari::bench::store {

void side_by_side(const std::vector<double>& sizes, int jobs, const Listener& listener, const std::string& label,
                  const std::function<void(std::size_t, Done&)>& work) {
    const std::size_t count = sizes.size();
    if (jobs <= 0) jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<Done> done(count);
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;  // of what follows
    std::condition_variable changed;
    std::size_t finished = 0, failed = count;
    std::exception_ptr failure;

    const auto worker = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            std::exception_ptr thrown;
            try {
                work(i, done[i]);
            } catch (...) {
                thrown = std::current_exception();
                next = count;
            }
            done[i] = 1;
            const std::lock_guard lock(mutex);
            ++finished;
            if (thrown && i < failed) failed = i, failure = thrown;
            if (failure || finished == count) changed.notify_one();
        }
    };
    {
        const auto progress = listener.begin(label);
        const auto start = std::chrono::steady_clock::now();
        std::vector<std::jthread> threads;
        for (std::size_t k = 0; k < std::min<std::size_t>(jobs, count); ++k) threads.emplace_back(worker);
        std::unique_lock lock(mutex);
        while (finished < count && !failure) {
            changed.wait_for(lock, std::chrono::milliseconds(250));
            double all = 0, so_far = 0;
            for (std::size_t i = 0; i < count; ++i) all += sizes[i], so_far += sizes[i] * done[i].load(std::memory_order_relaxed);
            const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            const double left = so_far > 0 ? elapsed * (all - so_far) / so_far : 0;
            progress->show(so_far / all, fmt::format("{} of {}, about {:.0f} s left", finished, count, left));
        }
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace jvari::bench::store

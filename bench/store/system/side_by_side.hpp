// Independent things side by side on a few threads, with one progress line for all of them.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/store/system/file_lock.hpp"
#include "bench/store/system/listener.hpp"

namespace jvari::bench::store {

struct Stopped {};  // no std::exception: a cell that is no longer wanted is none that failed

class Done {  // how much of a thing is done, from 0 to 1
public:
    void operator=(double part) {  // throws Stopped where it is no longer wanted
        part_.store(part, std::memory_order_relaxed);
        look();
    }
    void look() const {  // throws Stopped, too
        if (unwanted_ && *unwanted_) throw Stopped{};
    }
    operator double() const { return part_.load(std::memory_order_relaxed); }

private:
    friend class Things;
    std::atomic<double> part_ = 0;
    const std::atomic<bool>* unwanted_ = nullptr;
};

// work(i, done) for each i below sizes.size(), begun in this order, on `jobs` threads (0: as many
// as there are cores). `sizes`: how long each is expected to take, in any unit; for the progress
// line alone. Where one throws no further one is begun, and of what was thrown that of the lowest i
// is thrown again: the one that would have ended them if they had gone one by one. What the
// listener throws while it is shown how far they are ends all of them. `name`, where there is one,
// lets the line say which took longest.
//
// A thing that throws Busy (file_lock.hpp) is begun again later, and others meanwhile. Where
// nothing else is left for two seconds, the listener is told for whom it waits. Within a larger job
// (is_part) Busy is thrown on to that.
void side_by_side(const std::vector<double>& sizes, int jobs, const Listener&,
                  const std::string& label, const std::function<void(std::size_t i, Done&)>& work,
                  const std::function<std::string(std::size_t i)>& name = {});

// The listener of what is itself a part of a thing:
// shows nothing, ends the part by Stopped where the thing is no longer wanted, and has it wait for
// nobody.
class PartOf : public Listener {
    struct Look : Progress {
        explicit Look(const Done& d) : done(d) {}
        void show(double, const std::string&) override { done.look(); }
        const Done& done;
    };

public:
    explicit PartOf(const Done& done) : done_(done) {}
    std::unique_ptr<Progress> begin(const std::string&) const override {
        return std::make_unique<Look>(done_);
    }
    bool is_part() const override { return true; }

private:
    const Done& done_;
};

// The lock of a file, however long another holds it; the listener is told who that is.
std::unique_ptr<FileLock> lock_once_free(const std::filesystem::path& file,
                                         const std::string& doing, const Listener&);

}  // namespace jvari::bench::store

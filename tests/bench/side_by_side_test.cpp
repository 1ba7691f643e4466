// Tasks side by side: each once, as many at a time as asked for, and failures as if they had gone
// one by one.
#include "bench/store/system/side_by_side.hpp"
#include "tests/says.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

namespace jvari::test {
namespace {

const bench::store::Listener quiet;
void wait(int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

TEST(SideBySide, EachIsDoneOnceOnAsManyThreadsAsAskedFor) {
    for (const int jobs : {0, 1, 3, 100}) {
        std::vector<std::atomic<int>> times(20);
        std::atomic<int> together = 0, most = 0;
        bench::store::side_by_side(std::vector<double>(20, 1), jobs, quiet, "",
                                   [&](std::size_t i, bench::store::Done& done) {
                                       const int n = ++together;
                                       for (int seen = most;
                                            n > seen && !most.compare_exchange_weak(seen, n);) {}
                                       EXPECT_EQ(done, 0);
                                       wait(5);
                                       ++times[i];
                                       --together;
                                   });
        for (const auto& t : times) EXPECT_EQ(t, 1);
        if (jobs > 0) { EXPECT_LE(most, jobs); }
        if (jobs > 1) { EXPECT_GE(most, 2); }
    }
    bench::store::side_by_side({}, 4, quiet, "", [](std::size_t, bench::store::Done&) { FAIL(); });
}

TEST(SideBySide, TheFirstFailureInOrderIsThrownWhicheverComesFirstAndEndsTheRest) {
    for (const std::size_t late : {4, 5}) {
        std::set<std::size_t> begun;
        std::mutex mutex;
        try {
            bench::store::side_by_side(std::vector<double>(50, 1), 3, quiet, "",
                                       [&](std::size_t i, bench::store::Done&) {
                                           {
                                               const std::lock_guard lock(mutex);
                                               begun.insert(i);
                                           }
                                           if (i >= 4) {
                                               wait(i == late ? 80 : 20);
                                               throw std::runtime_error(std::to_string(i));
                                           }
                                       });
            FAIL();
        } catch (const std::runtime_error& e) { EXPECT_STREQ(e.what(), "4"); }
        EXPECT_LE(begun.size(), 8u);
    }
}

TEST(SideBySide, TheLineSaysHowManyAreDoneHowLongItTakesAndWhichTookLongest) {
    struct Kept : bench::store::Progress {
        std::string& last;
        explicit Kept(std::string& to) : last(to) {}
        void show(double, const std::string& what) override { last = what; }
    };
    struct Ear : bench::store::Listener {
        mutable std::string last;
        std::unique_ptr<bench::store::Progress> begin(const std::string&) const override {
            return std::make_unique<Kept>(last);
        }
    } ear;
    bench::store::side_by_side(
        {1, 1, 1, 1}, 1, ear, "",
        [](std::size_t i, bench::store::Done& done) { done = 0.5, wait(i == 1 ? 1300 : 5); },
        [](std::size_t i) { return "number " + std::to_string(i); });
    EXPECT_TRUE(says(ear.last, " of 4, about "));
    EXPECT_TRUE(says(ear.last, "longest 1 s: number 1"));
}

TEST(SideBySide, WhatTheListenerThrowsEndsThoseThatRunAndBeginsNoOther) {
    struct Weary : bench::store::Progress {
        void show(double, const std::string&) override { throw std::runtime_error("enough"); }
    };
    struct Ear : bench::store::Listener {
        std::unique_ptr<bench::store::Progress> begin(const std::string&) const override {
            return std::make_unique<Weary>();
        }
    };
    std::atomic<int> begun = 0, to_the_end = 0;
    EXPECT_THROW(bench::store::side_by_side(std::vector<double>(20, 1), 2, Ear(), "",
                                            [&](std::size_t, bench::store::Done& done) {
                                                ++begun;
                                                for (int k = 0; k < 3000; ++k)
                                                    wait(10), done = k / 3000.0;
                                                ++to_the_end;
                                            }),
                 std::runtime_error);
    EXPECT_LE(begun, 2);
    EXPECT_EQ(to_the_end, 0);
}

TEST(SideBySide, WhatTheListenerThrowsEndsThePartsOfThoseThatRunAndWhoWaitsForThem) {
    struct Weary : bench::store::Progress {
        void show(double, const std::string&) override { throw std::runtime_error("enough"); }
    };
    struct Ear : bench::store::Listener {
        std::unique_ptr<bench::store::Progress> begin(const std::string&) const override {
            return std::make_unique<Weary>();
        }
    };
    std::once_flag once;  // of the two tasks one makes the parts of both
    std::atomic<int> to_the_end = 0;
    const auto part = [&](std::size_t, bench::store::Done& done) {
        for (int k = 0; k < 3000; ++k) wait(10), done = k / 3000.0;
        ++to_the_end;
    };
    const auto whole = [&](std::size_t, bench::store::Done&) {
        std::call_once(once, [&] { bench::store::side_by_side({1, 1}, 2, quiet, "", part); });
        ++to_the_end;
    };
    EXPECT_THROW(bench::store::side_by_side({1, 1}, 2, Ear(), "", whole), std::runtime_error);
    EXPECT_EQ(to_the_end, 0);
}

TEST(SideBySide, WhatIsPostponedIsBegunAgainOnceWhenTheOthersAreDoneAndMayWait) {
    for (const int jobs : {1, 3}) {
        std::atomic<int> times = 0, others = 0;
        bench::store::side_by_side(std::vector<double>(10, 1), jobs, quiet, "",
                                   [&](std::size_t i, bench::store::Done& done) {
                                       EXPECT_EQ(done, 0);
                                       done = 0.5;
                                       if (i != 2) {
                                           wait(5);
                                           ++others;
                                           return;
                                       }
                                       EXPECT_EQ(done.may_wait(), ++times == 2);
                                       if (times == 2) { EXPECT_GE(others, 10 - jobs); }
                                       done.postpone();
                                   });
        EXPECT_EQ(times, 2);
        EXPECT_EQ(others, 9);
    }
}

TEST(SideBySide, ACallFromWithinATaskRunsOnItsThread) {
    const auto own = [] { return std::this_thread::get_id(); };
    bench::store::side_by_side({1, 1}, 2, quiet, "", [&](std::size_t, bench::store::Done&) {
        const auto outer = own();
        std::vector<std::size_t> order;
        bench::store::side_by_side({1, 1, 1}, 3, quiet, "",
                                   [&](std::size_t i, bench::store::Done& part) {
                                       part = 0.5;
                                       EXPECT_EQ(own(), outer);
                                       order.push_back(i);
                                   });
        EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2}));
    });
}

TEST(SideBySide, WhoWaitsSaysForWhomOnceAndMayBeToldToEnd) {
    struct Weary : bench::store::Progress {
        void show(double, const std::string& what) override {
            EXPECT_EQ(what, "0 of 2, waiting for process 7 on node, which works");
            if (Clock::now() - begun > std::chrono::milliseconds(3500))
                throw std::runtime_error("enough");
        }
        using Clock = std::chrono::steady_clock;
        Clock::time_point begun = Clock::now();
    };
    struct Ear : bench::store::Listener {
        mutable std::vector<std::string> notes;
        void note(const std::string& text) const override { notes.push_back(text); }
        std::unique_ptr<bench::store::Progress> begin(const std::string&) const override {
            return std::make_unique<Weary>();
        }
    } ear;
    // one waits for a process, the other for the first
    const auto waits = [](std::size_t i, bench::store::Done&) {
        const bench::store::Wait wait;
        while (true)
            bench::store::Wait::sleep(std::chrono::milliseconds(20),
                                      i == 1 ? "process 7 on node, which works" : "");
    };
    EXPECT_THROW(bench::store::side_by_side({1, 1}, 2, ear, "", waits), std::runtime_error);
    EXPECT_EQ(ear.notes, std::vector<std::string>{"waiting for process 7 on node, which works"});
}

}  // namespace
}  // namespace jvari::test

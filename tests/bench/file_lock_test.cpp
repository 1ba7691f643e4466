// One process at a time makes a file: whoever waits takes what the other made, and a holder that is gone holds nobody up.
#include "bench/store/system/file_lock.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>

#include "bench/compare/catalogue.hpp"
#include "bench/trust/kept_run.hpp"
#include "reference/references.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

using bench::store::FileLock;
using bench::store::Patience;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

bool never() {
    return false;
}

void append(const std::string& path, const std::string& text) {
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    EXPECT_EQ(write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    close(file);
}

TEST(FileLock, ProcessesThatAskForAReferenceAtOnceMakeItOnce) {
    const Scratch scratch;
    const Settings settings{0, 44100, 20, {}};
    const Scene scene = bench::compare::load_scene("tanpura_c3_release", {}, 5e-3);
    const auto make = [&] {
        append(scratch / "made", "x");
        std::this_thread::sleep_for(300ms);
        return run(exact_contact, scene, settings);
    };
    std::vector<pid_t> children;
    for (int k = 0; k < 6; ++k) {
        children.push_back(fork());
        if (children.back() == 0) _exit(bench::trust::kept_run(scratch / "runs", "key", make, 0).trace.rows > 100 ? 0 : 1);
    }
    for (const pid_t child : children) {
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(content(scratch / "made"), "x");
    EXPECT_TRUE(std::filesystem::exists(scratch / "runs/key.run"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "runs/key.run.lock"));
}

TEST(FileLock, WhoWaitsForAReferenceMayBeToldToEnd) {
    const Scratch scratch;
    append(scratch / "key.run.lock", "elsewhere boot pid:[1] 1 1");
    struct Enough {};
    int asked = 0;
    const auto waiting = [&asked](long, long) {
        if (++asked == 4) throw Enough{};
    };
    EXPECT_THROW(bench::trust::kept_run(
                     scratch.path, "key", [] { return jvari::Run(); }, 0, waiting),
                 Enough);
    EXPECT_TRUE(std::filesystem::exists(scratch / "key.run.lock"));  // it is the other's
}

TEST(FileLock, OfAProcessThatIsGoneHoldsNobodyUp) {
    const Scratch scratch;
    const pid_t child = fork();
    if (child == 0) {
        new FileLock(scratch / "a.lock", never);
        _exit(0);  // as if killed: nothing is released
    }
    waitpid(child, nullptr, 0);
    ASSERT_TRUE(std::filesystem::exists(scratch / "a.lock"));
    const auto start = Clock::now();
    const FileLock lock(scratch / "a.lock", never, {5s, 1h, 1s});
    EXPECT_TRUE(lock.held());
    EXPECT_LT(Clock::now() - start, 10s);
    EXPECT_EQ(content(scratch / "a.lock"), bench::store::process_name());
}

TEST(FileLock, OfAnotherMachineHoldsWhileItIsTouchedAndNoLonger) {
    const Scratch scratch;
    const std::filesystem::path path = scratch / "a.lock";
    append(path, "elsewhere boot pid:[1] 1 1");
    std::atomic<bool> alive = true;
    std::atomic<Clock::time_point> last = Clock::now();
    std::thread other([&] {
        for (int k = 0; k < 30; ++k) {
            last = Clock::now();
            std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now());
            std::this_thread::sleep_for(50ms);
        }
        alive = false;
    });
    const FileLock lock(path, never, {5s, 1s, 20ms});
    EXPECT_TRUE(lock.held());
    EXPECT_FALSE(alive);
    EXPECT_GE(Clock::now() - last.load(), 900ms);
    other.join();
}

TEST(FileLock, IsTouchedAndGoesWithItsHolder) {
    const Scratch scratch;
    const std::filesystem::path path = scratch / "a.lock";
    {
        const FileLock lock(path, never, {20ms, 1h, 1s});
        const auto first = std::filesystem::last_write_time(path);
        for (int k = 0; k < 500 && std::filesystem::last_write_time(path) == first; ++k) std::this_thread::sleep_for(20ms);
        EXPECT_GT(std::filesystem::last_write_time(path), first);
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(FileLock, WaitsForNobodyWhereNothingIsLeftToDoOrNoFileCanBe) {
    const Scratch scratch;
    const FileLock first(scratch / "a.lock", never);
    int asked = 0;
    const FileLock second(scratch / "a.lock", [&asked] { return ++asked > 3; });
    EXPECT_FALSE(second.held());
    EXPECT_FALSE(FileLock(scratch / "no/such/folder.lock", never).held());
}

}  // namespace
}  // namespace jvari::test

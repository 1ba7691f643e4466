// One process at a time makes a file: whoever comes later takes what it made, and one that is gone
// holds nobody up.
#include "bench/store/system/file_lock.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "bench/compare/catalogue.hpp"
#include "bench/study/reference.hpp"
#include "reference/references.hpp"
#include "tests/command_line.hpp"

namespace jvari::test {
namespace {

using bench::store::FileLock;

void append(const std::string& path, const std::string& text) {
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    EXPECT_EQ(write(file, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    close(file);
}

template <class Act>
int status_of_child(Act act) {  // that does not end within a minute: SIGALRM
    const pid_t child = fork();
    if (child == 0) {
        alarm(60);
        _exit(act());
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
}

TEST(FileLock, ProcessesThatAskForAReferenceAtOnceMakeItOnce) {
    const Scratch scratch;
    const Settings settings{0, 44100, 20, {}};
    const Scene scene = bench::compare::load_scene("tanpura_c3_release", {}, 5e-3);
    const auto make = [&] {
        append(scratch / "made", "x");
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        return run(exact_contact, scene, settings);
    };
    std::vector<pid_t> children;
    for (int k = 0; k < 6; ++k) {
        children.push_back(fork());
        if (children.back() != 0) continue;
        _exit(bench::study::kept_run(scratch / "runs", "key", make, 0).trace.rows > 100 ? 0 : 1);
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

TEST(FileLock, SaysWhoHoldsItAndWhatForAndGoesWithItsHolder) {
    const Scratch scratch;
    {
        const FileLock lock(scratch / "a", "makes it");
        EXPECT_TRUE(lock.locked());
        char host[256] = "";
        gethostname(host, sizeof host - 1);
        // in one process, too
        const FileLock second(scratch / "a", "makes it", false);
        EXPECT_TRUE(second.elsewhere());
        EXPECT_FALSE(second.locked());
        struct Ear : bench::store::Listener {
            mutable std::string last;
            struct Line : bench::store::Progress {
                std::string& last;
                explicit Line(std::string& to) : last(to) {}
                void show(double, const std::string& what) override {
                    last = what;
                    throw std::runtime_error("enough");
                }
            };
            std::unique_ptr<bench::store::Progress> begin(const std::string&) const override {
                return std::make_unique<Line>(last);
            }
        } ear;
        // who waits may be told to end
        EXPECT_THROW(bench::store::lock_of(scratch / "a", "makes it", ear), std::runtime_error);
        EXPECT_EQ(ear.last, "0 of 1, waiting for process " + std::to_string(getpid()) + " on " +
                                host + ", which makes it");
        EXPECT_TRUE(FileLock(scratch / "b", "").locked());
    }
    EXPECT_EQ(scratch.files(), 0);
    // what lies there says nothing about who holds it
    std::ofstream(scratch / "a.lock") << "\033[2Jsomebody\n";
    EXPECT_TRUE(FileLock(scratch / "a", "").locked());
}

TEST(FileLock, OfAProcessThatIsKilledIsFreeAtOnce) {
    const Scratch scratch;
    EXPECT_EQ(status_of_child([&] {
                  new FileLock(scratch / "a", "");
                  return kill(getpid(), SIGKILL);
              }),
              SIGKILL);
    ASSERT_TRUE(std::filesystem::exists(scratch / "a.lock"));
    EXPECT_TRUE(FileLock(scratch / "a", "").locked());
    EXPECT_EQ(scratch.files(), 0);
}

TEST(FileLock, IsNeverHeldByTwoHoweverOftenItIsRemoved) {
    const Scratch scratch;
    std::ofstream(scratch / "count") << 0;
    std::vector<pid_t> children;
    for (int k = 0; k < 4; ++k) {
        children.push_back(fork());
        if (children.back() != 0) continue;
        for (int n = 0; n < 250; ++n) try {
                const FileLock lock(scratch / "count", "counts");
                const int so_far = std::stoi(content(scratch / "count"));
                std::ofstream(scratch / "count") << so_far + 1;
            } catch (const std::exception&) {  // another has just emptied it
                _exit(1);
            }
        _exit(0);
    }
    for (const pid_t child : children) waitpid(child, nullptr, 0);
    EXPECT_EQ(content(scratch / "count"), "1000");
}

TEST(FileLock, IsNoneWhereNoneCanBeAndNothingWaits) {
    const Scratch scratch;
    std::ofstream(scratch / "target") << "as it was";
    std::filesystem::create_symlink("target", scratch / "link.lock");
    std::filesystem::create_directory(scratch / "folder.lock");
    ASSERT_EQ(mkfifo((scratch / "pipe.lock").c_str(), 0600), 0);
    EXPECT_EQ(status_of_child([&] {
                  for (const char* name : {"link", "folder", "pipe", "no/such/folder"})
                      if (FileLock(scratch / name, "").locked()) return 1;
                  return FileLock("", "").locked() ? 1 : 0;
              }),
              0);
    EXPECT_EQ(content(scratch / "target"), "as it was");
    EXPECT_TRUE(std::filesystem::exists(scratch / "pipe.lock"));
}

TEST(FileLock, ThatIsStaleInAFolderThatCannotBeWrittenIsPassedBy) {
    const Scratch scratch;
    namespace fs = std::filesystem;
    fs::create_directory(scratch / "runs");
    std::ofstream(scratch / "runs/key.run.lock") << "elsewhere boot pid:[1] 999999 1";
    for (const auto& path : {scratch.path, scratch.path / "runs"})
        fs::permissions(path, fs::perms(0555));
    EXPECT_EQ(status_of_child([&] {
                  // root may write everywhere
                  if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) return 2;
                  int count = 0;
                  bench::study::kept_run(
                      scratch / "runs", "key", [&count] { return ++count, jvari::Run(); }, 0);
                  return count == 1 ? 0 : 1;
              }),
              0);
    EXPECT_FALSE(fs::exists(scratch / "runs/key.run"));
    for (const auto& path : {scratch.path, scratch.path / "runs"})
        fs::permissions(path, fs::perms(0755));
}

}  // namespace
}  // namespace jvari::test

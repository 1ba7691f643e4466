// Ctrl-C, and what it leaves: whole files or none, an ended line, the way to go on, and a caller
// that sees the signal.
#include "bench/store/system/interruption.hpp"

#include <fcntl.h>
#include <pty.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <iterator>
#include <thread>

#include "bench/store/fresh_file.hpp"
#include "bench/store/system/file_lock.hpp"
#include "tests/command_line.hpp"
#include "tests/sanitized.hpp"

namespace jvari::test {
namespace {

namespace fs = std::filesystem;

TEST(WithinATimeLimit, ARunThatWouldNotReachItsEndIsEndedAtOnce) {
    using namespace bench::store;
    const auto look = within(
        1000, [](long, long) {}, 0.02);
    look(1, 1000000);  // too early to tell
    for (const double from = processor_seconds(); processor_seconds() - from < 0.03;) {}
    EXPECT_NO_THROW(look(999999, 1000000));
    EXPECT_NO_THROW(within(1000, [](long, long) {})(0, 1000000));
    EXPECT_THROW(look(0, 1000000), PastItsLimit);
    try {
        look(1, 1000000);
        FAIL();
    } catch (const PastItsLimit& e) {
        EXPECT_TRUE(says(e.what(), "it has 1 of 1000000 rows, and would take more than 1000 s"));
    }
}

// after its start a program has begun what lasts
constexpr auto under_way = std::chrono::milliseconds(sanitized ? 4000 : 1000);

struct How {
    bool terminal = false;  // in place of files: stdout and stderr
    bool ignoring = false;  // SIGINT
    std::string path = std::getenv("PATH"), node_modules = "/nowhere";
};

class Started {  // the built program on its own
public:
    Started(const Scratch& scratch, const std::vector<std::string>& arguments,
            const How& how = {}) {
        child_ = how.terminal ? forkpty(&terminal_, nullptr, nullptr, nullptr) : fork();
        if (child_ != 0) return;
        signal(SIGINT, how.ignoring ? SIG_IGN : SIG_DFL);
        if (!how.terminal)
            for (const auto& [name, stream] : {std::pair("stdout", 1), std::pair("stderr", 2)})
                dup2(open((scratch / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), stream);
        setenv("PATH", how.path.c_str(), 1);
        setenv("TMPDIR", scratch.path.c_str(), 1);
        setenv("JVARI_NODE_MODULES", how.node_modules.c_str(), 1);
        setenv("JVARI_CACHE", "", 1);
        std::vector<char*> argv{const_cast<char*>(JVARI_PROGRAM)};
        for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
        argv.push_back(nullptr);
        execv(argv[0], argv.data());
        _exit(127);
    }
    ~Started() {
        if (!ended_) kill(child_, SIGKILL), end();
        if (terminal_ >= 0) close(terminal_);
    }
    Started(const Started&) = delete;
    Started& operator=(const Started&) = delete;

    template <class Happened>
    void once(Happened happened) {  // waits for it, or for the program's end
        while (!happened() && !has_ended())
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    void send(int signal) {
        if (!has_ended()) kill(child_, signal);
    }
    bool has_ended() {
        ended_ = ended_ || waitpid(child_, &status_, WNOHANG) == child_;
        return ended_;
    }
    int end() {  // the signal that ended it; -1: its own end
        if (!ended_) waitpid(child_, &status_, 0), ended_ = true;
        return WIFSIGNALED(status_) ? WTERMSIG(status_) : -1;
    }
    std::string read() {  // from the terminal, what there is
        char text[4096];
        const auto n = ::read(terminal_, text, sizeof text);
        return {text, n > 0 ? static_cast<std::size_t>(n) : 0};
    }
    void type(char c) { EXPECT_EQ(write(terminal_, &c, 1), 1); }

private:
    pid_t child_ = 0;
    int terminal_ = -1, status_ = 0;
    bool ended_ = false;
};

std::vector<std::string> parts_below(const fs::path& folder) {
    std::vector<std::string> parts;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".part") parts.push_back(entry.path().string());
    return parts;
}

int files_of(const fs::path& folder, const char* extension) {
    std::error_code none_yet;
    int n = 0;
    for (const auto& entry : fs::directory_iterator(folder, none_yet))
        n += entry.path().extension() == extension;
    return n;
}
int cells_in(const fs::path& folder) { return files_of(folder, ".json"); }

TEST(Interruption, ASuiteSaysWhatIsKeptLeavesNoPartAndGoesOnToTheSameTable) {
    const Scratch scratch;
    const std::string file = scratch / "a.toml", kept = scratch / "stopped/cells";
    std::ofstream(file) << suite_of("tanpura_c3_release", "modal_two_point,sitar_fdm",
                                    "44100, 88200, 176400",
                                    "modes = 20\nreference_modes = 'cell'\nduration = 0.05\n"
                                    "sweep = { 'string.0.tension' = [30, 31, 32, 33] }");
    ASSERT_EQ(Started(scratch, {"suite", file, "--jobs", "1", "--out", scratch / "whole"}).end(),
              -1);
    int before = 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGINT}) {
        Started suite(scratch,
                      {"suite", file, "--jobs", "2", "--resume", "--out", scratch / "stopped"});
        suite.once([&] { return cells_in(kept) > before; });
        suite.send(signal);
        EXPECT_EQ(suite.end(), signal);
        EXPECT_EQ(parts_below(scratch.path), std::vector<std::string>());
        const int n = cells_in(kept);
        EXPECT_GT(n, before);
        EXPECT_LT(n, 24);
        before = n;
        const std::string message =
            "interrupted: " + std::to_string(n) + " of 24 cells and " +
            std::to_string(files_of(scratch / "stopped/references", ".run")) +
            " runs of references are kept in " + (scratch / "stopped") + "; --resume";
        EXPECT_TRUE(says(content(scratch / "stderr"), message));
        EXPECT_EQ(content(scratch / "stdout"), "");
    }
    ASSERT_EQ(Started(scratch, {"suite", file, "--resume", "--out", scratch / "stopped"}).end(),
              -1);
    EXPECT_TRUE(says(content(scratch / "stdout"), " " + std::to_string(before) + " read back"));
    EXPECT_EQ(content(scratch / "stopped/errors.csv"), content(scratch / "whole/errors.csv"));
}

// The test holds one cell, so that the comparison comes to the others and waits.
TEST(Interruption, AComparisonSaysWhatIsKeptAndGoesOnToTheSameTable) {
    const Scratch scratch;
    const std::string out = scratch / "stopped", cells = out + "/cells";
    const auto arguments = [](const std::string& folder, const std::string& more = "") {
        std::istringstream words(
            "compare tanpura_c3_release --schemes modal_two_point,modal_quadratised --rates "
            "44100,88200 --modes 40 --option compliance=own "
            "--duration 0.05 --repeats 1 --reference-modes 40 --jobs 1 --out " +
            folder + more);
        return std::vector<std::string>(std::istream_iterator<std::string>(words), {});
    };
    ASSERT_EQ(Started(scratch, arguments(scratch / "whole")).end(), -1)
        << content(scratch / "stderr");
    fs::path locked;
    for (const auto& entry : fs::directory_iterator(scratch / "whole/cells"))
        if (entry.path().extension() == ".json") locked = cells / entry.path().filename();
    fs::create_directories(cells);
    {
        const bench::store::FileLock lock(locked, "is held by a test");
        Started compare(scratch, arguments(out));
        compare.once(
            [&] { return content(scratch / "stderr").find("waiting for") != std::string::npos; });
        compare.send(SIGINT);
        EXPECT_EQ(compare.end(), SIGINT);
    }
    EXPECT_EQ(cells_in(cells), 3);
    const std::string message = content(scratch / "stderr");
    EXPECT_TRUE(says(message, "interrupted: the errors of 3 of 4 cells are kept in " + out +
                                  "; --resume goes on from there"));
    EXPECT_FALSE(fs::exists(out + "/cells.csv"));
    ASSERT_EQ(Started(scratch, arguments(out, " --resume")).end(), -1)
        << content(scratch / "stderr");
    EXPECT_TRUE(says(content(scratch / "stderr"), "the errors of 3 of 4 cells were read back"));
    for (const char* table : {"/errors.csv", "/convergence.csv"})
        EXPECT_EQ(content(out + table), content(scratch / "whole" + table));
    for (const auto& sound : fs::directory_iterator(scratch / "whole/sounds"))
        EXPECT_EQ(content(out + "/sounds/" + sound.path().filename().string()),
                  content(sound.path()))
            << sound.path();
}

TEST(Interruption, WhereNothingIsKeptThatIsSaid) {
    const Scratch scratch;
    const std::string file = scratch / "a.toml";
    std::ofstream(file) << suite_of("tanpura_c3", "modal_two_point", "2822400",
                                    "reference_modes = 'cell'\nduration = 60");
    for (const auto& [arguments, message] : {
             std::pair<std::vector<std::string>, std::string>{
                 {"compare", "tanpura_c3", "--schemes", "modal_two_point", "--rates", "2822400"},
                 "for there is no --out DIR"},
             {{"suite", file}, "for there is no --out DIR"},
             {{"certify", "tanpura_c3", "--out", scratch / "c.json"},
              "until all runs of a certificate are done"},
         }) {
        Started nowhere(scratch, arguments);
        std::this_thread::sleep_for(under_way);
        nowhere.send(SIGINT);
        EXPECT_EQ(nowhere.end(), SIGINT) << arguments.front();
        EXPECT_TRUE(says(content(scratch / "stderr"), "interrupted: nothing is kept, " + message))
            << arguments.front() << ": ";
    }
    EXPECT_FALSE(fs::exists(scratch / "c.json"));
    EXPECT_FALSE(fs::exists(scratch / "c.json.lock"));
}

TEST(Interruption, ASuiteSaysWhichReferencesAreKeptAndLeavesNoLock) {
    const Scratch scratch;
    const std::string file = scratch / "a.toml", references = scratch / "all/references";
    std::ofstream(file) << suite_of("free_string", "modal_two_point", "44100", "duration = 0.01")
                        << suite_of("tanpura_c3", "modal_two_point", "44100",
                                    "reference_modes = 'cell'\nduration = 2\n"
                                    "reference = 'sundials'");
    Started suite(scratch, {"suite", file, "--out", scratch / "all", "--resume", "--jobs", "2"});
    suite.once(
        [&] { return cells_in(scratch / "all/cells") == 1 && files_of(references, ".lock") == 1; });
    suite.send(SIGINT);
    EXPECT_EQ(suite.end(), SIGINT);
    EXPECT_EQ(files_of(references, ".run"), 8);  // of the free string
    const std::string message = "interrupted: 1 of 2 cells and 8 runs of references are kept in " +
                                (scratch / "all") + "; --resume";
    EXPECT_TRUE(says(content(scratch / "stderr"), message));
    EXPECT_EQ(files_of(references, ".lock") + files_of(scratch / "all/cells", ".lock"), 0);
}

TEST(Interruption, AProgramThatIsRunEndsAndWhatItStartedAsWell) {
    const Scratch scratch;
    std::ofstream(scratch / "mine") << "sleep 30 & echo $$ $! > " + (scratch / "pids") + "; wait\n";
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
        fs::remove(scratch / "pids");
        Started run(scratch, {"run", "free_string", "--scheme", "mine", "--duration", "0.01",
                              "--external", "sh " + (scratch / "mine")});
        run.once([&] { return content(scratch / "pids").ends_with('\n'); });
        run.send(signal);
        EXPECT_EQ(run.end(), signal);
        std::ifstream pids(scratch / "pids");
        for (pid_t pid; pids >> pid;) {
            const std::string process = "/proc/" + std::to_string(pid);
            EXPECT_FALSE(fs::exists(process)) << "after signal " << signal;
        }
    }
    EXPECT_EQ(scratch.files(), 2);  // that program and its numbers
}

TEST(Interruption, ARunLeavesNoFile) {
    const Scratch scratch;
    Started run(scratch, {"run", "tanpura_c3", "--scheme", "modal_two_point", "--rate", "2822400",
                          "--duration", "60", "--out", scratch / "x.csv"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    run.send(SIGINT);
    EXPECT_EQ(run.end(), SIGINT);
    EXPECT_EQ(scratch.files(), 0);
    EXPECT_EQ(content(scratch / "stderr"), "");
}

TEST(Interruption, CtrlCOnATerminalClearsTheProgressLine) {
    const Scratch scratch;
    Started run(scratch,
                {"run", "tanpura_c3", "--scheme", "modal_two_point", "--rate", "2822400",
                 "--duration", "60", "--out", scratch / "x.csv"},
                {.terminal = true});
    std::string seen;
    while (seen.find('%') == std::string::npos && !run.has_ended()) seen += run.read();
    run.type('\x03');
    for (std::string more = run.read(); !more.empty(); more = run.read()) seen += more;
    EXPECT_EQ(run.end(), SIGINT);
    EXPECT_TRUE(seen.ends_with("\r\033[K")) << seen;
    EXPECT_EQ(scratch.files(), 0);
}

TEST(Interruption, WhatTheCallerIgnoresIsIgnored) {
    const Scratch scratch;
    Started run(scratch,
                {"run", "free_string", "--scheme", "modal_two_point", "--rate", "2822400",
                 "--duration", "3", "--out", scratch / "x.csv"},
                {.ignoring = true});
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    run.send(SIGINT);
    EXPECT_EQ(run.end(), -1);
    EXPECT_TRUE(fs::exists(scratch / "x.csv"));
}

TEST(Interruption, WhoDrawsAChartIsNotSpared) {
    const Scratch scratch;
    for (const char* library : {"vega", "vega-lite", "vega-embed"}) {
        fs::create_directories(scratch.path / library / "build");
        std::ofstream(scratch.path / library / "build" / (library + std::string(".min.js")))
            << "//";
    }
    std::ofstream(scratch / "node")
        << "#!/bin/bash\ngrep SigBlk /proc/self/status >" << scratch / "blocked"
        << "\nexec sleep 1\n";
    fs::permissions(scratch / "node", fs::perms::owner_all);
    Started compare(scratch,
                    {"compare", "free_string", "--schemes", "modal_two_point", "--rates", "44100",
                     "--duration", "0.01", "--repeats", "1", "--out", scratch / "c"},
                    {.path = scratch.path.string() + ":" + std::getenv("PATH"),
                     .node_modules = scratch.path.string()});
    compare.once([&] { return !content(scratch / "blocked").empty(); });
    compare.send(SIGINT);
    EXPECT_EQ(compare.end(), SIGINT);
    EXPECT_EQ(content(scratch / "blocked"), "SigBlk:\t0000000000000000\n");
    for (const auto& entry : fs::directory_iterator(scratch.path))
        EXPECT_NE(entry.path().filename().string().rfind("jvari-", 0), 0u) << entry.path();
}

// a copy of this program, on its own: it says when it is ready and waits to be told to go on
class Child {
public:
    template <class Life>
    explicit Child(Life life) {
        EXPECT_EQ(pipe(ready_) + pipe(go_on_), 0);
        if (child_ = fork(); child_ == 0) {
            bench::store::heed_interruptions();
            life([this] {
                char c = 0;
                if (write(ready_[1], &c, 1) != 1 || read(go_on_[0], &c, 1) != 1) _exit(2);
            });
            _exit(3);
        }
        char c;
        EXPECT_EQ(read(ready_[0], &c, 1), 1);
    }
    ~Child() {
        for (const int end : {ready_[0], ready_[1], go_on_[0], go_on_[1]}) close(end);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    void send(int signal) {
        kill(child_, signal);
        std::this_thread::sleep_for(std::chrono::milliseconds(200));  // for it to be heeded
    }
    void go_on() { EXPECT_EQ(write(go_on_[1], "", 1), 1); }
    bool lives() {
        int status;
        return waitpid(child_, &status, WNOHANG) == 0;
    }
    int end() {  // the signal that ended it; -1: its own end; SIGKILL: there was none within 5 s
        int status = 0, k = 0;
        while (waitpid(child_, &status, WNOHANG) == 0) {
            if (++k == 500) kill(child_, SIGKILL);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return WIFSIGNALED(status) ? WTERMSIG(status) : -1;
    }

private:
    int ready_[2], go_on_[2];
    pid_t child_;
};

TEST(Interruption, AFileThatIsBeingWrittenIsFinishedNoneIsBegunAndNothingIsDoneAfterIt) {
    const Scratch scratch;
    Child child([&](auto wait) {
        bench::store::FreshFile file(scratch.path / "x");
        std::ofstream stream(file.path());
        stream << "whole";
        wait();
        std::thread([&scratch] { bench::store::write_fresh(scratch.path / "y", ""); }).detach();
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        stream.close();
        file.keep();
    });
    child.send(SIGTERM);
    EXPECT_TRUE(child.lives());
    child.go_on();
    EXPECT_EQ(child.end(), SIGTERM);
    EXPECT_EQ(content(scratch / "x"), "whole");
    EXPECT_EQ(scratch.files(), 1);
}

TEST(Interruption, ASecondSignalEndsAtOnceWhatTheFirstWaitsFor) {
    Child child([](auto wait) {
        const bench::store::WhenInterrupted never([] { _exit(1); });
        const bench::store::Undisturbed busy;
        wait();
    });
    child.send(SIGINT);
    EXPECT_TRUE(child.lives());
    child.send(SIGINT);
    EXPECT_EQ(child.end(), SIGINT);
}

// ---- What a program leaves that had no time to clean up

struct Left : Scratch {
    std::string file(const std::string& name, int hours) const {  // of that age
        std::ofstream(*this / name) << "half";
        fs::last_write_time(*this / name,
                            fs::file_time_type::clock::now() - std::chrono::hours(hours));
        return *this / name;
    }
};

TEST(Killed, PartsAreSweptAfterADayAndNothingElse) {
    const Left left;
    const bench::store::FreshFile own(left.path / "a.json");
    const std::string part = own.path().filename();
    const std::string swept = left.file(part + "1.part", 25);
    const std::string kept[] = {left.file(part, 23), left.file("d.json", 25),
                                left.file(part.substr(1), 25), left.file(".mine.part", 25)};
    bench::store::sweep_parts(left.path);
    bench::store::sweep_parts(left.path / "nowhere");
    EXPECT_FALSE(fs::exists(swept));
    for (const std::string& name : kept) EXPECT_TRUE(fs::exists(name)) << name;
}

TEST(Killed, ASuiteSweepsItsCells) {
    const Left left;
    fs::create_directories(left / "kept/cells");
    const std::string part = left.file("kept/cells/.jvari-0123456789abcdef.part", 25);
    std::ofstream(left / "a.toml")
        << suite_of("free_string", "modal_two_point", "44100", "duration = 0.01\nrepeats = 1");
    EXPECT_EQ(shell(left, "$J suite a.toml --out kept").code, 0);
    EXPECT_FALSE(fs::exists(part));
}

}  // namespace
}  // namespace jvari::test

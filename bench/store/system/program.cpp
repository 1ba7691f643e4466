#include "bench/store/system/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <optional>
#include <utility>

#include "bench/store/system/interruption.hpp"

namespace jvari::bench::store {

namespace {
constexpr int look_ms = 20;  // interval between two polls of a silent program
// the last bytes kept from the output, also the capacity of a pipe
constexpr std::size_t most_text = 1 << 16;

// Restores the default signal handling for the other program. This program blocks Ctrl-C
// (interruption.hpp) and ignores the signals of failed writing, and handles failed writing by error
// codes.
void unblock_signals() {
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
}

// Runs in the forked child of a program with threads, where only calls that are safe in a signal
// handler are allowed.
[[noreturn]] void become(char* const* argv, int out, pid_t parent) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // protects until the watcher runs
    if (getppid() != parent) _exit(127);
    unblock_signals();
    dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), 0);
    dup2(out, 1);
    dup2(out, 2);
    execvp(argv[0], argv);
    _exit(127);
}

class Group {  // process group: a program and its descendants
public:
    Group(char* const* argv, int out) {
        const pid_t parent = getpid();
        const Undisturbed starting;
        leader_ = fork();
        if (leader_ == 0) become(argv, out, parent);
        if (leader_ < 0) return;
        setpgid(leader_, leader_);  // called in parent and child, because either may run first
        killed_too_.emplace([leader = leader_] { kill(-leader, SIGKILL); });
    }
    ~Group() {
        if (leader_ > 0) end();
    }
    Group(const Group&) = delete;
    Group& operator=(const Group&) = delete;
    bool runs() const { return leader_ > 0; }
    pid_t leader() const { return leader_; }

    // Tests the leader without reaping the process: until then no other group can get the same
    // number.
    bool has_ended() const {
        siginfo_t info{};
        return waitid(P_PID, static_cast<id_t>(leader_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
               info.si_pid == leader_;
    }
    int end() {  // returns the leader's exit code
        kill(-leader_, SIGKILL);
        killed_too_.reset();
        const pid_t leader = std::exchange(leader_, -1);
        int status = 0;
        while (waitpid(leader, &status, 0) < 0)
            if (errno != EINTR) return -errno;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

private:
    pid_t leader_;
    std::optional<WhenInterrupted> killed_too_;
};

// Kills a group if this program dies in any way. A shell reads from a pipe, and only this program
// holds the other end. (PR_SET_PDEATHSIG reaches the leader, but not its children.)
class Watcher {
public:
    explicit Watcher(pid_t leader) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) return;
        end_ = ends[1];
        std::string group = std::to_string(leader);
        char shell[] = "/bin/sh", option[] = "-c", text[] = "read -r x; kill -9 \"-$0\"";
        char* const argv[] = {shell, option, text, group.data(), nullptr};
        const Undisturbed starting;
        pid_ = fork();
        if (pid_ == 0) {
            setpgid(0, 0);
            unblock_signals();
            dup2(ends[0], 0);
            dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), 1);
            dup2(1, 2);
            execv(argv[0], argv);
            _exit(127);
        }
        close(ends[0]);
    }
    ~Watcher() {
        if (pid_ > 0) {
            kill(pid_, SIGKILL);
            while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) continue;
        }
        if (end_ >= 0) close(end_);
    }
    Watcher(const Watcher&) = delete;
    Watcher& operator=(const Watcher&) = delete;

private:
    int end_ = -1;
    pid_t pid_ = -1;
};

class Pipe {
public:
    Pipe() : made_(pipe2(ends_, O_CLOEXEC) == 0) {
        if (made_) fcntl(ends_[0], F_SETFL, O_NONBLOCK);
    }
    ~Pipe() {
        for (const int end : ends_)
            if (end >= 0) close(end);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    explicit operator bool() const { return made_; }
    int in() const { return ends_[1]; }
    void close_in() { close(std::exchange(ends_[1], -1)); }

    void wait() const {
        pollfd there{ends_[0], POLLIN, 0};
        // a closed pipe usually means that the program ends soon
        poll(&there, open_ ? 1 : 0, open_ ? look_ms : 1);
    }
    void take(std::string& text) {  // appends available output
        char part[most_text];
        const ssize_t n = open_ ? read(ends_[0], part, sizeof part) : 0;
        open_ = n > 0 || (n < 0 && (errno == EAGAIN || errno == EINTR));
        if (n <= 0) return;
        text.append(part, static_cast<std::size_t>(n));
        if (text.size() > most_text) text.erase(0, text.size() - most_text);
    }

private:
    int ends_[2] = {-1, -1};
    bool made_, open_ = true;
};
}  // namespace

Said run_program(std::vector<std::string> words, const std::function<bool()>& unwanted) {
    std::vector<char*> argv;
    for (std::string& w : words) argv.push_back(w.data());
    argv.push_back(nullptr);
    Pipe pipe;
    if (!pipe) return {-errno, ""};
    Group group(argv.data(), pipe.in());
    if (!group.runs()) return {-errno, ""};
    pipe.close_in();
    const Watcher watcher(group.leader());
    Said output{};
    const WaitsForAnother counted;
    while (!group.has_ended() && !(unwanted && unwanted())) {
        pipe.wait();
        pipe.take(output.text);
    }
    output.code = group.end();
    pipe.take(output.text);
    return output;
}

}  // namespace jvari::bench::store

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

// Runs in a forked child of a program with threads, where only calls that are safe in a signal
// handler are allowed.
[[noreturn]] void become(char* const* argv, int out, pid_t parent) {
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    unblock_signals();
    dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), 0);
    dup2(out, 1);
    dup2(out, 2);
    execvp(argv[0], argv);
    _exit(127);
}

// Returns when `leader` has ended or SIGTERM came. The leader is not reaped: until then no other
// group can get its number. Orphans of the group become children of this process and are reaped.
void wait_for(pid_t leader, const sigset_t& signals) {
    for (;;) {
        siginfo_t child{};
        if (waitid(P_ALL, 0, &child, WEXITED | WNOHANG | WNOWAIT) == 0 && child.si_pid != 0) {
            if (child.si_pid == leader) return;
            waitpid(child.si_pid, nullptr, 0);
        } else if (sigwaitinfo(&signals, nullptr) == SIGTERM) {
            return;
        }
    }
}

// The supervisor: a process between this program and the other one. It ends with the other
// program's exit code. On SIGTERM, or when this program dies in any way, it kills the group of the
// other program, and reaps every process of it. The limits of `become` hold.
[[noreturn]] void supervise(char* const* argv, int out, pid_t parent) {
    prctl(PR_SET_NAME, "supervisor");  // `pkill -9 jvari` does not kill it
    setpgid(0, 0);
    signal(SIGCHLD, SIG_DFL);
    sigset_t all, heeded;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, nullptr);
    sigemptyset(&heeded);
    sigaddset(&heeded, SIGCHLD);
    sigaddset(&heeded, SIGTERM);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(127);
    const pid_t own = getpid(), leader = _Fork();
    if (leader == 0) become(argv, out, own);
    if (leader < 0) _exit(127);
    setpgid(leader, leader);  // called in parent and child, because either may run first
    close_range(0, ~0U, 0);
    wait_for(leader, heeded);
    kill(-leader, SIGKILL);
    int status = 0;
    waitpid(leader, &status, 0);
    while (waitpid(-leader, nullptr, 0) > 0) continue;
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
}

class Group {  // process group: a program and its descendants
public:
    Group(char* const* argv, int out) {
        const pid_t parent = getpid();
        const Undisturbed starting;
        supervisor_ = fork();
        if (supervisor_ == 0) supervise(argv, out, parent);
        if (supervisor_ > 0)
            killed_too_.emplace([this] {
                kill(supervisor_, SIGTERM);
                wait(0);
            });
    }
    ~Group() {
        if (runs()) end();
    }
    Group(const Group&) = delete;
    Group& operator=(const Group&) = delete;
    bool runs() const { return supervisor_ > 0; }
    bool has_ended() const { return wait(WNOHANG); }
    int end() {  // returns the exit code
        kill(supervisor_, SIGTERM);
        wait(0);
        killed_too_.reset();
        int status = 0;
        while (waitpid(supervisor_, &status, 0) < 0)
            if (errno != EINTR) return supervisor_ = -1, -errno;
        supervisor_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

private:
    bool wait(int options) const {  // does not reap, so that the number stays the supervisor's
        siginfo_t info{};
        int failed = 0;
        do {
            failed =
                waitid(P_PID, static_cast<id_t>(supervisor_), &info, WEXITED | WNOWAIT | options);
        } while (failed != 0 && errno == EINTR);
        return failed != 0 || info.si_pid == supervisor_;
    }

    pid_t supervisor_;
    std::optional<WhenInterrupted> killed_too_;
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

#include "bench/store/system/program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

extern char** environ;

namespace jvari::bench::store {

namespace {
struct Actions {
    explicit Actions(int out) {
        posix_spawn_file_actions_init(&it);
        posix_spawn_file_actions_addopen(&it, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&it, out, 1);
        posix_spawn_file_actions_adddup2(&it, 1, 2);
    }
    ~Actions() { posix_spawn_file_actions_destroy(&it); }
    Actions(const Actions&) = delete;
    Actions& operator=(const Actions&) = delete;
    posix_spawn_file_actions_t it;
};

// This program blocks Ctrl-C (interruption.hpp) and ignores the signals of failed writing, which are errors to it: not so the other.
struct Signals {
    Signals() {
        posix_spawnattr_init(&it);
        sigset_t none, held;
        sigemptyset(&none);
        sigemptyset(&held);
        sigaddset(&held, SIGPIPE);
        sigaddset(&held, SIGXFSZ);
        posix_spawnattr_setsigmask(&it, &none);
        posix_spawnattr_setsigdefault(&it, &held);
        posix_spawnattr_setflags(&it, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~Signals() { posix_spawnattr_destroy(&it); }
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;
    posix_spawnattr_t it;
};

std::string all_of(int file) {
    std::string text;
    char part[65536];
    for (ssize_t n; (n = read(file, part, sizeof part)) != 0;)
        if (n > 0) text.append(part, static_cast<std::size_t>(n));
        else if (errno != EINTR) break;
    return text;
}
}  // namespace

Said run_program(std::vector<std::string> words) {
    std::vector<char*> argv;
    for (std::string& w : words) argv.push_back(w.data());
    argv.push_back(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return {-errno, ""};
    pid_t child = 0;
    int failed;
    {
        const Actions actions(ends[1]);
        const Signals signals;
        failed = posix_spawnp(&child, argv[0], &actions.it, &signals.it, argv.data(), environ);
    }
    close(ends[1]);
    Said said{-failed, failed == 0 ? all_of(ends[0]) : ""};
    close(ends[0]);
    if (failed != 0) return said;
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return {-errno, ""};
    said.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return said;
}

}  // namespace jvari::bench::store

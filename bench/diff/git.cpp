#include "bench/diff/git.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

extern char** environ;

namespace jvari::bench::diff {

Said git(const std::filesystem::path& folder, const std::vector<std::string>& words) {
    std::vector<std::string> all{"git", "-C", folder.string()};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> argv;
    for (std::string& w : all) argv.push_back(w.data());
    argv.push_back(nullptr);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return {-errno, ""};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;  // Ctrl-C is for it as well: blocked in this program (interruption.hpp), not in that one
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, argv[0], &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    Said said{-failed, ""};
    char part[65536];
    for (ssize_t n; failed == 0 && (n = read(ends[0], part, sizeof part)) != 0;)
        if (n > 0) said.text.append(part, static_cast<std::size_t>(n));
        else if (errno != EINTR) break;
    close(ends[0]);
    if (failed != 0) return said;
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return {-errno, ""};
    said.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return said;
}

}  // namespace jvari::bench::diff

#include "bench/command/slurm/slurm_script.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "bench/store/usage.hpp"

namespace jvari::bench::command {

namespace {
namespace fs = std::filesystem;

std::string quoted(const std::string& word) {  // for a shell
    const char* plain = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_./-+,:@%=";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}
}  // namespace

std::string slurm_script(const suite::Suite& suite, const std::string& name, const std::string& out,
                         const std::vector<std::string>& plugins) {
    // a suite of the library stays a name, whatever stands under that name where the script runs
    std::vector<std::string> words{fs::read_symlink("/proc/self/exe").string(), "suite", suite.shelved ? name : fs::absolute(name).string(),
                                   "--out", fs::absolute(out).string()};
    for (const std::string& plugin : plugins) words.insert(words.end(), {"--plugin", fs::absolute(plugin).string()});
    std::string call;
    for (const std::string& word : words) {
        if (std::ranges::any_of(word, [](unsigned char c) { return c < ' ' || c == 127; }))
            throw store::UsageError(
                "--print slurm: a file name holds a control character, such as a line break, and no script can name it; rename the file");
        call += quoted(word) + " ";
    }
    return fmt::format(R"sh(#!/bin/sh
#SBATCH --array=1-8
#SBATCH --requeue --open-mode=append
# Tasks share the folder and take what nobody has; more or fewer of them change nothing but the time.
# Where the suite measures costs, add: #SBATCH --exclusive
exec {}--resume --jobs "${{SLURM_CPUS_PER_TASK:-1}}")sh",
                       call);
}

}  // namespace jvari::bench::command

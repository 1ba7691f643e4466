// The program: its help, and the verb of its command line.
#include "bench/command/program.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::command {

namespace {
constexpr const char* about =
    "jvari: numerical schemes for strings against obstacles, compared by speed and accuracy on the "
    "same scenes.";
constexpr const char* examples =
    "Examples\n"
    "  jvari new guitar my_guitar                              a commented scene to begin with\n"
    "  jvari list                                              what there is, and which scheme "
    "represents which scene\n"
    "  jvari run tanpura_c3 --scheme modal_two_point --out c3.wav\n"
    "  jvari run tanpura_c3 --scheme modal_two_point --rate 176400 --energy --set "
    "string.0.tension=40 --out c3.csv\n"
    "  jvari compare tanpura_c3_release --out report           every scheme that represents it, at "
    "44.1 kHz x 1 ... 64\n"
    "  jvari suite paper-deshmukh --out sitar --resume         a declared set of cells, taken up "
    "where it was stopped\n"
    "  jvari trim tanpura_c3_release --within 1% --out trimmed  no more than the scene needs: the "
    "cheapest model within 1 %\n"
    "  jvari certify tanpura_c3_release --duration 0.1         how far the references agree there\n"
    "  jvari report report                                     its page and picture once more\n"
    "  jvari diff results/smoke report                         what got worse, what got better\n"
    "  jvari judge tanpura_c3_release --trace 44100=mine.csv    how wrong is a trace of another "
    "program\n"
    "  jvari check --plugin libmine.so                         does a scheme of one's own keep the "
    "contract\n"
    "\n"
    "Exit codes: 0 done; 2 bad usage or bad scene; 3 the scheme refuses the scene; 4 the run "
    "failed, or its result could not be written (what was written stays valid).\n"
    "Ctrl-C leaves whole files only; compare and suite say how many cells are kept.";

constexpr const char* welcome =
    "jvari compares numerical schemes for a string that vibrates against an obstacle.\n"
    "\n"
    "  jvari new guitar my_guitar            write a commented scene, my_guitar.toml; also "
    "tanpura, sitar, bass, piano\n"
    "  jvari run my_guitar.toml --scheme modal_two_point --out my_guitar.wav        hear it\n"
    "  jvari compare my_guitar.toml --out report      which scheme, at which rate, and how wrong "
    "is it?\n"
    "  jvari list                            the schemes, references and scenes that there are\n"
    "\n"
    "`jvari --help` lists every verb, `jvari help compare` teaches one.";

// `jvari help run` asks what `jvari run --help` asks.
std::vector<std::string> words_of(int argc, const char* const* argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (words.empty() || words.front() != "help") return words;
    return words.size() > 1 ? std::vector<std::string>{words[1], "--help"}
                            : std::vector<std::string>{"--help"};
}
}  // namespace

int call(int argc, const char* const* argv) {
    CLI::App program(about, "jvari");
    program.footer(examples);
    program.require_subcommand(1);
    program.set_version_flag("--version", fmt::format("jvari {} ({})", store::machine().version,
                                                      store::machine().commit));
    program.get_formatter()->column_width(34);
    std::vector<Act> acts;
    for (const auto add : verbs) acts.push_back(add(program));
    std::vector<std::string> names;
    for (const CLI::App* verb : program.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(verb->get_name());

    std::vector<std::string> words = words_of(argc, argv);
    if (words.empty()) {
        Console(false, false).print(welcome);
        return exit_code::bad_usage;
    }
    const std::string verb = words.front().starts_with("-") ? "" : words.front();
    const auto chosen = std::ranges::find(names, verb);
    if (!verb.empty() && chosen == names.end())
        throw store::UsageError(store::unknown("verb", verb, names));
    try {
        std::ranges::reverse(words);  // as CLI11 takes them
        program.parse(std::move(words));
    } catch (const CLI::Success& help) {
        std::ostringstream text, nothing;
        program.exit(help, text, nothing);
        Console(false, false).print(text.str().substr(0, text.str().find_last_not_of('\n') + 1));
        return exit_code::done;
    } catch (const CLI::ParseError& e) {
        const std::vector<std::string> all = words_of(argc, argv);
        const char* behind =
            std::ranges::find(all, "--") == all.end() ? "" : "; what stands behind -- is no option";
        throw store::UsageError(fmt::format("{}{} (see jvari {}--help)", e.what(), behind,
                                            verb.empty() ? "" : verb + " "));
    }
    return acts[static_cast<std::size_t>(chosen - names.begin())]();
}

}  // namespace jvari::bench::command

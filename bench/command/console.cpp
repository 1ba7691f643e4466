#include "bench/command/console.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "bench/command/verbs.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/system/interruption.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::command {

namespace {
using namespace std::chrono_literals;

void clear_line() { std::fputs("\r\033[K", stderr); }

// Colours repeat the marks of a line on a terminal that accepts colours (https://no-color.org).
bool in_colour(int stream) {
    const char *no = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
    return isatty(stream) != 0 && !(no && *no) && !(terminal && std::strcmp(terminal, "dumb") == 0);
}

const char* colour_of(store::Mark mark) {
    constexpr const char* colours[] = {"", "\033[32m", "\033[33m", "\033[31m", "\033[1m"};
    return colours[static_cast<int>(mark)];
}

// Replaces control characters by question marks, because names and notes come from files and
// plugins and could steer the terminal.
std::string harmless(std::string text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]),
                   before = static_cast<unsigned char>(i > 0 ? text[i - 1] : 0);
        if ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7f) text[i] = '?';
        else if (before == 0xc2 && c >= 0x80 && c < 0xa0) text[i - 1] = text[i] = '?';
    }
    return text;
}

std::string coloured(const store::Lines& lines, int stream) {
    std::string all;
    for (const auto& [text, mark] : lines) {
        const std::string colour = in_colour(stream) ? colour_of(mark) : "";
        all += colour + harmless(text) + (colour.empty() ? "" : "\033[0m") + "\n";
    }
    return all;
}

std::FILE* own_output = stdout;

void put(const store::Lines& lines) {
    const std::string text = coloured(lines, STDOUT_FILENO);
    if (std::fwrite(text.data(), 1, text.size(), own_output) != text.size() ||
        std::fflush(own_output) != 0)
        throw store::Unwritable(
            fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

std::optional<std::size_t> columns_of(int terminal) {
    winsize size{};
    if (ioctl(terminal, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return {};
    return size.ws_col;
}

// Progress line: rewritten in place on a terminal, elsewhere printed every ten seconds.
class Line : public store::Progress {
public:
    explicit Line(std::string job) : job_(std::move(job)) {}
    ~Line() override {
        {
            const std::scoped_lock lock(mutex_);
            ended_ = true;
        }
        end_.notify_one();
        clock_.join();
        if (shown_) clear_line();
    }
    void show(double fraction, const std::string& what) override {
        const std::scoped_lock lock(mutex_);
        text_ = fmt::format("{} {:3.0f} % {}", job_, 100 * fraction, what);
        write();
    }

private:
    void write() {  // writes text_ if it is due
        const auto now = std::chrono::steady_clock::now();
        if (text_.empty() || now - start_ < 2s || now - last_ < pause_) return;
        last_ = now;
        const std::string line = harmless(
            fmt::format("{}, {} s", text_,
                        std::chrono::duration_cast<std::chrono::seconds>(now - start_).count()));
        if (!terminal_) return write_error(line);
        const store::Undisturbed whole;
        if (!shown_) shown_.emplace(clear_line);
        // A wrapped line could not be rewritten in place.
        std::fputs(
            ("\r\033[K" + line.substr(0, columns_of(STDERR_FILENO).value_or(80) - 1)).c_str(),
            stderr);
        std::fflush(stderr);
    }

    std::string job_, text_;
    const bool terminal_ = isatty(STDERR_FILENO) != 0;
    const std::chrono::milliseconds pause_ = terminal_ ? 200ms : 10000ms;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), last_ = start_;
    std::optional<store::WhenInterrupted> shown_;  // clears the line at an interruption
    std::mutex mutex_;                             // guards the members above
    std::condition_variable end_;
    bool ended_ = false;
    // Updates the line for a job that reports nothing during a long part.
    std::thread clock_{[this] {
        std::unique_lock lock(mutex_);
        while (!end_.wait_for(lock, pause_, [this] { return ended_; })) write();
    }};
};
}  // namespace

void hold_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) != stream)
            _exit(exit_code::run_failed);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

void keep_standard_output() {
    const int own = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    std::FILE* file = own < 0 ? nullptr : fdopen(own, "w");
    if (!file) return;
    own_output = file;
    dup2(STDERR_FILENO, STDOUT_FILENO);
}

void write_error(const std::string& line, store::Mark mark) {
    std::fputs(coloured({{line, mark}}, STDERR_FILENO).c_str(), stderr);
}

void Console::note(const std::string& text) const {
    if (!quiet_) write_error(text);
}

void Console::warn(const std::string& text) const {
    if (!quiet_) write_error("warning: " + text, store::Mark::doubtful);
}

void Console::print(const store::Lines& lines) const {
    if (!json_ && !quiet_) put(lines);
}

void Console::print_json(const std::string& text) const {
    if (json_) put({{text}});
}

std::size_t Console::width() {
    const char* wanted = std::getenv("COLUMNS");
    if (const std::size_t columns = wanted ? std::strtoul(wanted, nullptr, 10) : 0; columns > 0)
        return columns;
    return columns_of(STDOUT_FILENO).value_or(std::numeric_limits<std::size_t>::max());
}

std::unique_ptr<store::Progress> Console::begin(const std::string& job) const {
    return quiet_ ? Listener::begin(job) : std::make_unique<Line>(job);
}

int fail(bool json, int code, const char* status, const std::string& message) {
    write_error("jvari: " + message, store::Mark::error);
    try {
        Console(json, false)
            .print_json(
                store::indented({{"status", status}, {"message", message}, {"exit_code", code}}));
    } catch (const store::Unwritable&) {  // the exit code reports the failure
    }
    return code;
}

// ---- The program: its help, and the verb on its command line.

namespace {
constexpr std::size_t widest = 100;  // columns of help

constexpr const char* about =
    "jvari: numerical schemes for strings against obstacles, compared by speed and accuracy on the "
    "same scenes.";
constexpr const char* examples =
    "Examples\n"
    "  jvari new guitar my_guitar                              a commented scene to begin with\n"
    "  jvari list                                              what there is, and which scheme "
    "represents which scene\n"
    "  jvari run tanpura_c3 --scheme modal_two_point --out c3.wav\n"
    "  jvari run tanpura_c3 --scheme modal_two_point --rate 176400 --set "
    "string.0.tension=40 --out c3.csv\n"
    "  jvari compare tanpura_c3_release --out report           every scheme that represents it, at "
    "44.1 kHz x 1 ... 64\n"
    "  jvari suite paper-deshmukh --out sitar --resume         a declared set of cells, taken up "
    "where it was stopped\n"
    "  jvari trim tanpura_c3_release --within 1% --out trimmed  no more than the scene needs: the "
    "cheapest model within 1 %\n"
    "  jvari certify tanpura_c3_release --duration 0.1         how well its reference is known\n"
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

// Names what unexpected words were meant for: the nearest options, a scheme, or a name in one word.
std::string meant_by(const CLI::App& verb) {
    std::vector<std::string> options, near;
    for (const CLI::Option* o : verb.get_options())
        for (const std::string& name : o->get_lnames()) options.push_back("--" + name);
    std::string word;
    for (const std::string& extra : verb.remaining()) {
        const std::string option = nearest(extra.substr(0, extra.find('=')), options);
        if (extra.starts_with("--") && !option.empty()) near.push_back(option);
        else if (!extra.starts_with("-")) word = extra;
    }
    if (!near.empty()) return fmt::format("; did you mean {}?", fmt::join(near, " and "));
    if (word.empty()) return "";
    if (verb.get_name() == "new") return "; a name is one word, as my_" + word;
    const bool runs = std::ranges::find(options, "--scheme") != options.end();
    return runs ? fmt::format("; did you mean --scheme {}?", word) : "";
}

// `jvari help run` is the same request as `jvari run --help`.
std::vector<std::string> words_of(int argc, const char* const* argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    if (words.empty() || words.front() != "help") return words;
    return words.size() > 1 ? std::vector<std::string>{words[1], "--help"}
                            : std::vector<std::string>{"--help"};
}
}  // namespace

std::string wrapped(const std::string& text) {
    std::string all;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t indent = std::min(line.find_first_not_of(' '), line.size()),
                          gap = line.find("  ", indent),
                          column = gap < widest - 40 ? line.find_first_not_of(' ', gap) : indent;
        for (std::size_t end; line.size() > widest && (end = line.rfind(' ', widest)) > column &&
                              end != std::string::npos;) {
            all += line.substr(0, end) + "\n";
            line = std::string(column, ' ') + line.substr(end + 1);
        }
        if (!line.empty() || !all.ends_with("\n\n")) all += line + "\n";
    }
    return all.substr(0, all.find_last_not_of('\n') + 1);
}

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
    if (words.front() == "version" || words.front() == "-v")
        throw store::UsageError(
            fmt::format("unknown verb \"{}\"; did you mean --version?", words.front()));
    if (!verb.empty() && chosen == names.end())
        throw store::UsageError(store::unknown("verb", verb, names) +
                                (words.back() == "--help" && nearest(verb, names).empty()
                                     ? fmt::format("; did you mean jvari list {}?", verb)
                                     : ""));
    try {
        std::ranges::reverse(words);  // CLI11 expects reverse order
        program.parse(std::move(words));
    } catch (const CLI::Success& help) {
        std::ostringstream text, nothing;
        program.exit(help, text, nothing);
        Console(false, false).print(wrapped(text.str()));
        return exit_code::done;
    } catch (const CLI::ParseError& e) {
        const std::vector<std::string> all = words_of(argc, argv);
        const char* behind =
            std::ranges::find(all, "--") == all.end() ? "" : "; what stands behind -- is no option";
        const std::string meant =
            dynamic_cast<const CLI::ExtrasError*>(&e) != nullptr && chosen != names.end()
                ? meant_by(*program.get_subcommand(verb))
                : "";
        throw store::UsageError(fmt::format("{}{}{} (see jvari {}--help)", e.what(), behind, meant,
                                            verb.empty() ? "" : verb + " "));
    }
    return acts[static_cast<std::size_t>(chosen - names.begin())]();
}

}  // namespace jvari::bench::command

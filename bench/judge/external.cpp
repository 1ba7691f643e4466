#include "bench/judge/judge.hpp"

#include <fmt/core.h>
#include <wordexp.h>

#include <cctype>
#include <chrono>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <sstream>
#include <vector>

#include "bench/compare/catalogue.hpp"
#include "bench/store/encoding.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/system/program.hpp"
#include "bench/store/usage.hpp"
#include "schemes/making.hpp"
#include "schemes/open/problem.hpp"
#include "schemes/registry.hpp"

namespace jvari::bench::judge {

namespace {
namespace fs = std::filesystem;

constexpr int refuses = 3;  // exit code if the program cannot represent the problem

struct External {
    std::string command, name;
};

std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) last = line;
    return last;
}

using Unwanted = std::function<bool()>;

store::Said run_external(const External& e, std::vector<std::string> arguments,
                         const Unwanted& unwanted) {
    std::vector<std::string> words{"sh", "-c", e.command + " \"$@\"", "sh"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return store::run_program(std::move(words), unwanted);
}

std::shared_ptr<const Trace> computed(const External& e, const Exported& of,
                                      const std::string& problem, const Unwanted& unwanted) {
    const store::Scratch folder;
    if (folder.path.empty())
        throw store::Unwritable("cannot make a folder in " + store::Scratch::place().string());
    const fs::path problem_file = folder.path / "problem.json", given = folder.path / "trace.csv";
    store::write_fresh(problem_file, problem);
    const store::Said output = run_external(e, {problem_file.string(), given.string()}, unwanted);
    if (output.code == refuses)
        throw Refusal(fmt::format("{}: {}", e.name, last_line(output.text)));
    if (output.code != 0)
        throw BadScheme(
            fmt::format("{}: exit code {}: {}", e.command, output.code, last_line(output.text)));
    if (!fs::exists(given))
        throw BadScheme(e.command +
                        ": wrote no trace, its last argument; it said: " + last_line(output.text));
    return std::make_shared<const Trace>(
        read_trace(given, of.scene, of.settings.tap_rate, rows_of(of.scene, of.settings)));
}

// Computes each problem only once and stores its trace, refusal or failure: the search runs a cell,
// then its errors are measured, and some cells are run again.
std::shared_ptr<const Trace> known(const External& e, const Exported& of,
                                   const Unwanted& unwanted) {
    struct Each {
        std::once_flag once;
        std::shared_ptr<const Trace> trace;
        std::exception_ptr failure;
    };
    static std::mutex mutex;  // guards `all`
    static std::map<std::string, Each> all;
    const std::string problem = problem_json(of, nullptr);
    std::unique_lock lock(mutex);
    Each& each = all[store::hash_of(e.command + problem)];
    lock.unlock();
    std::call_once(each.once, [&] {  // other callers wait meanwhile
        try {
            each.trace = computed(e, of, problem, unwanted);
        } catch (const std::exception&) {
            if (unwanted()) throw;  // the call was stopped: the next caller repeats it
            each.failure = std::current_exception();
        }
    });
    if (each.failure) std::rethrow_exception(each.failure);
    return each.trace;
}

class Called final : public Scheme {
public:
    Called(const External& e, const Scene& scene, const Settings& settings)
        : external_(e), of_{scene, settings} {
        refuse_beyond_arrays(scene);
        dofs_ = 2 * modes_for(scene, settings);
    }
    void reset() noexcept override {
        if (rows_) rows_->reset();
    }
    Status advance(const Block& out) noexcept override {
        try {
            if (!rows_) rows_ = played(known(external_, of_, [&out] { return out.stopped(); }));
            return rows_->advance(out);
        } catch (const std::exception& e) {
            refused_ = dynamic_cast<const Refusal*>(&e) != nullptr;
            failure_ = e.what();
            for (int k = 0; k < out.taps; ++k)
                std::fill_n(out.tap + k * out.stride, out.rows,
                            std::numeric_limits<double>::quiet_NaN());
            return {};
        }
    }
    int dofs() const override { return dofs_; }
    std::vector<Fact> facts() const override {
        if (refused_) throw Refusal(failure_);
        if (!failure_.empty()) throw BadScheme(failure_);
        return {};
    }

private:
    const External& external_;
    Exported of_;
    std::unique_ptr<Scheme> rows_;
    std::string failure_;
    bool refused_ = false;
    int dofs_;
};

std::unique_ptr<Scheme> called(const Descriptor& d, const Scene& scene, const Settings& settings) {
    return std::make_unique<Called>(*static_cast<const External*>(d.own), scene, settings);
}

// Splits the command into words like a shell, operators excluded. Empty if only the shell can tell.
std::vector<std::string> words_in(std::string command) {
    char quote = 0;
    for (std::size_t k = 0; k < command.size(); ++k) {
        char& c = command[k];
        if (c == '\\' && quote != '\'') ++k;
        else if (quote != 0 ? c == quote : c == '"' || c == '\'') quote = quote != 0 ? '\0' : c;
        else if (quote == 0 && std::strchr("|&;<>()`\n", c)) c = ' ';
    }
    wordexp_t all{};
    std::vector<std::string> words;
    if (wordexp(command.c_str(), &all, WRDE_NOCMD) == 0)
        words.assign(all.we_wordv, all.we_wordv + all.we_wordc);
    wordfree(&all);
    return words;
}

// Finds the file that a word names, or the program on the PATH; "" if there is neither.
fs::path file_of(const std::string& word) {
    std::error_code error;
    if (fs::is_regular_file(word, error)) return word;
    const char* folders = std::getenv("PATH");
    std::istringstream path(folders && word.find('/') == std::string::npos ? folders : "");
    for (std::string folder; std::getline(path, folder, ':');)
        if (const fs::path file = fs::path(folder) / word; fs::is_regular_file(file, error))
            return file;
    return {};
}
}  // namespace

std::string enter_external(const std::string& command) {
    const std::string path = "external " + command;
    std::string name = "external", contents = command;
    for (const std::string& word : words_in(command)) {
        const fs::path file = file_of(word);
        contents +=
            fmt::format("\n{}: {}", word, file.empty() ? "no file" : store::hash_of_file(file));
        if (!file.empty() && file == fs::path(word)) name = file.stem().string();
    }
    // Refuses a misspelt file name in the last word of the command.
    const std::vector<std::string> words = words_in(command);
    const std::string ending = words.empty() ? "" : fs::path(words.back()).extension().string();
    if (name == "external" && ending.size() > 1 && ending.size() < 5 &&
        std::isalpha(static_cast<unsigned char>(ending[1])) != 0)
        throw store::UsageError("--external " + command + ": there is no file " + words.back());
    const auto kept = std::make_shared<External>(External{command, name});
    Descriptor d{kept->name.c_str(),
                 "an external command",
                 every_feature - (Features(Feature::moving_body) | Feature::polarisation),
                 Balance::none,
                 Clock::stepped,
                 called};
    d.own = kept.get();
    d.untimed = "external, not compared";
    add_guest({path, {d}, contents, kept, "external", command});
    return path;
}

bool is_external(const Descriptor& d) { return d.make == called; }

Descriptor declared(const Descriptor& d) {
    if (!is_external(d)) return d;
    const auto start = std::chrono::steady_clock::now();
    const store::Said output = run_external(
        *static_cast<const External*>(d.own), {"represents"},
        [start] { return std::chrono::steady_clock::now() - start > std::chrono::seconds(10); });
    Descriptor answered = d;
    std::istringstream lines(output.code == 0 ? output.text : "");
    for (std::string line; std::getline(lines, line);) {
        const std::string value = line.substr(std::min(line.find(": ") + 2, line.size()));
        if (line.starts_with("balance: ")) answered.balance = compare::balance_of(value);
        if (!line.starts_with("represents: ")) continue;
        std::vector<std::string> names;
        std::istringstream parts(value);
        for (std::string name; std::getline(parts >> std::ws, name, ',');) names.push_back(name);
        answered.represents = compare::features_of(names);
    }
    return answered;
}

}  // namespace jvari::bench::judge

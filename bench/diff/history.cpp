#include "bench/diff/history.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/store/json.hpp"
#include "bench/store/system/program.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::diff {

namespace fs = std::filesystem;

namespace {
using Json = nlohmann::ordered_json;

store::Said git(const fs::path& folder, const std::vector<std::string>& words) {
    std::vector<std::string> all{"git", "-C", folder.string()};
    all.insert(all.end(), words.begin(), words.end());
    return store::run_program(std::move(all), store::Errors::left_out);
}

std::string commits_of(const fs::path& folder) {  // a line each, oldest first: hash, date and subject between tabs
    std::error_code error;
    if (!fs::is_directory(folder, error)) throw store::UsageError(fmt::format("{}: no such folder", folder.string()));
    const store::Said inside = git(folder, {"rev-parse", "--is-inside-work-tree"});
    if (inside.code == -ENOENT) throw store::UsageError("--history: git is missing (Debian: apt-get install git)");
    if (inside.code != 0) throw store::UsageError(fmt::format("--history: {} lies in no git repository", folder.string()));
    const store::Said log = git(folder, {"log", "--reverse", "--format=%h%x09%as%x09%s", "--", "."});
    if (log.code != 0 || log.text.empty()) throw store::UsageError(fmt::format("--history: no commit has changed {}", folder.string()));
    return log.text;
}

Folder folder_at(const fs::path& folder, const std::string& commit) {
    return read_folder({commit, [&](const std::string& file) -> std::optional<std::string> {
                            store::Said shown = git(folder, {"show", commit + ":./" + file});
                            if (shown.code != 0) return std::nullopt;
                            return std::move(shown.text);
                        }});
}
}  // namespace

std::vector<Step> history(const fs::path& folder, const store::Listener& listener) {
    std::vector<Step> steps;
    std::istringstream lines(commits_of(folder));
    for (std::string line; std::getline(lines, line);) {
        const auto one = line.find('\t'), two = line.find('\t', one + 1);
        if (two != std::string::npos)
            steps.push_back({line.substr(0, one), line.substr(one + 1, two - one - 1), line.substr(two + 1), {}, ""});
    }
    const auto progress = listener.begin("history");
    std::optional<Folder> before;
    int done = 0;
    for (Step& step : steps) {
        progress->show(static_cast<double>(done++) / steps.size());
        try {
            Folder now = folder_at(folder, step.commit);
            if (before) step.change = difference(*before, now);
            before = std::move(now);
        } catch (const store::UsageError& e) {
            step.why = e.what();
        }
    }
    return steps;
}

std::string text_of(const std::vector<Step>& steps) {
    std::string text =
        fmt::format("{:<10} {:<12} {:>6} {:>6} {:>6} {:>6}  {}\n", "date", "commit", "worse", "better", "moved", "cells", "");
    for (const Step& s : steps) {
        text += fmt::format("{:<10} {:<12} ", s.date, s.commit);
        if (s.change)
            text += fmt::format("{:>6} {:>6} {:>6} {:>6}", s.change->count(Turn::worse), s.change->count(Turn::better),
                                s.change->count(Turn::moved), s.change->cells_in_both);
        else text += fmt::format("{:>27}", s.why.empty() ? "the first" : "not compared");
        text += fmt::format("  {}\n", s.subject);
        if (!s.why.empty()) text += fmt::format("{:<23} {}\n", "", s.why);
        if (!s.change) continue;
        if (!s.change->cells.before.empty() || !s.change->cells.after.empty())
            text += fmt::format("{:<23} {} cells went, {} came\n", "", s.change->cells.before.size(), s.change->cells.after.size());
        for (const Finding& f : s.change->findings)
            if (f.turn == Turn::worse) {
                text += fmt::format("{:<23} worse: {} {} {} -> {}\n", "", f.row, f.column, f.before, f.after);
                break;
            }
    }
    text.pop_back();
    return text;
}

std::string json_of(const std::vector<Step>& steps) {
    Json all = Json::array();
    for (const Step& s : steps) {
        Json j{{"commit", s.commit}, {"date", s.date}, {"subject", s.subject}};
        if (!s.why.empty()) j["not_compared"] = s.why;
        if (s.change) {
            const Difference& d = *s.change;
            j.update({{"worse", d.count(Turn::worse)},
                      {"better", d.count(Turn::better)},
                      {"moved", d.count(Turn::moved)},
                      {"cells_in_both", d.cells_in_both},
                      {"cells_gone", d.cells.before.size()},
                      {"cells_new", d.cells.after.size()}});
        }
        all.push_back(j);
    }
    return store::indented({{"status", "ok"}, {"history", all}});
}

}  // namespace jvari::bench::diff

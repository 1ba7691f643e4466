// jvari verify: does a record come back? Runs what a folder of results says that it was made by, and compares field by field.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/diff/difference.hpp"
#include "bench/store/folder.hpp"
#include "bench/store/json.hpp"
#include "bench/store/machine.hpp"
#include "bench/store/system/program.hpp"
#include "bench/store/usage.hpp"

namespace jvari::bench::command {

namespace {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct VerifyRequest : Common {
    std::string folder, out;
};

std::vector<std::string> words_of(const std::string& command) {  // as store::made_by writes them: a word with blanks in quotes
    std::vector<std::string> words{""};
    bool quoted = false;
    for (const char c : command)
        if (c == '\'') quoted = !quoted;
        else if (c == ' ' && !quoted) words.emplace_back();
        else words.back() += c;
    return words;
}

// The same command by this program, into another folder.
std::vector<std::string> again(const Json& manifest, const std::string& folder, const fs::path& out) {
    const std::string command = manifest.value("command", "");
    std::vector<std::string> words = words_of(command);
    const auto at = std::ranges::find(words, "--out");
    if (words.size() < 3 || at == words.end() || at + 1 == words.end() || (words[1] != "suite" && words[1] != "compare"))
        throw store::UsageError(folder + "/manifest.json: found the command \"" + command +
                                "\", expected jvari suite or compare with --out");
    *(at + 1) = out.string();
    std::erase(words, "--resume");
    words[0] = "/proc/self/exe";
    std::error_code error;
    if (const fs::path self = fs::read_symlink(words[0], error); !error) words[0] = self.string();
    return words;
}

bool of_this_program(const Json& manifest) {
    const store::Machine& m = store::machine();
    return manifest.value("sources", "") == m.cell_sources && manifest.value("compiler", "") == m.compiler &&
           manifest.value("flags", "") == m.flags && manifest.value("build", "") == m.build && manifest.value("vectors", "") == m.vectors;
}

struct Returned {
    int same = 0, moved = 0;  // fields to the last digit, and others
};
Returned returned(const store::Table& before, const store::Table& after) {
    Returned r;
    const bool with_modes = diff::modes_name(before) || diff::modes_name(after);
    const diff::Named old = diff::named_cells(before, with_modes, true), now = diff::named_cells(after, with_modes, true);
    for (const auto& [name, i] : old)
        if (const auto found = now.find(name); found != now.end())
            for (const std::string& column : before.columns)
                if (!diff::is_cost(column) && !diff::is_skipped(column))
                    ++(before.at(i, column) == after.at(found->second, column) ? r.same : r.moved);
    return r;
}

// An error that moved lies within the certificates of both sides: neither knows the true one better.
bool is_lost(const diff::Finding& f) {
    return f.turn != diff::Turn::same && !diff::is_cost(f.column) && !(f.turn == diff::Turn::moved && diff::is_judged(f.column));
}

int verify_command(VerifyRequest r) {
    const Console console(r.json, r.quiet);
    const Json manifest = store::folder_at(r.folder).manifest();
    const fs::path out = r.out.empty() ? fs::temp_directory_path() / ("jvari-verify-" + store::now_utc()) : fs::path(r.out);
    const std::vector<std::string> words = again(manifest, r.folder, out);
    const bool same = of_this_program(manifest);
    console.note(fmt::format("runs {} again, {}", manifest.value("command", ""),
                             same ? "by the same program: every field should come back to the last digit"
                                  : "by another program or other vector instructions: fields should come back within their uncertainty"));
    if (const store::Said said = store::run_program(words, store::Errors::with_the_rest); said.code != 0)
        throw store::UsageError(fmt::format("{}: its command fails with exit code {}: {}", r.folder, said.code, said.text));
    const diff::Folder before = diff::read_folder(fs::path(r.folder)), after = diff::read_folder(out);
    const diff::Difference d = diff::difference(before, after);
    const Returned back = returned(before.cells, after.cells);
    const int lost = static_cast<int>(std::ranges::count_if(d.findings, is_lost)) + d.missing();
    const bool whole = lost == 0 && d.references.empty() && !(same && back.moved > 0);
    console.print(fmt::format("{}{} of {} cells came back: {} fields to the last digit, {} within their uncertainty, {} did not{}",
                              d.references.empty() ? "" : d.references + "\n", d.cells_in_both, before.cells.rows.size(), back.same,
                              std::max(0, back.moved - lost), lost, whole ? "" : "\n" + diff::text_of(d, before, after)));
    if (r.out.empty()) {
        std::error_code gone;
        fs::remove_all(out, gone);
    }
    console.print_json(store::indented({{"folder", r.folder},
                                        {"same_program", same},
                                        {"references", d.references},
                                        {"to_the_last_digit", back.same},
                                        {"within_uncertainty", std::max(0, back.moved - lost)},
                                        {"lost", lost}}));
    return lost > 0 || (same && back.moved > 0) ? exit_code::run_failed : exit_code::done;
}
}  // namespace

Act verify_verb(CLI::App& program) {
    Verb<VerifyRequest> v(program, "verify", "runs a folder of results again, and says what came back");
    v.option("folder", v.r.folder, {"DIR"}, "a folder that compare or suite wrote: its manifest.json has the command")->required();
    v.option("--out", v.r.out, {"DIR"}, "keeps the second run in this folder; absent: it is removed");
    return v.does(verify_command,
                  "Example: jvari verify results/smoke\n"
                  "\n"
                  "On the program that made the folder every field comes back to the last digit; on another, within its own uncertainty.\n"
                  "Exit code 4 where something did not. Costs are not compared.");
}

}  // namespace jvari::bench::command

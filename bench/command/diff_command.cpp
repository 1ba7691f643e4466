// jvari diff: what changed between two folders of results, or over the commits of one.
#include "bench/command/console.hpp"
#include "bench/command/text_table.hpp"
#include "bench/command/verbs.hpp"
#include "bench/diff/difference.hpp"
#include "bench/diff/history.hpp"

namespace jvari::bench::command {

namespace {
struct DiffRequest : Common {
    std::string before, after;  // folders
    std::string history;        // one folder, in place of the two
};

int diff_command(DiffRequest r) {
    if (r.history.empty() && r.after.empty())
        throw store::UsageError("diff: expected two folders, or --history DIR (see jvari diff --help)");
    const Console console(r.json, r.quiet);
    if (!r.history.empty()) {
        const auto steps = diff::history(r.history, console);
        console.print(wrapped(diff::text_of(steps), Console::width()));
        console.print_json(diff::json_of(steps));
        return exit_code::done;
    }
    const std::filesystem::path a = r.before, b = r.after;
    const diff::Folder before = diff::read_folder(a), after = diff::read_folder(b);
    const diff::Difference d = diff::difference(before, after);
    console.print(wrapped(diff::text_of(d, before, after), Console::width()));
    console.print_json(diff::json_of(d, before, after));
    return d.worse() ? exit_code::run_failed : exit_code::done;
}
}  // namespace

Act diff_verb(CLI::App& program) {
    Verb<DiffRequest> v(program, "diff", "two folders of results: what got worse, what got better, what only one has");
    CLI::Option *before = v.option("before", v.r.before, {"A"}, "a folder that compare or suite wrote"),
                *after = v.option("after", v.r.after, {"B"}, "another, of the same scene or suite");
    v.option("--history", v.r.history, {"DIR"}, "one folder in place of two: each commit that changed it against the one before")
        ->excludes(before);
    before->needs(after);
    return v.does(
        diff_command,
        "Example: jvari diff results/smoke report\n"
        "\n"
        "Exit code 4 where something got worse: an error by more than noise and certificates, a certificate, a status, an outcome of a "
        "map,\n"
        "or the cost of a scheme beyond its quartiles and the drift of all; and where a cell of A is missing in B. Costs of two machines\n"
        "are not compared.");
}

}  // namespace jvari::bench::command

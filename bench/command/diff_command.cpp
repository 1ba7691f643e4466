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

int diff_command(const DiffRequest& r) {
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
    const auto r = std::make_shared<DiffRequest>();
    CLI::App* verb = program.add_subcommand("diff", "two folders of results: what got worse, what got better, what only one has");
    auto* before = verb->add_option("before", r->before, "a folder that compare or suite wrote")->type_name("A");
    auto* after = verb->add_option("after", r->after, "another, of the same scene or suite")->type_name("B");
    verb->add_option("--history", r->history, "one folder in place of two: each commit that changed it against the one before")
        ->type_name("DIR")
        ->excludes(before);
    before->needs(after);
    verb->footer(
        "Example: jvari diff results/smoke report\n"
        "\n"
        "Exit code 4 where something got worse: an error by more than noise and certificates, a certificate, a status, an outcome of a "
        "map,\n"
        "or the cost of a scheme beyond its quartiles and the drift of all; and where a cell of A is missing in B. Costs of two machines\n"
        "are not compared.");
    add_common(*verb, *r);
    return [r] { return diff_command(*r); };
}

}  // namespace jvari::bench::command

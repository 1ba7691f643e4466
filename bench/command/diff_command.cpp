// jvari diff: what changed between two folders of results.
#include "bench/command/console.hpp"
#include "bench/command/text_table.hpp"
#include "bench/command/verbs.hpp"
#include "bench/diff/difference.hpp"

namespace jvari::bench::command {

namespace {
struct DiffRequest : Common {
    std::string before, after;  // folders
};

int diff_command(DiffRequest r) {
    const Console console(r.json, r.quiet);
    const diff::Folder before = diff::read_folder(r.before), after = diff::read_folder(r.after);
    const diff::Difference d = diff::difference(before, after);
    console.print(wrapped(diff::text_of(d, before, after), Console::width()));
    console.print_json(diff::json_of(d, before, after));
    return d.worse() ? exit_code::run_failed : exit_code::done;
}
}  // namespace

Act diff_verb(CLI::App& program) {
    Verb<DiffRequest> v(
        program, "diff",
        "two folders of results: what got worse, what got better, what only one has");
    v.option("before", v.r.before, {"A"}, "a folder that compare or suite wrote")->required();
    v.option("after", v.r.after, {"B"}, "another, of the same scene or suite")->required();
    return v.does(diff_command,
                  "Example: jvari diff results/smoke report\n"
                  "\n"
                  "Exit code 4 where something got worse: an error by more than noise and "
                  "certificates, a certificate, a status, an outcome of a "
                  "map,\n"
                  "or the cost of a scheme beyond its quartiles and the drift of all; and where a "
                  "cell of A is missing in B. Costs of two machines\n"
                  "are not compared.");
}

}  // namespace jvari::bench::command

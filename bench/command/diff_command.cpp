// jvari diff: what changed between two folders of results, or over the commits of one.
#include "bench/command/commands.hpp"
#include "bench/command/console.hpp"
#include "bench/diff/difference.hpp"
#include "bench/diff/history.hpp"

namespace jvari::bench::command {

int diff_command(const DiffRequest& r) {
    const Console console(r.json, r.quiet);
    if (!r.history.empty()) {
        const auto steps = diff::history(r.history, console);
        console.print(diff::text_of(steps));
        console.print_json(diff::json_of(steps));
        return exit_code::done;
    }
    const std::filesystem::path a = r.before, b = r.after;
    const diff::Folder before = diff::read_folder(a), after = diff::read_folder(b);
    const diff::Difference d = diff::difference(before, after);
    console.print(diff::text_of(d, before, after));
    console.print_json(diff::json_of(d, before, after));
    return d.worse() ? exit_code::run_failed : exit_code::done;
}

}  // namespace jvari::bench::command

// jvari export: the problem that a scheme of one's own solves, as arrays.
#include <fmt/core.h>

#include <optional>

#include "bench/command/console.hpp"
#include "bench/command/verbs.hpp"
#include "bench/judge/problem_file.hpp"
#include "bench/store/fresh_file.hpp"
#include "bench/store/json.hpp"

namespace jvari::bench::command {

namespace {
struct ExportRequest : Common, compare::CompareRequest {
    double rate = 44100;  // [Hz]
    int modes_of_each = 0;
    bool without_reference = false;
};

int export_command(ExportRequest r) {
    const Console console(r.json, r.quiet);
    r.rates = {r.rate};
    if (r.modes_of_each > 0) r.modes = {r.modes_of_each};
    store::must_be_writable(r.out);
    const judge::Exported problem = judge::exported(r);
    std::optional<study::Truth> truth;
    if (!r.without_reference)
        truth = judge::reference_of(r, problem, compare::Catalogue(), console);
    store::write_fresh(r.out, judge::problem_json(problem, truth ? &*truth : nullptr));
    console.print(fmt::format(
        "{} at {:.12g} Hz, {:.12g} rows a second{}", problem.scene.name, r.rate,
        problem.settings.tap_rate,
        truth ? "; reference: " + truth->reference.choice.name() + ", " + truth->said : ""));
    console.print("written: " + r.out);
    console.print_json(
        store::indented({{"scene", problem.scene.name}, {"status", "ok"}, {"files", {r.out}}}));
    return exit_code::done;
}
}  // namespace

Act export_verb(CLI::App& program) {
    Verb<ExportRequest> v(
        program, "export",
        "the problem as arrays, for a scheme of one's own, and the reference trace");
    v.scene(v.r.scene);
    v.set(v.r.set);
    v.modes(v.r.modes_of_each);
    v.option("--rate", v.r.rate, hertz, "steps per second of the scheme; 44100 where absent");
    v.option("--tap-rate", v.r.tap_rate, hertz,
             "rows per second; 44100 where the rate is a multiple of it, else the rate");
    v.duration(v.r.duration);
    v.option("--tap", v.r.tap, {"NAME"}, "of the scene's taps this one alone");
    v.flag("--without-reference", v.r.without_reference, "the problem alone: no reference is run");
    v.option("--out", v.r.out, {"FILE"}, "the file, JSON")->required();
    return v.does(export_command,
                  "Example: jvari export tanpura_c3_release --duration 0.05 --out problem.json\n"
                  "\n"
                  "The file holds frequencies, decay rates, weights of contact, thread, pluck and "
                  "taps, and the reference trace with its\n"
                  "uncertainty: what a script of a modal scheme or a grid begins with. "
                  "docs/own-scheme/README.md has the unit, the shape and the\n"
                  "equation of each field, and schemes in Python, Octave, Julia and C to copy. "
                  "`jvari judge` says how wrong their traces are.");
}

}  // namespace jvari::bench::command

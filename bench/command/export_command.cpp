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
    must_be_assignments(r.set);
    r.rates = {r.rate};
    if (r.modes_of_each > 0) r.modes = {r.modes_of_each};
    store::must_be_writable(r.out);
    const judge::Exported problem = judge::exported(r);
    std::optional<study::Truth> truth;
    if (!r.without_reference) truth = judge::reference_of(r, problem, compare::Catalogue(r.plugins), console);
    store::write_fresh(r.out, judge::problem_json(problem, truth ? &*truth : nullptr));
    console.print(fmt::format("{} at {:.12g} Hz, {:.12g} rows a second{}", problem.scene.name, r.rate, problem.settings.tap_rate,
                              truth ? "; reference: " + truth->reference.choice.name() + ", " + truth->said : ""));
    console.print("written: " + r.out);
    console.print_json(store::indented({{"scene", problem.scene.name}, {"status", "ok"}, {"files", {r.out}}}));
    return exit_code::done;
}
}  // namespace

Act export_verb(CLI::App& program) {
    const auto r = std::make_shared<ExportRequest>();
    CLI::App* verb = program.add_subcommand("export", "the problem as arrays, for a scheme of one's own, and the reference trace");
    add_scene(*verb, r->scene);
    add_set(*verb, r->set);
    add_modes(*verb, r->modes_of_each);
    verb->add_option("--rate", r->rate, "steps per second of the scheme; 44100 where absent")
        ->type_name("HZ")
        ->transform(hertz)
        ->option_text("HZ");
    verb->add_option("--tap-rate", r->tap_rate, "rows per second; 44100 where the rate is a multiple of it, else the rate")
        ->type_name("HZ")
        ->transform(hertz);
    add_duration(*verb, r->duration);
    verb->add_option("--tap", r->tap, "of the scene's taps this one alone")->type_name("NAME");
    verb->add_flag("--without-reference", r->without_reference, "the problem alone: no reference is run");
    verb->add_option("--out", r->out, "the file, JSON")->required()->type_name("FILE");
    verb->footer(
        "Example: jvari export tanpura_c3_release --duration 0.05 --out problem.json\n"
        "\n"
        "The file holds frequencies, decay rates, weights of contact, thread, pluck and taps, and the reference trace with its\n"
        "uncertainty: what a script of a modal scheme or a grid begins with. docs/own-scheme/README.md has the unit, the shape and the\n"
        "equation of each field, and schemes in Python, Octave, Julia and C to copy. `jvari judge` says how wrong their traces are.");
    add_common(*verb, *r);
    return [r] { return export_command(*r); };
}

}  // namespace jvari::bench::command
